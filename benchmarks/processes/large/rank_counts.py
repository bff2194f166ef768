"""Traffic and memory of a march over ranks, counted: ``python benchmarks/processes/large/rank_counts.py --ranks 8``.

A cube of hexahedra falls onto an inclined plane.  The ranks are threads of one process, so that any number can be
counted on any machine; times are not measured.  The counts are printed as JSON, a list with one entry a rank.
``mpiexec -n 8 python benchmarks/processes/large/rank_counts.py`` counts the same of eight processes.
"""

import argparse
import json
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

import softway as sw
from softway.cluster.cells.rank_force import stored_rows
from softway.cluster.march import march_on
from softway.cluster.rank_model import held_by, rank_model
from softway.marching.state.march_state import Settings
from softway.marching.state.step_control import StepControl
from softway.model.build import build
from softway.model.model import Model
from softway.model.time_weight import EndPeaks
from softway.ranks.counted import Counted
from softway.ranks.interface import Ranks
from softway.ranks.mpi import launched, processes
from softway.ranks.threads import in_threads

STIFF, DENSE = 1e4, 1.0
"""Young's modulus [Pa] and density [kg/m^3] of the cube of one metre."""


def cube(cells: int) -> Model:
    """Cube of ``cells**3`` hexahedra just above an inclined plane."""
    body = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(cells, cells, cells)),
        material=sw.NeoHookean(E=STIFF, nu=0.3),
        density=DENSE,
        velocity=sw.bodies.Uniform(value=(0.0, 0.0, -5.0)),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, -1e-3), normal=(0.0, 0.1, 1.0)))
    contact = sw.Contact(between=("cube.bottom", "floor"))
    return build(sw.Scene(bodies={"cube": body, "floor": floor}, contacts=(contact,)))


def counts(ranks: Ranks, model: Model, slabs: int, courant: float) -> dict[str, Any]:
    """Counts of one rank."""
    part, start = model.parts[0], Counted(ranks=ranks)
    step = courant * part.mesh.edge() / model.wave_speed(part)
    held = held_by(model, start)
    local = rank_model(model, held, start)
    inner = np.unique(np.concatenate([part.mesh.blocks["hex8"][held.cells[0]].ravel(), held.nodes[held.own]]))
    rows = stored_rows(local.parts, local.displacement, 1.0, 0.0)
    memory = {"model": size_of(local), "operator": size_of(rows)}
    del local, rows
    method = sw.FixedPoint(handover=False)
    given = Settings(until=slabs * step, step=step, weight=EndPeaks(), method=method, control=StepControl())
    counted = Counted(ranks=ranks)
    iterations = [step.report.iterations for step in march_on(counted, model, given) if step is not None]
    return {
        "rank": ranks.rank,
        "own_nodes": len(held.own),
        "copies_of_neighbours": len(inner) - len(held.own),
        "copies_of_surface": len(held.nodes) - len(inner),
        "neighbours": len(held.exchange.send),
        "cells": len(held.cells[0]),
        "counted_cells": int(held.counted[0].sum()),
        "calls": dict(counted.calls),
        "bytes_sent": dict(counted.sent),
        "bytes_held": memory,
        "slabs": ranks.told(len(iterations)),
        "iterations": ranks.told(sum(iterations)),
    }


def of_processes(model: Model, slabs: int, courant: float) -> list[dict[str, Any]]:
    """Counts of the processes that a launcher has started, on the first of them; none on the others."""
    ranks = processes()
    mine = np.array([json.dumps(counts(ranks, model, slabs, courant))])
    return [json.loads(str(text[0])) for text in ranks.collected(mine)]


def size_of(thing: object, seen: set[int] | None = None) -> int:
    """Bytes of the arrays of an object, each counted once."""
    seen = set() if seen is None else seen
    if id(thing) in seen:
        return 0
    seen.add(id(thing))
    if isinstance(thing, np.ndarray):
        return thing.nbytes if thing.base is None else size_of(thing.base, seen)
    if isinstance(thing, sp.sparray):
        return sum(size_of(getattr(thing, name, None), seen) for name in ("data", "indices", "indptr"))
    if isinstance(thing, dict):
        return sum(size_of(value, seen) for value in thing.values())
    if isinstance(thing, tuple | list):
        return sum(size_of(value, seen) for value in thing)
    if is_dataclass(thing) and not isinstance(thing, type):
        return sum(size_of(getattr(thing, f.name, None), seen) for f in fields(thing))
    return 0


def main() -> None:
    """Print the counts; of processes, the first one does."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ranks", type=int, default=8, help="number of ranks")
    parser.add_argument("--cells", type=int, default=12, help="cells along an edge of the cube")
    parser.add_argument("--slabs", type=int, default=4, help="number of slabs")
    parser.add_argument("--courant", type=float, default=1.2, help="cells that a wave crosses in a slab")
    asked = parser.parse_args()
    model = cube(asked.cells)
    given = model, asked.slabs, asked.courant
    found = of_processes(*given) if launched() else in_threads(asked.ranks, lambda ranks: counts(ranks, *given))
    if found:
        print(json.dumps(found, indent=1))


if __name__ == "__main__":
    main()
