"""Slabs a second while bodies stay in contact, and what they are bound by.

``python benchmarks/processes/large/contact_rates.py held --cells 9 --law linear --slabs 60`` marches a cube that its
weight presses onto a floor from the start on.  ``plates --cells 8 --layers 4 --slabs 12`` marches a pile of plates, and
from the same state the same plates without contact.  Each prints one line of JSON.
"""

import argparse
import json
import resource
from collections.abc import Iterator
from dataclasses import replace
from time import perf_counter, process_time
from typing import Any

import numpy as np
from contact_counts import streamed, watched

import softway as sw
from softway.marching.results.step import Step
from softway.marching.slab.slab_batch import BatchStates
from softway.meshes.mesh import Mesh
from softway.model.model import Model
from softway.solve.operators.factored import suited

E, NU, DENSITY, STEP, WEIGHT = 1e4, 0.3, 1.0, 5e-4, 100.0
"""The body of the thrown cube and its slab [s], and the acceleration that holds it on the floor [m/s^2]."""
LAWS = {"linear": sw.LinearElastic(E=E, nu=NU), "neo-Hookean": sw.NeoHookean(E=E, nu=NU)}
METHOD = sw.FixedPoint(tolerance=1e-8)
WARM = 3
"""Slabs before the clock: they compile kernels, and make the operator."""
FLOOR = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0)))
LOADS = (sw.Gravity(acceleration=(0.0, 0.0, -WEIGHT)),)
FLAT = 0.25
"""Height of a plate over its width."""


def held(cells: int, law: str) -> sw.Scene:
    """A cube at rest on a floor, whose weight begins to act.

    The force on the floor rises to twice the weight and falls to nothing in four times the time in which a wave of
    pressure crosses the cube, .034 s or 69 slabs.
    """
    cube = sw.Solid(mesh=sw.meshes.Box(size=(1.0,) * 3, cells=(cells,) * 3), material=LAWS[law], density=DENSITY)
    contact = sw.Contact(between=("cube.bottom", "floor"))
    return sw.Scene(bodies={"cube": cube, "floor": FLOOR}, contacts=(contact,), loads=LOADS)


def plates(cells: int, layers: int, touching: bool = True) -> sw.Scene:
    """A pile of square plates, two cells thick, of ``cells`` and ``cells`` + 1 cells along their sides in turn."""
    bodies: dict[str, Any] = {"floor": FLOOR}
    contacts = [sw.Contact(between=("plate0.bottom", "floor"))]
    for k in range(layers):
        n = cells + k % 2
        inset = 0.01 * (k % 2)
        mesh = sw.meshes.Box(
            size=(1.0 - 2.0 * inset, 1.0 - 2.0 * inset, FLAT), cells=(n, n, 2), origin=(inset, inset, k * FLAT)
        )
        bodies[f"plate{k}"] = sw.Solid(mesh=mesh, material=LAWS["neo-Hookean"], density=DENSITY)
        if k:
            contacts.append(sw.Contact(between=(f"plate{k - 1}.top", f"plate{k}.bottom")))
    return sw.Scene(bodies=bodies, contacts=tuple(contacts) if touching else (), loads=LOADS)


def timed(steps: Iterator[Step]) -> tuple[Step, float, float]:
    """The next slab with its certificate, its time by the clock and that of the processors [s]."""
    start, used = perf_counter(), process_time()
    step = next(steps)
    assert np.isfinite(step.certificate.energy_error)
    return step, perf_counter() - start, process_time() - used


def closed(step: Step) -> int:
    """Number of contact nodes in contact at the end of a slab."""
    return sum(c.count for c in step.ledger.contacts.values())


def operator_of(step: Step) -> str:
    """Name of the operator that the march has chosen."""
    choice = step.march_state.memory.choice
    return "compiled slabs" if choice is None else type(choice.operator).__name__


def carried(step: Step, iterations: float) -> float:
    """Bytes that a compiled slab of a stored energy moves at least: those of the factor, twice in each solution, and
    of the answers to the closed rows.
    """
    origin, model = step.march_state.memory.origin, step.model
    assert origin is not None
    matrix = origin.stiffness(model).operator(origin.at)
    factor = suited(matrix.shape[0], "single", threads=1).analyse(matrix).factor(matrix)
    return iterations * (2.0 * factor.bytes + 8.0 * closed(step) * matrix.shape[0])


