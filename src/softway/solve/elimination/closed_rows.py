"""Closed contact rows G, eliminated with an approximate inverse D of the operator (docs/theory/solver/elimination.md).

All products are sparse: with nodal blocks D, the matrix ``S = G D^-1 G^T`` couples rows of the same nodes only.
"""

from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, greatest
from softway.kernels.linalg.dense import solve_dense
from softway.solve.constraints.compliance import FrozenOperator, RowBasis
from softway.solve.constraints.normal_active_set import delassus
from softway.solve.constraints.row_basis import RowCoefficients, UnitRows
from softway.solve.linear.backends.superlu import SuperLU
from softway.solve.linear.interface import Factor

LIFT = 1e-11
"""Part of the greatest diagonal entry that is added to the diagonal, so that dependent rows have a factor."""
REFINEMENTS = 3
"""Greatest number of refinements of a solution with the original matrix, which remove the effect of ``LIFT``."""
REFINED = 4.0 * float(np.finfo(float).eps)
"""Greatest residual of a refined solution, relative to the right side."""


@dataclass(frozen=True, slots=True, eq=False)
class ClosedRows:
    """Closed rows of one active set.

    Parameters
    ----------
    matrix
        (c, f) rows G.
    lifted
        (f, c) motion ``D^-1 G^T`` by unit multipliers.
    compliance
        (c, c) sparse ``S = G D^-1 G^T``.
    """

    matrix: sp.csr_array
    lifted: sp.csr_array
    compliance: sp.csc_array
    diagonal: Array = field(init=False)
    factor: Factor | None = field(init=False)
    pulled: sp.csr_array = field(init=False)
    transposed: sp.csr_array = field(init=False)

    def __post_init__(self) -> None:
        S = self.compliance
        diagonal = S.diagonal()
        object.__setattr__(self, "diagonal", diagonal)
        object.__setattr__(self, "pulled", sp.csr_array(self.lifted.T))
        object.__setattr__(self, "transposed", sp.csr_array(self.matrix.T))
        coupled = S.nnz > np.count_nonzero(diagonal)
        object.__setattr__(self, "factor", _lifted(S) if coupled else None)

    @classmethod
    def of(cls, matrix: sp.csr_array, inverse: Factor) -> "ClosedRows":
        """Closed rows G (c, f), all of which the unknowns move, with D^-1 (f, f)."""
        lifted = sp.csr_array(inverse.solve(sp.csc_array(matrix.T)))
        compliance = sp.csc_array(matrix @ lifted)
        compliance.eliminate_zeros()
        return cls(matrix, lifted, compliance)

    def forces(self, wanted: Array) -> Array:
        """Multipliers (c,) ``S^-1 wanted`` that move the rows by ``wanted`` (c,) against D alone."""
        if self.factor is None:
            return np.asarray(wanted / self.diagonal)
        found, goal = self.factor.solve(wanted), REFINED * greatest(wanted)
        for _ in range(REFINEMENTS):
            left = wanted - self.compliance @ found
            if greatest(left) <= goal:
                break
            found = found + self.factor.solve(left)
        return found

    def motion(self, wanted: Array) -> Array:
        """Shortest motion (f,) in the norm of D that moves the rows by ``wanted`` (c,)."""
        return np.asarray(self.lifted @ self.forces(wanted))

    def multipliers(self, residual: Array) -> Array:
        """Multipliers (c,) ``S^-1 G D^-1 r`` that balance a residual r (f,) best, in the norm of D^-1."""
        return self.forces(self.pulled @ residual)

    def balanced(self, residual: Array) -> Array:
        """The residual r (f,) without the forces of its :meth:`multipliers`."""
        return residual - self.transposed @ self.multipliers(residual)

    def kept(self, residual: Array, z: Array) -> Array:
        """``z = D^-1 r`` (f,) of a residual r (f,), without its motion of the rows: what ``D^-1`` makes of the residual
        without its multipliers.
        """
        return z - self.lifted @ self.multipliers(residual)

    def removed(self, z: Array) -> Array:
        """The field z (f,) without its motion of the rows: its projection on ``G z = 0`` in the norm of D."""
        return z - self.motion(self.matrix @ z)


def row_matrix(coefficients: RowCoefficients, basis: RowBasis) -> sp.csr_array:
    """Rows G (m, f) on the unknowns, in the axes of an operator, from their coefficients along its directions."""
    if not isinstance(coefficients, UnitRows):
        return sp.csr_array(coefficients.matrix @ basis.transposed)
    own = np.flatnonzero(coefficients.index >= 0)
    shape = (len(coefficients.index), basis.transposed.shape[0])
    unit = sp.csr_array((np.ones(len(own)), (own, coefficients.index[own])), shape=shape)
    return sp.csr_array(unit @ basis.transposed)


def forces_of_motion(frozen: FrozenOperator, coefficients: RowCoefficients, wanted: Array) -> Array:
    """Multipliers (k,) that move rows by ``wanted`` (k,) against an operator: by its compliance, or by nodal blocks if
    its solutions are not reproducible to machine precision.
    """
    if frozen.local is None:
        return solve_dense(delassus(frozen, coefficients), wanted)
    return ClosedRows.of(row_matrix(coefficients, frozen.basis), frozen.local).forces(wanted)


def lift_of(diagonal: Array) -> float:
    """Number that is added to the diagonal (c,) of a compliance whose rows may depend on each other."""
    return LIFT * float(np.abs(diagonal).max())


def _lifted(matrix: sp.csc_array) -> Factor:
    """Factor of a sparse symmetric matrix whose rows may depend on each other."""
    lift = lift_of(matrix.diagonal())
    return SuperLU().factor(sp.csc_array(matrix + lift * sp.eye_array(matrix.shape[0], format="csc")))
