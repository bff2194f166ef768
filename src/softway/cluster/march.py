"""March of a model over ranks (docs/theory/solver/ranks.md)."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from softway.cluster.admitted import require_several
from softway.cluster.own_gradients import method_of_ranks, method_of_whole
from softway.cluster.rank_model import held_by, rank_model
from softway.cluster.rank_state import RankNumbers, on_all, on_rank, rank_numbers
from softway.errors import Cancel
from softway.marching.results.step import Step
from softway.marching.results.step_states import KnownStates
from softway.marching.results.trying import TryWatch
from softway.marching.slab.slab_step import stepper
from softway.marching.slabs import slabs
from softway.marching.start.preparation import prepare
from softway.marching.state.march_state import MarchState, Settings
from softway.marching.state.model_state import split_states
from softway.model.model import Model
from softway.model.scene import State
from softway.ranks.interface import Ranks


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
    held = held_by(model, ranks)
    local = rank_model(model, held, ranks)
    asked = None if not ranks.told(cancel is not None) else lambda: bool(ranks.told(cancel is not None and cancel()))
    method = method_of_ranks(settings.method, tell=ranks.rank == 0)
    own = stepper(local, method, settings.weight, asked, None if ranks.rank else trying)
    own = replace(own, ends=prepared.stepper.ends)
    numbers = rank_numbers(model, held)
    start = prepared.march_state
    start = replace(start, settings=replace(start.settings, method=settings.method))
    before = split_states(model, start.state)
    for step in slabs(own, on_rank(start, numbers)):
        whole = _on_whole(step, model, before, numbers, ranks)
        before = before if whole is None else whole.after
        yield whole


def _on_whole(step: Step, model: Model, before: State, numbers: RankNumbers, ranks: Ranks) -> Step | None:
    """Step of the whole model on rank 0; None on the others."""
    reactions = np.concatenate([step.reactions[part.name] for part in model.parts])
    found = on_all(step.march_state, numbers, ranks, reactions)
    if found is None:
        return None
    march_state, support = found
    states = KnownStates(
        before=before,
        after=split_states(model, march_state.state),
        reactions=model.split(support),
        march_state=march_state,
    )
    nodes = numbers.held.nodes
    events = tuple(replace(e, node=int(nodes[e.node])) if e.node >= 0 else e for e in step.events)
    return replace(step, model=model, events=events, states=states)
