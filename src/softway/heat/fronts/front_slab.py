"""A slab of heat conduction with fronts between the nodes of bars, divided where a front passes a node."""

from dataclasses import replace

import numpy as np

from softway.arrays import Array
from softway.bodies.elements.front_cells import FrontCells
from softway.errors import NoConvergence, NumericsError
from softway.heat.fronts.events import SAME, FrontEvent, Piece, Search, pocket_after, slight_heats, standing_at
from softway.heat.fronts.held_fronts import held_fronts
from softway.heat.fronts.places import Fronts, content_of_phases, emptied, handed_on, overflowed, passed, standing
from softway.heat.heat_balance import Stage
from softway.heat.heat_model import HeatModel
from softway.heat.heat_slab import StageResult
from softway.heat.operators import HeatValues, heat_values

EVENTS = 8
"""Greatest number of events of each cell in a slab."""
REMEDY = 'latent = "cell", smaller cells, or shorter slabs'


def solve_front_slab(
    model: HeatModel, cells: FrontCells, start: tuple[HeatValues, Fronts], slab: Stage, halves: bool
) -> tuple[StageResult, Fronts]:
    """Solve a slab from a bare state with fronts, in one stage or in two ``halves`` whose heat flows at their ends.

    Where events are, the slab is divided, and the parts next to them flow at the temperature of their ends.

    Raises
    ------
    NumericsError
        If the fronts or the heats cannot be balanced.
    """
    stages = [slab]
    if halves:
        half = 0.5 * slab.span
        stages = [replace(slab, start=slab.start + k * half, span=half, theta=1.0) for k in (0, 1)]
    (before, fronts), results = start, list[StageResult]()
    try:
        for stage in stages:
            before, fronts = _stage(model, cells, (before, fronts), stage, results)
    except NoConvergence as error:
        raise NumericsError(str(error), slab.start, REMEDY) from None
    return _summed(results), fronts


def _summed(results: list[StageResult]) -> StageResult:
    """Result of successive parts."""

    def total(name: str) -> Array:
        return np.asarray(np.sum([getattr(result, name) for result in results], axis=0))

    return replace(
        results[-1], heats=total("heats"), passed=total("passed"), entropy=float(total("entropy")),
        iterations=int(total("iterations")), produced=total("produced"), turned=total("turned"),
        reservoirs=float(total("reservoirs")), rounding=float(total("rounding")), factor=None,
    )  # fmt: skip


def _stage(
    model: HeatModel, cells: FrontCells, start: tuple[HeatValues, Fronts], stage: Stage, results: list[StageResult]
) -> tuple[HeatValues, Fronts]:
    """State after a stage; the results of its parts are added to ``results``."""
    (before, fronts), end, now = start, stage.end, stage.start
    slight = SAME * float(cells.latent.min())
    changed: set[int] = set()
    for _ in range(EVENTS * (len(cells.latent) + 1)):
        search = Search(held_fronts(model, cells, fronts, before))
        begun = search.begun(replace(stage, start=now, span=end - now))
        if begun:
            events = tuple(FrontEvent("pass", node) for node in begun)
            before, fronts = _changed(model, cells, (before, fronts), events, changed)
            continue
        fresh = bool(len(fronts.waiting)) or np.isin(fronts.share, (0.0, 1.0)).any()
        left = replace(stage, start=now, span=end - now, theta=1.0 if fresh else stage.theta)
        whole = search.solved(left)
        if left.theta < 1.0 and (whole.happened or _rings(cells, fronts, whole)):
            left = replace(left, theta=1.0)
            whole = search.solved(left)
        if not whole.happened:
            before, fronts = _carried(model, cells, fronts, whole, ())
            results.append(replace(whole.held.result, after=before))
            return before, fronts
        piece, span = search.first(left, whole)
        events = tuple(e for e in whole.happened if piece is None or piece.over[e] >= -slight)
        if piece is not None:
            changed = set()
            before, fronts = _carried(model, cells, fronts, piece, events)
            results.append(replace(piece.held.result, after=before))
            now += span
        else:
            events = tuple(e for e in events if search.at_start[e] >= -slight)
        before, fronts = _changed(model, cells, (before, fronts), events, changed)
    raise NoConvergence(f"a slab with more than {EVENTS} events in each cell")


