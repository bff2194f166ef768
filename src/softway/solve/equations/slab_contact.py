"""Contact of a slab: fixed rows, and rows that are linearised again at every iterate."""

from dataclasses import dataclass, replace
from typing import Protocol, Self

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.contact_rows import ContactRows
from softway.contact.contact_set import SlabContacts
from softway.model.model import Model
from softway.solve.constraints.compliance import FrozenOperator
from softway.solve.constraints.normal_active_set import RowConditions
from softway.solve.constraints.return_map import slip_conditions
from softway.solve.constraints.row_basis import RowCoefficients
from softway.solve.equations.slab_values import Evaluation


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class InitialContact:
    """Contact forces at t0: their ``rows``, normal forces ``pressure`` (m,) and tangential forces ``traction`` (m, d)
    [N].
    """

    rows: ContactRows
    pressure: Array
    traction: Array


class SlabContact(Protocol):
    """Contact rows of one slab with their conditions."""

    @property
    def initial(self) -> InitialContact:
        """Contact forces at t0."""
        ...

    @property
    def conditions(self) -> RowConditions:
        """Conditions on the rows; where rows change, without their targets."""
        ...

    @property
    def kept(self) -> bool:
        """True if nodes are kept on the facets where they were found."""
        ...

    def at(self, u1: Array) -> ContactRows:
        """Rows at the end displacement ``u1`` (n, d)."""
        ...

    def nearest_rows(self, u1: Array) -> ContactRows:
        """Rows at the end displacement ``u1`` (n, d) on the facets that are nearest there."""
        ...

    def linearised(
        self, model: Model, span: float, q: Array, end: Evaluation, frozen: FrozenOperator
    ) -> tuple[RowCoefficients, RowConditions]:
        """Rows along the contact directions of an operator with their conditions, linear at q (n, d)."""
        ...

    def with_conditions(self, conditions: RowConditions) -> Self:
        """Contact with other conditions on its rows."""
        ...

    def with_kept_facets(self, u1: Array, active: BoolArray) -> "SlabContact":
        """Contact with nodes kept on their facets at ``u1`` (n, d); itself if nothing changes.

        ``active`` are the touching rows, followed with friction by the slipping rows; these continue to slip.
        """
        ...

    def facets_complete(self, u1: Array) -> bool:
        """True if kept facets leave no overlap with others at ``u1`` (n, d)."""
        ...

    def with_added_facets(self, u1: Array) -> "SlabContact":
        """Contact with the overlapped facets at ``u1`` (n, d) added, or with newly chosen facets."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FixedContact:
    """Rows that never change during the slab.

    Parameters
    ----------
    rows, conditions
        The rows with their conditions.
    initial
        Contact forces at t0.
    live
        (k,) numbers of the rows that have conditions; None if all have.
    """

    rows: ContactRows
    conditions: RowConditions
    initial: InitialContact
    live: IntArray | None = None

    @property
    def kept(self) -> bool:
        """False: there are no facets to keep."""
        return False

    def at(self, u1: Array) -> ContactRows:
        """The rows, wherever the slab ends."""
        return self.rows

    def nearest_rows(self, u1: Array) -> ContactRows:
        """The rows, wherever the slab ends."""
        return self.rows

    def linearised(
        self, model: Model, span: float, q: Array, end: Evaluation, frozen: FrozenOperator
    ) -> tuple[RowCoefficients, RowConditions]:
        """The rows along the contact directions, with their conditions."""
        found = frozen.coefficients(self.rows, model.dofs)
        return (found if self.live is None else found.subset(self.live)), self.conditions

    def with_conditions(self, conditions: RowConditions) -> "FixedContact":
        """Contact with other conditions on its rows."""
        return replace(self, conditions=conditions)

    def with_kept_facets(self, u1: Array, active: BoolArray) -> "FixedContact":
        """Return this contact: no facets change."""
        return self

    def facets_complete(self, u1: Array) -> bool:
        """True: no facets are kept."""
        return True

    def with_added_facets(self, u1: Array) -> "FixedContact":
        """Return this contact: no facets change."""
        return self


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TurningContact:
    """Rows that turn with the surfaces or change their opponent: linearised again at every iterate.

    Parameters
    ----------
    pairs
        Pairs of the slab, with facets chosen anew at every iterate.
    facets
        Pairs of the rows: ``pairs``, or the same with ``kept`` facets.
    kept
        True if nodes are kept on the facets where they were found.
    conditions
        Conditions on the rows without their targets.
    initial
        Contact forces at t0.
    """

    pairs: SlabContacts
    facets: SlabContacts
    conditions: RowConditions
    initial: InitialContact
    kept: bool = False

    def at(self, u1: Array) -> ContactRows:
        """Rows at the end displacement ``u1`` (n, d)."""
        return self.facets.at(u1)

    def nearest_rows(self, u1: Array) -> ContactRows:
        """Rows at the end displacement ``u1`` (n, d) on the facets that are nearest there."""
        return self.pairs.at(u1)

    def linearised(
        self, model: Model, span: float, q: Array, end: Evaluation, frozen: FrozenOperator
    ) -> tuple[RowCoefficients, RowConditions]:
        """Rows along the contact directions with their conditions, linear at q (n, d).

        ``gap(u1) + (h/2) G (z - q) >= 0`` gives the target of the free components of z.
        """
        rows, mine = end.rows, self.conditions
        fixed = model.supported(q)
        with np.errstate(invalid="ignore"):
            target = rows.normal_component(q - fixed) - 2.0 * rows.gap(end.displacement) / span
        reachable = rows.reachable(model.dofs)
        conditions = RowConditions(
            target=np.where(reachable, target, 0.0),
            equal=mine.equal,
            unilateral=reachable,
            slipping=slip_conditions(mine.slipping, rows.shear, fixed, span),
            rounding=mine.rounding,
        )
        return frozen.coefficients(rows, model.dofs), conditions

    def with_conditions(self, conditions: RowConditions) -> "TurningContact":
        """Contact with other conditions on its rows."""
        return replace(self, conditions=conditions)

    def with_kept_facets(self, u1: Array, active: BoolArray) -> "TurningContact":
        """Contact with nodes kept on their facets at ``u1`` (n, d); slipping rows continue to slip."""
        if self.kept:
            return self
        slipping = self.conditions.slipping.with_slipping(active[len(self.conditions.equal) :])
        conditions = replace(self.conditions, slipping=slipping)
        return replace(self, facets=self.pairs.with_kept_facets(u1), kept=True, conditions=conditions)

    def facets_complete(self, u1: Array) -> bool:
        """True if kept facets leave no overlap with others at ``u1`` (n, d)."""
        return not self.kept or self.pairs.apart(u1)

    def with_added_facets(self, u1: Array) -> "TurningContact":
        """Contact with the overlapped facets at ``u1`` (n, d) added, or with newly chosen facets."""
        more = self.pairs.with_kept_facets(u1, self.facets)
        grown = more.at(u1).near.sum() > self.facets.at(u1).near.sum()
        return replace(self, facets=more if grown else self.pairs.with_kept_facets(u1))