def rate(cells: int, law: str, slabs: int) -> dict[str, Any]:
    """Mean times of slabs all of which have active contact, with their traffic and balances."""
    seen, stream = watched(), streamed()
    steps = sw.march(held(cells, law), until=(WARM + slabs) * STEP, step=STEP, method=METHOD)
    for _ in range(WARM):
        step = next(steps)
    rows, facts, compiled = [], [], 0
    for _ in range(slabs):
        seen.reset()
        step, clock, used = timed(steps)
        rows.append((clock, used, seen.bytes, seen.steps, seen.solving, seen.forcing, step.report.iterations))
        facts.append((closed(step), step.ledger.energy_error, step.ledger.energy_strain, *gaps(step)))
        compiled += isinstance(step.states, BatchStates)
    mean, (active, error, energy, gap, pull) = np.mean(rows, axis=0), np.transpose(facts)
    names = ("clock", "used", "bytes", "steps", "solving", "forcing", "iterations")
    found = dict(zip(names, map(float, mean), strict=True))
    operator = operator_of(step)
    if compiled > 0.5 * slabs and law != "linear":
        operator, found["bytes"] = "compiled slabs", carried(step, found["iterations"])
    return found | {
        "unknowns": 3 * (cells + 1) ** 3,
        "compiled": compiled / slabs,
        "operator": operator,
        "active": int(active.min()),
        "drift": float(np.abs(error).max() / energy.max()),
        "gap": float(gap.min()),
        "pull": float(pull.min()),
        "stream": max(stream, streamed()),
    }


def gaps(step: Step) -> tuple[float, float]:
    """Least gap [m] and least normal force [N] of a certificate."""
    return step.certificate.min_gap, step.certificate.min_force


def surface_nodes(mesh: Mesh) -> int:
    """Number of nodes on the boundary."""
    return len(np.unique(np.concatenate([facets.ravel() for facets in mesh.boundary().values()])))


def parted(cells: int, layers: int, step: Step) -> Model:
    """The plates without contact, with the places and velocities after a slab."""
    now = step.after
    places, velocities = (np.concatenate(list(of.values())) for of in (now.displacement, now.velocity))
    return replace(sw.build(plates(cells, layers, touching=False)), displacement=places, velocity=velocities)


def dense(cells: int, layers: int, slabs: int) -> dict[str, Any]:
    """Times of slabs of a pile of plates, with contact and without from the same state."""
    scene, length = plates(cells, layers), STEP * 9 / cells
    steps = sw.march(scene, until=(2 * WARM + slabs) * length, step=length, method=METHOD)
    for _ in range(2 * WARM):
        step = next(steps)
    plain = sw.march(parted(cells, layers, step), until=(WARM + slabs) * length, step=length, method=METHOD)
    for _ in range(WARM):
        free = next(plain)
    rows, active, drift = [], [], []
    for _ in range(slabs):
        (step, _, contact), (free, _, flight) = timed(steps), timed(plain)
        rows.append((contact, flight, step.report.iterations, free.report.iterations))
        active.append(closed(step))
        drift.append(abs(step.ledger.energy_error) / step.ledger.energy_strain)
    typical = np.median(rows, axis=0)
    return dict(zip(("contact", "free", "iterations", "iterations_free"), map(float, typical), strict=True)) | {
        "unknowns": sum(v.size for v in step.after.velocity.values()),
        "active": min(active),
        "surface": sum(surface_nodes(p.mesh) for p in step.model.parts),
        "drift": max(drift),
        "operator": operator_of(step),
        "operator_free": operator_of(free),
    }


def marched(cells: int, until: float, divide: int) -> dict[str, Any]:
    """Processor time of a whole march of the neo-Hookean cube, and its momentum along z after every slab."""
    next(sw.march(held(2, "neo-Hookean"), until=2 * STEP, step=STEP, method=METHOD))
    start = process_time()
    steps = list(sw.march(held(cells, "neo-Hookean"), until=until, step=STEP / divide, method=METHOD))
    used = process_time() - start
    momentum = [float(step.ledger.momentum[-1]) for step in steps]
    return {"cpu": used, "time": [step.after.time for step in steps], "momentum": momentum}


def main() -> None:
    """Measure, and print the line: the result, and the most memory that the process had [MB]."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("what", choices=("held", "march", "plates"))
    options.add_argument("--cells", type=int, default=9)
    options.add_argument("--law", choices=LAWS, default="linear")
    options.add_argument("--layers", type=int, default=4)
    options.add_argument("--slabs", type=int, default=40)
    options.add_argument("--until", type=float, default=0.03)
    options.add_argument("--divide", type=int, default=1)
    ask = options.parse_args()
    match ask.what:
        case "held":
            result = rate(ask.cells, ask.law, ask.slabs)
        case "march":
            result = marched(ask.cells, ask.until, ask.divide)
        case _:
            result = dense(ask.cells, ask.layers, ask.slabs)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    print("\n" + json.dumps(result | {"peak": peak}))


if __name__ == "__main__":
    main()
