"""A neo-Hookean cube of a million unknowns on one workstation: dropped onto a floor, through its touch.

``python benchmarks/processes/large/million.py [--cells 69] [--cell tet4] [--operator ConjugateGradients] [--slabs N]``
prints a line of JSON for the built model and for each slab: time by the clock and of the processors since the last line
[s], greatest memory so far [MB], iterations, error of the energy relative to that at the start, contact force [N].  The
last line sums up.
"""

import argparse
import json
import resource
from collections.abc import Iterator
from statistics import median
from time import perf_counter, process_time
from typing import Any

import softway as sw
from softway.model.model import Model

SPEED, WAVES = 5.0, 116.0
"""Speed of the cube, and of waves of pressure in it [m/s]."""
KINDS: dict[str, sw.solve.ConjugateGradients | sw.solve.MatrixFree] = {
    "ConjugateGradients": sw.solve.ConjugateGradients(),
    "MatrixFree": sw.solve.MatrixFree(),
}


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


def costs(since: tuple[float, float]) -> dict[str, float]:
    """Seconds by the clock and of the processors since an instant, and the greatest memory so far [MB]."""
    wall, cpu = (float(f"{b - a:.4g}") for a, b in zip(since, instant(), strict=True))
    return {"wall": wall, "cpu": cpu, "peak": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0}


def instant() -> tuple[float, float]:
    """Time by the clock, and that of the processors [s]."""
    return perf_counter(), process_time()


def touch(model: Model, step: float, method: sw.FixedPoint, most: int | None) -> Iterator[dict[str, Any]]:
    """Facts of each slab, up to the first one after the touch, or to ``most``."""
    energy, met, last = float(model.kinetic(model.velocity).sum()), False, instant()
    for k, slab in enumerate(sw.march(model, until=1.0, step=step, method=method), 1):
        ledger = slab.ledger
        force = sum(contact.force_n for contact in ledger.contacts.values())
        facts = {"slab": k, "iterations": slab.report.iterations, "drift": ledger.energy_error / energy, "force": force}
        yield facts | costs(last)
        if (met and not force) or k == most:
            return
        met, last = met or bool(force), instant()


def main() -> None:
    """March from a little before the touch."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, default=69, help="cells along the edge; 69 make 1,029,000 unknowns")
    parser.add_argument("--cell", default="tet4", help="tet4 or hex8")
    parser.add_argument("--operator", default="ConjugateGradients", choices=KINDS)
    parser.add_argument("--crossed", type=float, default=4.0, help="cells that a wave crosses in a slab")
    parser.add_argument("--slabs", type=int, default=None, help="greatest number of slabs; default: those of the touch")
    given = parser.parse_args()
    start, step = instant(), given.crossed / (given.cells * WAVES)
    model = sw.build(thrown(given.cells, given.cell, 1.25 * SPEED * step))
    built = costs(start) | {"unknowns": model.dofs.size}
    print(json.dumps(built), flush=True)
    found = []
    for facts in touch(model, step, sw.FixedPoint(operator=KINDS[given.operator]), given.slabs):
        print(json.dumps(facts), flush=True)
        found.append(facts)
    closed = [facts["cpu"] for facts in found if facts["force"]]
    drift = max(abs(facts["drift"]) for facts in found)
    told = {"built": built["cpu"], "slab": median(closed), "drift": drift, "peak": found[-1]["peak"]}
    print(json.dumps(told | {"unknowns": model.dofs.size, "slabs": len(found)}))


if __name__ == "__main__":
    main()
