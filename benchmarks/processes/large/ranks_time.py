"""Time and memory of a march over ranks, measured: a cube thrown at a floor, by as many processes as are started.

``mpiexec -n 2 python benchmarks/processes/large/ranks_time.py --cells 32`` prints a line of JSON for each slab, and one
for the whole march with an entry a rank: processor time of the slabs beyond communication, processor time and time by
the clock in communication [s], greatest memory, and memory in the march [MB].  Processes that wait for a message of
MPI spin, so that their processor time has to be told apart.  ``--wide 2`` sets two cubes side by side, in one body:
as much work for each of two ranks as a cube for one.  Without ``mpiexec`` it is one rank.
"""

import argparse
import json
import resource
from collections.abc import Iterator
from pathlib import Path
from time import perf_counter, process_time
from typing import Any

import numpy as np

import softway as sw
from softway.cluster.march import march_on
from softway.marching.results.step import Step
from softway.marching.state.march_state import Settings
from softway.marching.state.step_control import StepControl
from softway.model.model import Model
from softway.model.time_weight import EndPeaks
from softway.ranks.alone import Alone
from softway.ranks.counted import Counted
from softway.ranks.mpi import launched, processes

SPEED, WAVES = 5.0, 116.0
"""Speed of the cube, and of waves of pressure in it [m/s]."""


def thrown(cells: int, wide: int, cell: str, gap: float) -> sw.Scene:
    """``wide`` cubes of edge 1 side by side in one body, ``gap`` [m] above a plane."""
    body = sw.Solid(
        mesh=sw.meshes.Box(size=(float(wide), 1.0, 1.0), cells=(wide * cells, cells, cells), cell=cell),
        material=sw.NeoHookean(E=1e4, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0, 0.0, -SPEED)),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, -gap), normal=(0.0, 0.0, 1.0)))
    return sw.Scene(bodies={"cube": body, "floor": floor}, contacts=(sw.Contact(between=("cube.bottom", "floor")),))


def facts(number: int, slab: Step, energy: float) -> dict[str, Any]:
    """Facts of a slab."""
    force = sum(contact.force_n for contact in slab.ledger.contacts.values())
    return {
        "slab": number,
        "iterations": slab.report.iterations,
        "drift": slab.ledger.energy_error / energy,
        "momentum": slab.certificate.momentum_error,
        "force": force,
    }


def marched(ranks: Counted, model: Model, step: float, slabs: int) -> Iterator[dict[str, Any]]:
    """Facts of each slab on rank 0, and on every rank the processor time since the last one."""
    energy = float(model.kinetic(model.velocity).sum())
    method, control = sw.FixedPoint(handover=False), StepControl()
    given = Settings(until=slabs * step, step=step, weight=EndPeaks(), method=method, control=control)
    march = march_on(ranks, model, given)
    del model
    clock = cpu = None
    for number, slab in enumerate(march, 1):
        now = perf_counter(), process_time(), ranks.spent["clock"], ranks.spent["cpu"]
        taken = {} if clock is None or cpu is None else _since(clock, cpu, now)
        clock, cpu = (now[0], now[2]), (now[1], now[3])
        yield taken | ({} if slab is None else facts(number, slab, energy))


def _since(clock: tuple[float, float], cpu: tuple[float, float], now: tuple[float, ...]) -> dict[str, float]:
    """Times of a slab [s]: beyond communication, and in it."""
    inside = now[3] - cpu[1]
    return {
        "clock": now[0] - clock[0],
        "cpu": now[1] - cpu[0] - inside,
        "messages cpu": inside,
        "messages clock": now[2] - clock[1],
    }


def memory() -> dict[str, float]:
    """Greatest memory of this process so far, and memory now [MB]."""
    now = next((line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith("VmRSS")), "")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    return {"peak": peak, "held": float((now.split() or ["", "0"])[1]) / 1024.0}


def main() -> None:
    """March from a little before the touch."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, default=32, help="cells along the edge; 69 make 1,029,000 unknowns")
    parser.add_argument("--wide", type=int, default=1, help="cubes side by side")
    parser.add_argument("--cell", default="hex8", help="hex8 or tet4")
    parser.add_argument("--crossed", type=float, default=1.2, help="cells that a wave crosses in a slab")
    parser.add_argument("--slabs", type=int, default=8)
    given = parser.parse_args()
    ranks, begun = Counted(ranks=processes() if launched() else Alone()), process_time()
    step = given.crossed / (given.cells * WAVES)
    model = sw.build(thrown(given.cells, given.wide, given.cell, 1.25 * SPEED * step))
    told, found = {"unknowns": model.dofs.size, "built": process_time() - begun} | memory(), []
    if ranks.rank == 0:
        print(json.dumps(told), flush=True)
    march = marched(ranks, model, step, given.slabs)
    del model
    for line in march:
        found.append(line)
        if ranks.rank == 0:
            print(json.dumps(line | memory()), flush=True)
    mine = {k: sum(line.get(k, 0.0) for line in found) for k in ("clock", "cpu", "messages cpu", "messages clock")}
    every = [json.loads(str(text[0])) for text in ranks.gathered(np.array([json.dumps(mine | memory())]))]
    if ranks.rank == 0:
        print(json.dumps({"unknowns": told["unknowns"], "slabs": len(found), "ranks": every}), flush=True)


if __name__ == "__main__":
    main()
