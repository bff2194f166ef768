"""Supports whose motion is not given, but follows from the forces of the slab (time step) on them."""

from typing import Protocol

from softway.arrays import Array
from softway.model.model import Model
from softway.solve.constraints.compliance import FrozenOperator
from softway.solve.equations.slab_values import Evaluation


class Follower(Protocol):
    """Motion x (c,) of supports, as velocities [m/s], and how it answers to an iterate."""

    @property
    def x(self) -> Array:
        """Present motion (c,)."""
        ...

    @property
    def model(self) -> Model:
        """Model whose supports have this motion."""
        ...

    def at(self, x: Array) -> "Follower":
        """Follower with another motion x (c,)."""
        ...

    def prepared(self, frozen: FrozenOperator) -> "Follower":
        """Follower whose answers are computed with an operator."""
        ...

    def given(self, given: Array) -> Array:
        """Values (n, d) of q on supported components: those ``given``, except on the supports that follow."""
        ...

    def answered(self, q: Array, step: Array, end: Evaluation) -> tuple[Array, Array]:
        """Next unknowns (f,) and motion (c,), from q (f,) with its evaluation, and a ``step`` (f,) held there."""
        ...
