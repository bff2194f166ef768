"""Contact by elimination: active sets of rows without friction, whose closed rows conjugate gradients respect."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray, greatest
from softway.solve.constraints.compliance import FrozenOperator
from softway.solve.constraints.normal_active_set import RowConditions
from softway.solve.constraints.row_basis import RowCoefficients, UnitRows
from softway.solve.effort import Effort
from softway.solve.elimination.closed_rows import ClosedRows, row_matrix
from softway.solve.elimination.redundant_rows import LocalContact
from softway.solve.linear.conjugate_gradients import Descending
from softway.solve.linear.interface import Factor

SWEEPS = 4
"""Greatest number of active sets in one iteration; the next iteration goes on with the last one."""
CLOSED = 1e-13
"""Distance of closed rows from their targets, relative to the greatest, that is corrected without a product."""


@dataclass(frozen=True, slots=True, eq=False)
class Equations:
    """Linear equations of one iteration: residual r (f,) at y (f,), and rows G (m, f), in the axes of the operator."""

    residual: Array
    y: Array
    matrix: sp.csr_array


@dataclass(frozen=True, slots=True, eq=False)
class Answer:
    """Step d (f,) with closed rows, its product ``Ad`` (f,), and the multipliers (c,) of these rows."""

    d: Array
    Ad: Array
    multiplier: Array


@dataclass(frozen=True, slots=True, eq=False)
class Swept:
    """Step d (f,), multipliers (m,), active rows (m,); ``settled`` if they are those of the step; and the velocity that
    forces of slip still ``miss`` [m/s].
    """

    d: Array
    multiplier: Array
    active: BoolArray
    settled: bool
    missed: float = 0.0


class Elimination:
    """Elimination of closed rows for the iterations of one slab.

    It keeps the rows of the last iteration with their factor, which serve again while the active set stays and the rows
    do not turn.  Rows may depend on each other where they are ``redundant``.
    """

    __slots__ = ("closed", "gradients", "key", "known", "local", "matrix", "redundant")

    def __init__(self, gradients: Descending, local: Factor, redundant: bool = False) -> None:
        self.gradients, self.local, self.redundant = gradients, local, redundant
        self.closed: ClosedRows | None = None
        self.key, self.known, self.matrix = b"", b"", sp.csr_array((0, 0))

    def rows(self, coefficients: RowCoefficients, frozen: FrozenOperator) -> sp.csr_array:
        """Rows G (m, f) in the axes of the operator, from their coefficients along its directions."""
        if not isinstance(coefficients, UnitRows):
            self.closed, self.known = None, b""
            return row_matrix(coefficients, frozen.basis)
        key = coefficients.index.tobytes()
        if self.known != key or not self.known:
            self.closed, self.known, self.matrix = None, key, row_matrix(coefficients, frozen.basis)
        return self.matrix

    def of(self, matrix: sp.csr_array, index: IntArray) -> ClosedRows:
        """Closed rows ``index`` (c,) of the rows (m, f)."""
        key = index.tobytes()
        if self.closed is None or key != self.key:
            self.closed, self.key = ClosedRows.of(sp.csr_array(matrix[index]), self.local), key
        return self.closed

    def solve(self, equations: Equations, index: IntArray, target: Array, before: Answer | None) -> Answer:
        """Minimum of ``d.A d/2 + r.d`` with ``G (y + d) = target`` (c,) on the rows ``index`` (c,), by conjugate
        gradients from the answer ``before`` with other rows; multipliers from ``S^-1 G D^-1 (r + A d)``.
        """
        closed, r = self.of(equations.matrix, index), equations.residual
        d, Ad = (np.zeros_like(r), np.zeros_like(r)) if before is None else (before.d, before.Ad)
        missing = target - closed.matrix @ (equations.y + d)
        if greatest(missing) > CLOSED * greatest(target):
            part = closed.motion(missing)
            d, Ad = d + part, Ad + self.gradients.times(part)
        precondition = Projection.of(closed, self.gradients.preconditioner, self.local)
        found = self.gradients.descend(closed.balanced(-(r + Ad)), precondition)
        d, Ad = d + found.x, Ad + found.Ax
        multiplier = closed.multipliers(r + Ad)
        return Answer(d + closed.motion(target - closed.matrix @ (equations.y + d)), Ad, multiplier)


@dataclass(frozen=True, slots=True, eq=False)
class Projection:
    """Preconditioner ``outer`` on the fields that do not move the ``closed`` rows, and residuals without their
    multipliers; ``own`` if it is the inverse D^-1 of the closed rows.
    """

    closed: ClosedRows | None
    outer: Factor
    own: bool = False

    @classmethod
    def of(cls, closed: ClosedRows, outer: Factor, local: Factor) -> "Projection":
        """Preconditioner for rows closed with ``local``; the outer one itself without any."""
        return cls(closed if closed.matrix.shape[0] else None, outer, outer is local)

    def __call__(self, r: Array) -> tuple[Array, Array]:
        """Residual (f,) without the part along the rows, and its preconditioned field (f,).

        Balanced by the same inverse, a residual has a field that does not move the rows.
        """
        if self.closed is None:
            return r, self.outer.solve(r)
        if self.own and self.closed.factor is None:
            return r, self.closed.kept(r, self.outer.solve(r))
        r = self.closed.balanced(r)
        z = self.outer.solve(r)
        return r, z if self.own else self.closed.removed(z)


def normal_sweeps(
    elimination: Elimination, equations: Equations, rows: RowConditions, guess: BoolArray, effort: Effort
) -> Swept:
    """Step with normal contact: rows with a tension are opened and rows with an overlap are closed, at most ``SWEEPS``
    times.

    Of redundant rows those are closed that press in the step against the nodal blocks alone.
    """
    moved = np.diff(equations.matrix.indptr) > 0
    active = (rows.equal | (guess & rows.unilateral)) & moved
    slack = np.where(rows.unilateral & moved, equations.matrix @ equations.y - rows.target, 0.0)
    floor = rows.missable(slack)
    answer: Answer | None = None
    alone = _alone(elimination, equations, rows.unilateral & moved, floor) if elimination.redundant else None
    if alone is not None and not rows.equal.any():
        active = alone(slack, equations.residual, active.astype(float))
    for sweep in range(SWEEPS):
        index = np.flatnonzero(active)
        effort.step(f"contact of {len(active)} rows, {len(index)} active, exchange {sweep}")
        answer = elimination.solve(equations, index, rows.target[index], answer)
        gap = slack + equations.matrix @ answer.d
        multiplier = np.zeros(len(active))
        multiplier[index] = answer.multiplier
        lifts = _lifts(elimination.of(equations.matrix, index), answer.multiplier, floor)
        lifted = np.zeros(len(active), bool)
        lifted[index] = lifts
        wrong = rows.unilateral & moved & (lifted | (~active & (gap < -floor)))
        if not wrong.any():
            return Swept(answer.d, _pressing(rows, multiplier), active, settled=True)
        if alone is None or rows.equal.any():
            active = active ^ wrong
        else:
            active = alone(gap, equations.residual + answer.Ad, multiplier)
    assert answer is not None
    return Swept(answer.d, _pressing(rows, multiplier), active, settled=False)


def _alone(
    elimination: Elimination, equations: Equations, rows: BoolArray, floor: float
) -> Callable[[Array, Array, Array], BoolArray]:
    """Rows (m,) to close where ``rows`` (m,) may, from gaps (m,), the residual (f,) and forces (m,) to begin with."""
    lifted = sp.csr_array(elimination.local.solve(sp.csc_array(equations.matrix.T)))
    contact = LocalContact(sp.csr_array(equations.matrix @ lifted), rows, floor)
    pulled = sp.csr_array(lifted.T)

    def closed(gap: Array, residual: Array, force: Array) -> BoolArray:
        return contact.pressing(gap - pulled @ residual, force)

    return closed


def _pressing(rows: RowConditions, multiplier: Array) -> Array:
    """Multipliers (m,) without tensions of unilateral rows."""
    return np.where(rows.unilateral, np.maximum(multiplier, 0.0), multiplier)


def _lifts(closed: ClosedRows, multiplier: Array, floor: float) -> BoolArray:
    """Rows (c,) whose tension would open them by more than the rounding ``floor`` of gaps, against D alone.

    Bodies that fall together press on each other with forces that are rounding: their signs do not count.
    """
    return np.asarray(multiplier * closed.diagonal < -floor)
