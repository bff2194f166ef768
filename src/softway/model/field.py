"""Fields of a model: the displacement, and companion fields with equations of their own (docs/theory/solver/fields.md).

A companion field (temperature, concentration, damage, ...) has values at the nodes.  It is solved for the end of the
slab at every evaluation of the equations of motion, so that motion and field meet in one fixed point, and returns a
force and an energy to the motion.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

import numpy as np

from softway.arrays import Array
from softway.bodies.assembled.material_states import MaterialStates
from softway.bodies.discretised import DiscreteSolid
from softway.contact.contact_rows import ContactRows


@dataclass(frozen=True, slots=True, kw_only=True)
class Field:
    """A quantity with values (n, components) at the nodes.

    Examples
    --------
    >>> Field(name="temperature", unit="K", components=1).name
    'temperature'
    """

    name: str
    unit: str
    components: int


def _none() -> Array:
    return np.zeros(0)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FieldState:
    """Companion field at one instant.

    Parameters
    ----------
    values
        (n, components).
    energy
        (parts,) energy that the field adds to the stored energy of each solid [J].
    force
        (n, d) internal force that the field adds [N].
    abrupt
        True if the field has just met a sudden change.
    unknowns
        Unknowns of the field that have more digits than its values; empty where they are its values.
    """

    values: Array
    energy: Array
    force: Array
    abrupt: bool = False
    unknowns: Array = field(default_factory=_none)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FieldContact:
    """Contact in a slab as a companion field sees it.

    Parameters
    ----------
    first, last
        Contact rows at both ends.
    before, after
        (m,) normal forces at both ends [N].
    """

    first: ContactRows
    last: ContactRows
    before: Array
    after: Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FieldSlab:
    """One slab as a companion field sees it: length [s], state at the start, displacements (n, d) at both ends [m],
    contact, the weight of the force at the start in the mean forces, and the state at the end that the iterate before
    had, None at first.
    """

    span: float
    start: FieldState
    u0: Array
    u1: Array
    contact: FieldContact
    first: float = 0.5
    expected: FieldState | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StopsInSlab:
    """Stops between rigid bodies in a slab, by name: the part of it in which they were closed, and the energies that
    they dissipated [J].
    """

    closed: Mapping[str, float]
    spent: Mapping[str, float]

    def agrees(self, other: "StopsInSlab", tolerance: float, rounding: float) -> bool:
        """True if both are equal up to a ``tolerance``, relative to the slab and to the greatest energy, or up to the
        ``rounding`` of energies [J].
        """
        most = max(tolerance * max(map(abs, self.spent.values()), default=0.0), rounding)
        closed = all(abs(self.closed[name] - other.closed[name]) <= tolerance for name in self.closed)
        return closed and all(abs(self.spent[name] - other.spent[name]) <= most for name in self.spent)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FieldSolution:
    """Companion field in one slab.

    Parameters
    ----------
    end
        State at the end.
    mean_force
        (n, d) mean over the slab of the internal force that the field adds [N].
    lost
        (parts,) energy that motion and stored energy give to the field [J].
    cancelled
        (parts,) magnitude of energies that cancel those of the solids, whose rounding is in the balance [J].
    account
        What the field tells about the slab.
    """

    end: FieldState
    mean_force: Array
    lost: Array
    account: object = None
    cancelled: Array | float = 0.0


class FieldEquations(Protocol):
    """Equations of a companion field on the nodes of a model, with an operator and a time weight of their own."""

    @property
    def field(self) -> Field:
        """The field."""
        ...

    def initial(self) -> Array:
        """Initial values (n, components)."""
        ...

    def at(self, values: Array, u: Array) -> FieldState:
        """State with the ``values`` (n, components) at the displacement ``u`` (n, d)."""
        ...

    def solve(self, slab: FieldSlab) -> FieldSolution:
        """Solve the field for the end of a slab.

        For each solid the work of the mean force along ``u1 - u0`` is ``energy1 - energy0 + lost``, to the order of the
        time weight; the energy closure of the slab adds the rest.

        Raises
        ------
        NoConvergence
            If there is no solution; the slab is then cut back.
        """
        ...


@runtime_checkable
class RubbedField(Protocol):
    """Equations of a companion field that friction heats."""

    def solver(self, slab: FieldSlab) -> Callable[[Array], FieldSolution]:
        """Solver of the field for a slab, from the energies (m,) that friction dissipates at the contact rows [J]."""
        ...


@runtime_checkable
class StiffField(Protocol):
    """Equations of a companion field whose force scales the stiffness of solids, which the operator has to know."""

    def stiffness_factor(self, state: FieldState) -> Array | None:
        """Factor (n,) of the stiffness of the nodes in a state; None without."""
        ...


@runtime_checkable
class FieldOfBodies(Protocol):
    """Equations of a companion field that has values of rigid bodies, too."""

    def of_bodies(self, state: FieldState) -> dict[str, Array]:
        """Values (1, components) of rigid bodies in a state, by name."""
        ...

    def with_bodies(self, state: FieldState, found: Mapping[str, Array]) -> FieldState:
        """State with the values ``found`` (1, components) of rigid bodies by name."""
        ...


@runtime_checkable
class HangingField(Protocol):
    """Equations of a companion field whose values at hanging nodes follow those of the larger cells."""

    @property
    def hangs(self) -> bool:
        """True if they follow."""
        ...


def stiffness_factor(companions: tuple[FieldEquations, ...], fields: Sequence[FieldState]) -> Array | None:
    """Factor (n,) of the stiffness of the nodes in the operator, from states of the fields; None without."""
    for c, state in zip(companions, fields, strict=True):
        found = c.stiffness_factor(state) if isinstance(c, StiffField) else None
        if found is not None:
            return found
    return None


@runtime_checkable
class MaterialField(Protocol):
    """Equations of a companion field whose force and energy depend on the history of the materials."""

    def in_states(self, states: MaterialStates) -> FieldEquations:
        """Equations outside of a slab, of solids in these material states."""
        ...


def in_states(companions: tuple[FieldEquations, ...], states: MaterialStates) -> tuple[FieldEquations, ...]:
    """Companion fields outside of a slab, of solids in material states."""
    return tuple(c.in_states(states) if isinstance(c, MaterialField) else c for c in companions)


@runtime_checkable
class TimedField(Protocol):
    """Equations of a companion field with loads that change in time, or with an operator that is factored once a slab:
    they are solved in a slab only.
    """

    def in_slab(
        self,
        ends: tuple[float, float],
        parts: Sequence[DiscreteSolid],
        u0: Array,
        start: FieldState,
        beside: Mapping[str, Array],
    ) -> FieldEquations:
        """Equations in a slab between two times [s], of solids with the material states, the displacement ``u0`` (n, d)
        [m], the state of the field at its ``start``, and the values there of all fields by name.
        """
        ...


def in_slab(
    companions: tuple[FieldEquations, ...],
    ends: tuple[float, float],
    parts: Sequence[DiscreteSolid],
    u0: Array,
    fields: Sequence[FieldState],
) -> tuple[FieldEquations, ...]:
    """Companion fields in a slab between two times [s], from their states at its start; the same if none changes."""
    if not any(isinstance(c, TimedField) for c in companions):
        return companions
    beside = {c.field.name: state.values for c, state in zip(companions, fields, strict=True)}
    return tuple(
        c.in_slab(ends, parts, u0, state, beside) if isinstance(c, TimedField) else c
        for c, state in zip(companions, fields, strict=True)
    )


@runtime_checkable
class StoppedField(Protocol):
    """Equations of a companion field that stops between rigid bodies heat."""

    @property
    def feels_stops(self) -> bool:
        """True if it does in this model."""
        ...

    def with_stops(self, stops: StopsInSlab) -> FieldEquations:
        """Equations in a slab in which stops have been closed, and have dissipated energy."""
        ...


def feel_stops(companions: tuple[FieldEquations, ...]) -> bool:
    """True if a companion field depends on stops."""
    return any(isinstance(c, StoppedField) and c.feels_stops for c in companions)


def with_stops(companions: tuple[FieldEquations, ...], stops: StopsInSlab) -> tuple[FieldEquations, ...]:
    """Companion fields in a slab with these stops."""
    return tuple(c.with_stops(stops) if isinstance(c, StoppedField) else c for c in companions)
