"""Velocity jumps and reactions of contact rows that come into contact one after another."""

from collections.abc import Sequence

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.contact_rows import ContactRows
from softway.kernels.linalg.dense import NestedFactor, nested
from softway.solve.constraints.compliance import TOGETHER, FrozenOperator
from softway.solve.constraints.impact_multipliers import ImpactMultipliers
from softway.solve.constraints.normal_active_set import delassus
from softway.solve.constraints.row_basis import RowCoefficients, UnitRows


class ImpactSequence:
    """Jumps and reactions of rows, in the ``order`` (k,) in which they come into contact.

    The compliance is factored once for all rows: the factor of those in contact at an impact is its leading block.  If
    rows are released, it is factored again without them.
    """

    __slots__ = ("_coefficients", "_factor", "_inertia", "_order")

    def __init__(self, inertia: ImpactMultipliers, rows: ContactRows, order: IntArray) -> None:
        self._inertia = inertia
        self._order = order[rows.reachable(inertia.model.dofs)[order]]
        self._coefficients = inertia.mass.coefficients(rows.without_friction(), inertia.model.dofs)
        self._factor: NestedFactor | None = None

    def stopped(self, approach: Array, closed: BoolArray) -> tuple[Array, Array]:
        """Impulses (m,) that bring the ``closed`` rows (m,) from ``approach`` (m,) to rest, and the change (m,) of the
        normal velocities of those and all later rows.
        """
        impulse, change, there = np.zeros(len(closed)), np.zeros(len(closed)), closed[self._order]
        count = int(there.sum())
        if count:
            factor = self._factored(there, count)
            now = self._order[:count]
            impulse[now] = factor.solve(-approach[now])
            change[self._order] = factor.matrix[:, :count] @ impulse[now]
        return impulse, change

    def reactions(self, force: Array, closed: BoolArray) -> Array:
        """Normal reaction (m,) of the ``closed`` rows (m,) for the internal force (n, d); zero on the others [N]."""
        out, there = np.zeros(len(closed)), closed[self._order]
        count = int(there.sum())
        if count:
            inertia = self._inertia
            factor = self._factored(there, count)
            pull = inertia.mass.solve(inertia.model.dofs.forces(force - inertia.model.load))
            moved = self._coefficients.from_basis(inertia.mass.restrict(pull))
            out[self._order[:count]] = factor.solve(moved[self._order[:count]])
        return out

    def _factored(self, there: BoolArray, count: int) -> NestedFactor:
        """Factor whose first ``count`` rows are those in contact."""
        if self._factor is None or not there[:count].all():
            last = int(np.flatnonzero(there)[-1])
            self._order = np.concatenate([self._order[there], self._order[last + 1 :]])
            self._factor = nested(_compliance(self._inertia.mass, self._coefficients.subset(self._order)))
        return self._factor

    def fields(self, impulses: Sequence[Array]) -> list[Array]:
        """Velocity jumps (n, d) of all nodes by impulses (m,) of the rows."""
        if not impulses:
            return []
        mass, dofs, rows = self._inertia.mass, self._inertia.model.dofs, self._coefficients
        found = []
        for start in range(0, len(impulses), TOGETHER):
            pushes = [mass.basis.directions @ rows.spread(p) for p in impulses[start : start + TOGETHER]]
            answers = mass.solve(np.ascontiguousarray(np.array(pushes).T))
            found += [dofs.nodes(np.ascontiguousarray(answer)) for answer in answers.T]
        return found


def contact_order(touch: Array, closed: BoolArray) -> IntArray:
    """Rows (k,) in the order of their contact: those closed at the start, then those that ``touch`` (m,).

    Examples
    --------
    >>> contact_order(np.array([0.5, np.nan, np.nan, 0.2]), np.array([False, True, False, False])).tolist()
    [1, 3, 0]
    """
    since = np.where(closed, -1.0, touch)
    order = np.argsort(since, kind="stable")
    return order[np.isfinite(since[order])]


def _compliance(mass: FrozenOperator, active: RowCoefficients) -> Array:
    """Compliance (k, k) of the rows; the table, which may be large, is not copied."""
    if isinstance(active, UnitRows):
        return delassus(mass, active)
    mass.fill(active.used)
    return np.asarray(active.matrix @ mass.table.combined(active.matrix).T)
