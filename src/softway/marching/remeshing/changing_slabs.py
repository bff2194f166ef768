"""Slabs of a march whose meshes change between them."""

import logging
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Generic, Protocol, TypeVar

from softway.adaptivity.transfer import Transferred
from softway.errors import Cancel, NumericsError
from softway.marching.results.exchange import Exchange
from softway.marching.results.step import Step
from softway.marching.results.trying import TryWatch
from softway.marching.slab.slab_step import Stepper
from softway.marching.slabs import slabs
from softway.marching.start.preparation import Preparation, prepare
from softway.marching.state.march_state import MarchState, Settings
from softway.model.model import Model

log = logging.getLogger(__name__)


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
    rescue: Callable[[On, MarchState, bool, NumericsError], Change[On] | None],
    meshes_first: bool = False,
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
        As for :func:`~softway.marching.start.preparation.prepare`.
    rescue
        Change before another try of a slab that failed at every length, from the state before the slab; True if it
        failed on new meshes, and how.  None where no other meshes are to be had.
    meshes_first
        True if other meshes are tried before dashpots where massless nodes have no equilibrium.

    Raises
    ------
    NumericsError, Cancelled
        As for :func:`~softway.marching.slabs.slabs`.
    """
    now, settings = prepared.march_state, prepared.march_state.settings
    stepper = replace(prepared.stepper, dashpots=not meshes_first)
    here = _OnMeshes(on=on, stepper=stepper, steps=slabs(stepper, now))
    while now.state.time < settings.until - 1e-9 * now.step_history.span:
        found = change(here.on, now) if now.slabs else None
        there = here.after(found, settings, cancel, trying)
        try:
            step = next(there.steps)
        except NumericsError as failure:
            rescued = rescue(here.on, now, there.on is not here.on, failure)
            if rescued is not None:
                log.info("slab at t = %.6g s tried again on other meshes: %s", now.state.time, failure.what)
                found, there = rescued, here.after(rescued, settings, cancel, trying)
            elif there.stepper.dashpots:
                raise
            step = next(slabs(replace(there.stepper, dashpots=True), now if found is None else found.now))
            there = replace(there, steps=slabs(there.stepper, step.march_state))
        here, now = there, step.march_state
        yield step if found is None else replace(step, transfers=found.transfers, exchanges=found.exchanges)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _OnMeshes(Generic[On]):
    """A scene on its present meshes, and its slabs to come."""

    on: On
    stepper: Stepper
    steps: Iterator[Step]

    def after(
        self, found: Change[On] | None, settings: Settings, cancel: Cancel | None, trying: TryWatch | None
    ) -> "_OnMeshes[On]":
        """The same after a change; the meshes stay where it has the same scene."""
        if found is None:
            return self
        if found.on is self.on:
            return replace(self, steps=slabs(self.stepper, found.now))
        prepared = prepare(found.on.model, settings, found.now, cancel, trying)
        stepper = replace(prepared.stepper, dashpots=self.stepper.dashpots)
        return _OnMeshes(on=found.on, stepper=stepper, steps=slabs(stepper, found.now))
