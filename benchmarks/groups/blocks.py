"""Contact of two solids: a slab of it against one without, the first slab of a touch, and the force against a peer."""

from collections.abc import Iterable, Iterator
from typing import Any

from processes.apart import Absent, alone
from record.figures import Figure, speedup

from groups import peers
from groups.asked import Asked
from groups.force import WIDE, apart

STEP = peers.STEP
CELLS = {"3k": 6, "30k": 16, "100k": 24}
"""Cells along an edge of the upper block, by the number of unknowns of both."""
SLABS = {"3k": 16, "30k": 8, "100k": 4}
ENOUGH = 5.0
"""Error of the force that counts as the same accuracy [%]."""
FINE, DIVIDE = 14, 2
"""Cells along an edge of the refined upper block, and the part of a step that is its slab."""
OURS = (0.5, 0.75, 1.0)
"""Parts of a step that are our slabs."""
SETTINGS: tuple[dict[str, float], ...] = (
    {"kept": 0.0},
    {"kept": 0.1},
    {"radius": 0.8, "order": 2, "kept": 0.3},
    {"radius": 0.8, "order": 2, "kept": 0.3, "penalty": 2.5e5},
    {"radius": 0.8, "order": 2, "kept": 0.3, "penalty": 1e6},
    {"radius": 0.8, "order": 2, "kept": 0.3, "step": 2 * STEP},
    {"radius": 0.8, "order": 2, "kept": 0.2, "step": 2 * STEP, "penalty": 1e6},
)
"""Settings of NGSolve; the first is as in its tutorials."""
LARGE: tuple[dict[str, float], ...] = ({"radius": 0.8, "order": 2, "kept": 0.6, "step": 2 * STEP},)
"""Settings of NGSolve on the refined cells; factors kept to 0.3, at twice the penalty, took 1.7 times as long."""


def pressed(asked: Asked) -> Iterator[Figure]:
    """Two cubes of the same neo-Hookean solid collide, flat on flat, on meshes that do not match.

    The same bodies march on from the slab of the touch with contact and, from the same state, without any: both have
    the same strains and iterate.  The first slab of the touch computes the compliance of the contact directions.
    """
    for size in asked.pick(("3k",), ("3k", "30k"), tuple(CELLS)):
        for friction, target in ((None, "<= 1.5"), (0.3, "<= 2")):
            options = {"cells": asked.size(CELLS[size], 3), "slabs": asked.size(SLABS[size], 2), "friction": friction}
            found = alone("pressed", **options)
            yield from _pressed(f"pressed/{size}, {'no friction' if friction is None else 'friction'}", found, target)


def _pressed(name: str, found: dict[str, Any], target: str) -> Iterator[Figure]:
    """The figures of one size."""
    cost = found["result"]
    contact, free = cost["contact"], cost["free"]
    iterations = cost["iterations_contact"], cost["iterations_free"]
    words = f"ms of the processor, {cost['unknowns']} unknowns, {cost['facets']} facets; without contact"
    yield Figure(name=name, value=contact, unit=words, baseline=free, ratio=contact / free, target=target)
    each = [time / max(count, 1.0) for time, count in zip((contact, free), iterations, strict=True)]
    words = f"ms, {iterations[0]:.1f} iterations a slab; without contact {iterations[1]:.1f}"
    yield Figure(name=f"{name}, iteration", value=each[0], unit=words, baseline=each[1], ratio=each[0] / each[1],
                 target="lower")  # fmt: skip
    yield Figure(name=f"{name}, first slab of the touch", value=cost["first"], unit="ms; slabs after it",
                 baseline=contact, ratio=cost["first"] / contact, target="<= 5")  # fmt: skip
    yield Figure(name=f"{name}, peak memory", value=found["peak"], unit="MB")