def _changed(
    model: HeatModel,
    cells: FrontCells,
    at: tuple[HeatValues, Fronts],
    events: tuple[FrontEvent, ...],
    changed: set[int],
) -> tuple[HeatValues, Fronts]:
    """State after events; their nodes are added to those that have ``changed`` at this instant."""
    before, earlier = at
    fronts = handed_on(
        model, cells, _after(cells, earlier, events, changed), np.flatnonzero(~model.free_nodes()).tolist()
    )
    heat = _heat(model, cells, earlier, before) - _heat(model, cells, fronts, before)
    changed |= {event.node for event in events if event.kind != "reach"}
    return _warmed(model, (cells, fronts), before, heat, events), fronts


def _rings(cells: FrontCells, fronts: Fronts, piece: Piece) -> bool:
    """True if a node swings over the temperature of melting of its phase."""
    over = fronts.beyond(cells, piece.held.result.after.temperature) * cells.capacity
    with np.errstate(invalid="ignore"):
        return bool((over > slight_heats(cells)).any())


def _after(cells: FrontCells, fronts: Fronts, events: tuple[FrontEvent, ...], changed: set[int]) -> Fronts:
    """Fronts after events; those that would go back at once over a node that has just changed stand there."""
    passing = tuple(dict.fromkeys(e.node for e in events if e.kind == "pass"))
    for node in (j for j in passing if j in changed):
        fronts = standing(cells, fronts, node)
    fronts = passed(cells, fronts, tuple(j for j in passing if j not in changed))
    for event in events:
        if event.kind == "empty":
            fronts = emptied(cells, fronts, event.node)
    full = tuple(event.node for event in events if event.kind == "full")
    return overflowed(cells, fronts, full) if full else fronts


def _carried(
    model: HeatModel, cells: FrontCells, fronts: Fronts, piece: Piece, events: tuple[FrontEvent, ...]
) -> tuple[HeatValues, Fronts]:
    """State at the end of a part: fronts where the heat brings them, so that the ledger closes exactly.

    What the instant of an event is inexact by warms or cools its node.
    """
    share, pocket, after = fronts.share.copy(), fronts.pocket.copy(), piece.held.result.after
    stopped = {event.cell for event in events}
    for cell, end in piece.shares.items():
        share[cell] = end if cell in stopped else share[cell] + piece.held.into[cell] / cells.latent[cell]
        share[cell] = min(max(share[cell], 0.0), 1.0)
    for node in fronts.waiting.tolist():
        for cell in standing_at(cells, fronts, node):
            share[cell] = fronts.share[cell]
        pocket[node] = pocket_after(cells, fronts, piece.held.into, piece.held.taken, node)
    moved = replace(fronts, share=share, pocket=pocket)
    heat = float(piece.held.into.sum()) + sum(piece.held.taken.values())
    missing = heat - (moved.latent_heat(cells) - fronts.latent_heat(cells))
    slight = tuple(FrontEvent("pass", int(cells.nodes[cell, 0]), cell) for cell in piece.shares)
    return _warmed(model, (cells, fronts), after, missing, events or slight), moved


def _heat(model: HeatModel, cells: FrontCells, fronts: Fronts, bare: HeatValues) -> float:
    """Heat content of the bodies with fronts [J]."""
    content = content_of_phases(model, cells, fronts, bare)
    return fronts.latent_heat(cells) + sum(float(content[phases.nodes].sum()) for phases in cells.phases)


def _warmed(
    model: HeatModel, at: tuple[FrontCells, Fronts], after: HeatValues, heat: float, events: tuple[FrontEvent, ...]
) -> HeatValues:
    """State with a ``heat`` [J] that the nodes of ``events`` with a free temperature have taken."""
    (cells, fronts), capacity = at, np.zeros(model.n_nodes)
    for phases in cells.phases:
        here = phases.nodes
        capacity[here] = model.mass[here] * phases.content(fronts.liquid).capacity(after.temperature[here])
    free, near = model.free_nodes(), {event.node for event in events}
    beside = {int(k) for j in near for k in cells.nodes[cells.around(j)].ravel()}
    nodes = [j for j in sorted(near) if free[j]] or [j for j in sorted(beside) if free[j]]
    if not nodes or heat == 0.0:
        return after
    unknowns = after.unknowns.copy()
    unknowns[nodes] += heat / capacity[nodes].sum()
    return heat_values(model, unknowns)
