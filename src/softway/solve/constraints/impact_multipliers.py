"""Contact reactions of nodes with inertia: the multipliers that keep the closed rows at rest.

    M a = load - f + G^T lambda,   G a = 0      =>      lambda = (G M^-1 G^T)^-1 G M^-1 (f - load)

The mass-consistent jump ``J = -M^-1 G^T (G M^-1 G^T)^-1 G v`` is that of ``impact_sequence.py``.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.contact_rows import ContactRows
from softway.model.model import Model
from softway.solve.constraints.compliance import FrozenOperator, frozen_operator, row_basis
from softway.solve.constraints.normal_active_set import multipliers
from softway.solve.constraints.row_basis import RowCoefficients
from softway.solve.linear.backends.superlu import SuperLU


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ImpactMultipliers:
    """Factored mass matrix of the unknowns, with the contact directions."""

    model: Model
    mass: FrozenOperator

    def multiplier(self, rows: ContactRows, force: Array, closed: BoolArray) -> Array:
        """Normal reaction (m,) of the closed rows for the internal force (n, d); zero on the others [N]."""
        index, active = self._active(rows, closed)
        out = np.zeros(len(closed))
        if len(index):
            pull = self.mass.solve(self.model.dofs.forces(force - self.model.load))
            out[index] = multipliers(self.mass, active, active.from_basis(self.mass.restrict(pull)))[0]
        return out

    def _active(self, rows: ContactRows, closed: BoolArray) -> tuple[IntArray, RowCoefficients]:
        """Closed rows that can move (k,), with their coefficients along the contact directions."""
        index = np.flatnonzero(closed & rows.reachable(self.model.dofs))
        return index, self.mass.coefficients(rows.without_friction(), self.model.dofs).subset(index)


def impact_multipliers(model: Model) -> ImpactMultipliers:
    """Factor the mass matrix of a model whose nodes all have inertia."""
    mass = model.dofs.matrix(sp.csc_array(sp.kron(model.mass, sp.eye_array(model.shape[1]), format="csc")))
    rows = model.rows(model.displacement).without_friction()
    directions = row_basis(rows, model.dofs, model.contacts.fixed, model.touchable)
    return ImpactMultipliers(model=model, mass=frozen_operator(mass, directions, SuperLU()))
