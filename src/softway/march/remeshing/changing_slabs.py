"""Slabs of a march whose meshes change between them."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Generic, Protocol, TypeVar

from softway.adaptivity.transfer import Transferred
from softway.errors import Cancel
from softway.march.results.exchange import Exchange
from softway.march.results.step import Step
from softway.march.results.trying import TryWatch
from softway.march.slabs import slabs
from softway.march.start.preparation import Preparation, prepare
from softway.march.state.march_state import MarchState
from softway.model.model import Model


class OnMeshes(Protocol):
    """Scene on its present meshes."""

    @property
    def model(self) -> Model:
        """Its model."""
        ...


On = TypeVar("On", bound=OnMeshes)
"""Kind of a scene on its present meshes."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Change(Generic[On]):
    """Change of meshes: the scene on the new ones, the march state on them, and what has passed, by solid."""

    on: On
    now: MarchState
    transfers: Mapping[str, Transferred] = field(default_factory=dict)
    exchanges: Mapping[str, Exchange] = field(default_factory=dict)


def changing_slabs(
    on: On,
    prepared: Preparation,
    change: Callable[[On, MarchState], Change[On] | None],
    cancel: Cancel | None,
    trying: TryWatch | None,
) -> Iterator[Step]:
    """Accepted slabs of a march whose meshes change between them.

    Parameters
    ----------
    on, prepared
        Scene on its meshes at the start, and the preparation of the march on them.
    change
        Change of meshes after a slab, with the same scene where only the state changes; None where they stay.  The
        state after a slab alone decides, so that a resumed march has the same bits.
    cancel, trying
        As for :func:`~softway.march.start.preparation.prepare`.
    """
    now = prepared.march_state
    stepper, settings = prepared.stepper, now.settings
    steps = slabs(stepper, now)
    while now.state.time < settings.until - 1e-9 * now.step_history.span:
        found = change(on, now) if now.slabs else None
        if found is not None:
            now = found.now
            if found.on is not on:
                on, stepper = found.on, prepare(found.on.model, settings, now, cancel, trying).stepper
            steps = slabs(stepper, now)
        step = next(steps)
        now = step.march_state
        yield step if found is None else replace(step, transfers=found.transfers, exchanges=found.exchanges)
