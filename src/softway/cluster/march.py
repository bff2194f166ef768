"""March of a model over ranks (docs/theory/solver/ranks.md)."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from softway.cluster.admitted import require_several
from softway.cluster.cells.rank_mesh import local_nodes
from softway.cluster.own_gradients import method_of_ranks, method_of_whole
from softway.cluster.rank_model import held_by, rank_model, without_tables
from softway.cluster.rank_state import RankNumbers, on_all, on_rank, rank_numbers
from softway.errors import Cancel
from softway.marching.audit.folded_cells import WatchedCells, watched_cells
from softway.marching.results.finding import FLAT_CELL, INVERTED
from softway.marching.results.step import Event, Step
from softway.marching.results.step_states import KnownStates
from softway.marching.results.trying import TryWatch
from softway.marching.slab.slab_step import stepper
from softway.marching.slabs import slabs
from softway.marching.start.preparation import prepare
from softway.marching.state.march_state import MarchState, Settings
from softway.marching.state.model_state import ModelState, split_states
from softway.model.model import Model
from softway.model.scene import State
from softway.ranks.interface import Ranks
from softway.ranks.partition import Holding

OF_CELLS = FLAT_CELL, INVERTED
"""Findings on cells: a rank knows its own cells alone, so that they are looked for in the whole model."""


def march_on(
    ranks: Ranks,
    model: Model,
    settings: Settings,
    state: State | MarchState | None = None,
    cancel: Cancel | None = None,
    trying: TryWatch | None = None,
) -> Iterator[Step | None]:
    """Accepted slabs of a march over ranks: steps of the whole model on rank 0, None on the others.

    The march is prepared by every rank alike, on the whole model; the slabs are those of the ranks together.  The bits
    of all numbers are the same for any number of ranks, one included.

    Parameters are those of :func:`~softway.marching.start.preparation.prepare`; ``cancel`` is that of rank 0, and
    ``trying`` is called there.

    Raises
    ------
    InputError
        On all ranks: what :func:`~softway.marching.march.march` refuses, and what runs on one rank only.
    NumericsError, Cancelled
        On all ranks, as for :func:`~softway.marching.march.march`.
    """
    require_several(model, settings.method, ranks.size)
    prepared = prepare(model, replace(settings, method=method_of_whole(settings.method)), state)
    start, ends = prepared.march_state, prepared.stepper.ends
    numbers = rank_numbers(model, held_by(model, ranks))
    whole = None if ranks.rank else _Whole(watched_cells(model), start.state, split_states(model, start.state))
    model = without_tables(model)
    del state, prepared  # what the other ranks hold of the whole
    model = rank_model(model, numbers.held, ranks)
    asked = None if not ranks.told(cancel is not None) else lambda: bool(ranks.told(cancel is not None and cancel()))
    method = method_of_ranks(settings.method, tell=ranks.rank == 0)
    own = replace(stepper(model, method, settings.weight, asked, None if ranks.rank else trying), ends=ends)
    start = on_rank(replace(start, settings=replace(start.settings, method=settings.method)), numbers)
    for step in slabs(own, start):
        reached = _on_whole(step, whole, numbers, ranks)
        if whole is not None and reached is not None:
            whole = replace(whole, now=reached.march_state.state, before=reached.after)
        yield reached


@dataclass(frozen=True, slots=True, eq=False)
class _Whole:
    """Cells of the whole model, and its state before a slab."""

    shapes: WatchedCells
    now: ModelState
    before: State


def _on_whole(step: Step, whole: _Whole | None, numbers: RankNumbers, ranks: Ranks) -> Step | None:
    """Step of the whole model on rank 0; None on the others."""
    found = on_all(step.march_state, numbers, ranks, np.concatenate(list(step.reactions.values())))
    if found is None or whole is None:
        return None
    (march_state, support), model = found, whole.shapes.model
    states = KnownStates(
        before=whole.before,
        after=split_states(model, march_state.state),
        reactions=model.split(support),
        march_state=march_state,
    )
    events = [_in_body(event, model, numbers.held) for event in step.events if event.kind not in OF_CELLS]
    bad = whole.shapes.findings(step.certificate, whole.now, march_state.state)
    return replace(step, model=model, events=(*events, *bad), states=states)


def _in_body(event: Event, model: Model, held: Holding) -> Event:
    """Event with the number that its node has in the whole body."""
    if event.node < 0 or not event.bodies:
        return event
    own = next(part.nodes for part in model.parts if part.name == event.bodies[0])
    first = local_nodes(own, held).start
    return replace(event, node=int(held.nodes[first + event.node]) - own.start)
