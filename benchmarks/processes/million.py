"""A neo-Hookean cube of a million unknowns on one workstation: dropped onto a floor, through its touch.

``python benchmarks/processes/million.py [--cells 69] [--cell tet4] [--operator ConjugateGradients] [--until T]`` prints
a line of JSON for the built model and for each slab: time by the clock and of the processors since the last line [s],
greatest memory so far [MB], iterations, error of the energy relative to that at the start, contact force [N].
"""

import argparse
import json
import resource
from time import perf_counter, process_time
from typing import Any

import softway as sw

SPEED, WAVES = 5.0, 116.0
"""Speed of the cube, and of waves of pressure in it [m/s]."""
CROSSED = 2.0
"""Cells that a wave of pressure crosses in a slab."""
KINDS = {"ConjugateGradients": sw.solve.ConjugateGradients(), "MatrixFree": sw.solve.MatrixFree()}


def thrown(cells: int, cell: str, gap: float) -> sw.Scene:
    """Cube with ``cells`` along its edges of length 1, ``gap`` [m] above a plane."""
    cube = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(cells,) * 3, cell=cell),
        material=sw.NeoHookean(E=1e4, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0, 0.0, -SPEED)),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, -gap), normal=(0.0, 0.0, 1.0)))
    return sw.Scene(bodies={"cube": cube, "floor": floor}, contacts=(sw.Contact(between=("cube.bottom", "floor")),))


class Clock:
    """Costs since the last reading."""

    def __init__(self) -> None:
        self.last = perf_counter(), process_time()

    def costs(self) -> dict[str, float]:
        """Seconds by the clock and of the processors, and the greatest memory so far [MB]."""
        now = perf_counter(), process_time()
        wall, cpu = (b - a for a, b in zip(self.last, now, strict=True))
        self.last = now
        return {"wall": wall, "cpu": cpu, "peak": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0}


def told(name: str, costs: dict[str, float], **facts: Any) -> None:
    """Print a line."""
    rounded = {key: float(f"{value:.4g}") for key, value in costs.items()}
    print(json.dumps({"what": name} | rounded | facts), flush=True)


def main() -> None:
    """March from a quarter of a slab before the touch until it ends, or to ``--slabs``."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, default=69, help="cells along the edge; 69 make 1,029,000 unknowns")
    parser.add_argument("--cell", default="tet4", help="tet4 or hex8")
    parser.add_argument("--operator", default="ConjugateGradients", choices=KINDS)
    parser.add_argument("--crossed", type=float, default=CROSSED, help="cells that a wave crosses in a slab")
    parser.add_argument("--slabs", type=int, default=None, help="greatest number of slabs; default: to the end of the touch")
    given = parser.parse_args()
    clock, step = Clock(), given.crossed / (given.cells * WAVES)
    model = sw.build(thrown(given.cells, given.cell, 1.25 * SPEED * step))
    told("built", clock.costs(), unknowns=model.dofs.size)
    energy, met = float(model.kinetic(model.velocity).sum()), False
    method = sw.FixedPoint(operator=KINDS[given.operator])
    for k, slab in enumerate(sw.march(model, until=1.0, step=step, method=method), 1):
        ledger = slab.ledger
        force = sum(found.force_n for found in ledger.contacts.values())
        facts = {"iterations": slab.report.iterations, "drift": ledger.energy_error / energy, "force": force}
        told(f"slab {k}", clock.costs(), **facts)
        if (met and not force) or k == given.slabs:
            return
        met = met or bool(force)


if __name__ == "__main__":
    main()
