"""States at the two ends of an accepted slab (time step), known at once or made when they are asked for."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

from softway.arrays import Array
from softway.marching.state.march_state import MarchState
from softway.mechanisms.step import BodyState
from softway.model.scene import State


class Motion(Protocol):
    """Motion of the solids at an instant, as part of a :class:`~softway.model.scene.State`."""

    @property
    def displacement(self) -> Mapping[str, Array]:
        """Solid -> (n, d) displacement [m]."""
        ...

    @property
    def velocity(self) -> Mapping[str, Array]:
        """Solid -> (n, d) velocity [m/s]."""
        ...

    @property
    def fields(self) -> Mapping[str, Mapping[str, Array]]:
        """Companion field -> body -> its values."""
        ...

    @property
    def rigid(self) -> Mapping[str, BodyState]:
        """Rigid body -> its place and motion."""
        ...


class StepStates(Protocol):
    """States of a :class:`~softway.marching.results.step.Step`."""

    @property
    def before(self) -> State:
        """State at the start."""
        ...

    @property
    def after(self) -> State:
        """State at the end."""
        ...

    @property
    def motion(self) -> Motion:
        """Motion at the end: part of ``after`` that takes less to make."""
        ...

    @property
    def reactions(self) -> Mapping[str, Array]:
        """Body -> (n, d) mean force of the supports on the nodes [N]."""
        ...

    @property
    def march_state(self) -> MarchState:
        """State of the march after the slab."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class KnownStates:
    """States that are known at once, see :class:`StepStates`."""

    before: State
    after: State
    reactions: Mapping[str, Array]
    march_state: MarchState

    @property
    def motion(self) -> Motion:
        """Motion at the end."""
        return self.after

    @classmethod
    def of(cls, states: StepStates) -> "KnownStates":
        """The same states, to replace one of them."""
        return cls(before=states.before, after=states.after, reactions=states.reactions, march_state=states.march_state)