def unmet(asked: Asked) -> Iterator[Figure]:
    """A block inside of a hollow box that it never touches: slabs with that open contact against the floor alone."""
    for words, resting in (("in flight", False), ("resting", True)):
        times = alone("unmet", cells=12, slabs=asked.size(28, 2), resting=resting)["result"]
        base = times.pop("floor")
        for method, spent in times.items():
            yield Figure(name=f"unmet/{words}, {method}", value=spent, unit="ms of the processor; the floor alone",
                         baseline=base, ratio=spent / base, target="<= 1.1")  # fmt: skip


def blocks(asked: Asked) -> Iterator[Figure]:
    """What a contact force of given accuracy costs between two solids: ours and NGSolve, on the same meshes.

    A block with a crowned face is thrown at another one; their meshes do not match, and nothing holds them.  Ours is
    the default, mortar contact without a parameter; NGSolve has its `ContactBoundary` with a penalty, the factor of its
    sparse Cholesky kept while an iteration reduces the residual to the part `kept`, with trapezoidal rule or
    generalised-alpha.  Errors are those of mean forces over windows of 5e-4 s (in brackets: 2e-3 s), root mean square
    over the contact, of that of ours on 14 cells with slabs of 2.5e-4 s.  One thread, time of the processor.  At 20k,
    on these cells, ours is measured against its own limit, and NGSolve against that of another inertia.
    """
    cells = asked.size(CELLS["3k"], 3)
    fine = alone("collision", cells=asked.size(FINE, 4), divide=asked.size(DIVIDE, 1))["result"]
    yield from _raced(asked, "blocks/3k", cells, OURS, SETTINGS, fine)
    if asked.depth != "quick":
        yield from _raced(asked, "blocks/20k", asked.size(FINE, 4), OURS[:1], LARGE, fine)


def _raced(
    asked: Asked, name: str, cells: int, divides: Iterable[float], settings: Iterable[dict[str, float]],
    fine: dict[str, Any],
) -> Iterator[Figure]:  # fmt: skip
    """Runs of both codes on the same meshes, and the cheapest of both."""
    ours, theirs = [], []
    for divide in divides:
        run = alone("collision", cells=cells, divide=divide)["result"]
        ours.append((f"ours, step {STEP / divide:.3g}", run["cpu"], apart(run, fine)))
        yield from _shown(f"{name}/{ours[-1][0]}", run, fine)
    for options in settings:
        try:
            run = peers.found(asked, "NGSolve blocks", 1, cells=cells, **options)
        except Absent as why:
            print(f"  NGSolve: {why}", flush=True)
            break
        told = [f"{k} {v:g}" for k, v in options.items() if k != "step"]
        words = ", ".join(["NGSolve", f"step {options.get('step', STEP):.3g}", *told])
        theirs.append((words, run["cpu"], apart(run, fine)))
        yield from _shown(f"{name}/{words}", run, fine)
    yield _equal(f"{name}/equal accuracy", ours, theirs)


def _shown(name: str, run: dict[str, Any], fine: dict[str, Any]) -> Iterator[Figure]:
    """Time and error of a run."""
    yield Figure(name=name, value=run["cpu"], unit="s of the processor, 1 thread")
    near, wide = apart(run, fine), apart(run, fine, WIDE)
    yield Figure(name=f"{name}, from refined cells", value=near, unit=f"% rms of the force ({wide:.3g} %)")


def _equal(name: str, ours: list[tuple[str, float, float]], theirs: list[tuple[str, float, float]]) -> Figure:
    """The cheapest of ours against the cheapest of theirs, among those that are near enough."""
    mine, other = (min((t for t in g if t[2] <= ENOUGH), key=lambda t: t[1], default=None) for g in (ours, theirs))
    if mine is None:
        return Figure(name=name, value=f"none of ours within {ENOUGH:g} %")
    if other is None:
        return Figure(name=name, value=mine[1], unit=f"s, {mine[0]}; no peer")
    return speedup(name, mine[1], other[1], f"s, {mine[0]}; {other[0]}", ">= 5")
