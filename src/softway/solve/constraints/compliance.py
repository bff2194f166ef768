"""Frozen operator of a slab, with the compliance of the contact directions (Delassus operator)."""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.dof_map import DofMap
from softway.contact.contact_rows import ContactRows
from softway.kernels.linalg.congruence import congruence_of_columns
from softway.kernels.linalg.dense import DenseFactor
from softway.solve.constraints.column_cache import ColumnCache
from softway.solve.constraints.recent_factor import RecentFactor
from softway.solve.constraints.row_basis import CombinedRows, RowCoefficients, UnitRows, joined_entries
from softway.solve.linear.condensed_compliance import condensed_compliance
from softway.solve.linear.interface import Factor, LinearSolver

TOGETHER = 64
"""Number of columns that are solved for together: more are no faster, and take memory."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RowBasis:
    """Contact directions, constant while an operator is kept.

    Parameters
    ----------
    directions
        (f, b): the movable contact rows that never change, then the unknowns that move the nodes of all others.
    component
        (c,) unknown of each of the last directions; None if all rows never change.
    place
        (m,) direction of each row that never changes, -1 for a row that no unknown moves and for the others; None if
        there are none.
    changing
        (k,) numbers of the rows that change.
    transposed
        (b, f) transposed directions.
    direction
        (f,) direction of each unknown that is one, -1 for the others.
    """

    directions: sp.csc_array
    component: IntArray | None
    place: IntArray | None = None
    changing: IntArray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    transposed: sp.csr_array = field(init=False)
    direction: IntArray = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "transposed", sp.csr_array(self.directions.T))
        direction = np.full(self.directions.shape[0], -1)
        if self.component is not None:
            direction[self.component] = self.known + np.arange(len(self.component))
        object.__setattr__(self, "direction", direction)

    @property
    def known(self) -> int:
        """Number of directions that are rows."""
        return self.directions.shape[1] - (0 if self.component is None else len(self.component))

    def restrict(self, y: Array) -> Array:
        """Components (b,) of a field (f,) along the directions."""
        return np.asarray(self.transposed @ y) if self.component is None or self.known else y[self.component]

    def coefficients(self, rows: ContactRows, dofs: DofMap) -> sp.csr_array:
        """Coefficients C (m, b) of the rows, ``G = C directions^T``."""
        own = np.zeros(0, np.int64) if self.place is None else np.flatnonzero(self.place >= 0)
        if self.component is None:
            assert self.place is not None
            units = (np.ones(len(own)), (own, self.place[own]))
            return sp.csr_array(units, shape=(len(rows.node), self.known))
        matrix = rows.matrix(dofs)
        column = self.direction[matrix.indices]
        kept = column >= 0
        if self.place is not None:
            others = np.zeros(len(rows.node), bool)
            others[self.changing] = True
            kept &= np.repeat(others, np.diff(matrix.indptr)) & (matrix.data != 0.0)
        unit = np.zeros(0, np.int64) if self.place is None else self.place[own]
        return joined_entries(matrix, column, kept, (own, unit), self.directions.shape[1])


@dataclass(frozen=True, slots=True, eq=False)
class FrozenOperator:
    """Factored operator A with the nodal rotation R since then, and the compliance ``B^T A^-1 B`` (Delassus operator)
    of the contact directions B.

    The operator of a slab is ``R A R^T``; R is by default the identity.  Contact directions rotate with the nodes: the
    compliance stays the same.

    ``table`` (columns (b,) of ``B^T A^-1 B``), ``solutions`` (columns (f,) of ``A^-1 B`` for few directions that are
    rows) and ``factored_sets`` (factored compliances of active sets) are caches, filled on demand.  Their values depend
    on A and B only, up to rounding also on the batches of columns, which ``table`` keeps.

    Parameters
    ----------
    factor
        A.
    basis
        B.
    turning
        (f, f) block-diagonal R, if all directions are components.
    local
        Approximate inverse that solves for contact forces if ``factor`` is an iteration, whose solutions are not
        reproducible to machine precision.  Every iterate then satisfies the contact conditions exactly, and the forces
        converge with the iterates.
    kind
        Number type of the stored solutions: no more digits than the factor has.
    scale
        Factor of all solutions: the operator is ``R A R^T / scale``.
    recent
        Factored compliance of an earlier iteration of the slab, for rows that hardly change; None to factor it anew.
    """

    factor: Factor
    basis: RowBasis
    turning: sp.csr_array | None = None
    local: Factor | None = None
    kind: type[np.floating[Any]] = np.float64
    scale: float = 1.0
    recent: RecentFactor | None = None
    table: ColumnCache = field(default_factory=ColumnCache)
    solutions: ColumnCache = field(default_factory=ColumnCache)
    factored_sets: dict[bytes, DenseFactor] = field(default_factory=dict)

    def filled(self, batches: tuple[IntArray, ...]) -> "FrozenOperator":
        """Operator with columns computed in these batches."""
        for which in batches:
            self.fill(which)
        return self

    def turned(self, turning: sp.csr_array | None) -> "FrozenOperator":
        """Operator with the same factor, for nodes rotated by R (f, f) since it was made."""
        return replace(self, turning=turning)

    def in_iteration(self) -> "FrozenOperator":
        """Operator for the iterations of one slab, which share factored compliances of rows that hardly change."""
        return replace(self, recent=RecentFactor())

    def scaled(self, scale: float) -> "FrozenOperator":
        """Operator with the same factor, divided by ``scale``."""
        return self if scale == self.scale else replace(self, scale=scale)

    def _times(self, answer: Array) -> Array:
        return answer if self.scale == 1.0 else np.asarray(self.scale * answer)

    def solve(self, b: Array) -> Array:
        """``R A^-1 R^T b`` (f,)."""
        if self.turning is None:
            return self._times(self.factor.solve(b))
        return self._times(np.asarray(self.turning @ self.factor.solve(self.turning.T @ b)))

    def unturned(self, field: Array) -> Array:
        """Field (f,) in the axes in which the operator was made, ``R^T`` times the field."""
        return field if self.turning is None else np.asarray(self.turning.T @ field)

    def turned_back(self, field: Array) -> Array:
        """Field (f,) from the axes in which the operator was made, ``R`` times the field."""
        return field if self.turning is None else np.asarray(self.turning @ field)

    @property
    def exact(self) -> bool:
        """True if contact forces are solved for with the operator itself."""
        return self.local is None

    def restrict(self, y: Array) -> Array:
        """Components (b,) of a field (f,) along the rotated directions."""
        return self.basis.restrict(y if self.turning is None else self.turning.T @ y)

    def prolong(self, amounts: Array) -> Array:
        """Field (f,) of forces (b,) along the rotated directions."""
        out = self._along(amounts)
        return out if self.turning is None else np.asarray(self.turning @ out)

    def coefficients(self, rows: ContactRows, dofs: DofMap) -> RowCoefficients:
        """Coefficients C of the rows along the rotated directions: ``G = C B^T R^T``."""
        own, place = self.basis.component, self.basis.place
        if place is not None and not rows.near[self.basis.changing].any():
            return UnitRows(place, self.basis.known)
        plain = self.basis.coefficients(rows, dofs)
        return CombinedRows(plain if self.turning is None else sp.csr_array(plain @ self.turning[own][:, own]))

    def compliance_times(self, push: Array) -> Array:
        """Product ``B^T A^-1 B push`` (b,) for forces ``push`` (b,) along the directions, or along the first of them.

        New columns are computed in one batch.
        """
        which = np.flatnonzero(push)
        if not len(which):
            return np.zeros(len(push))
        self.fill(which)
        return self._times(self.table.product(which, push[which], len(push)))

    def square(self, which: IntArray) -> Array:
        """Compliance (k, k) of the directions ``which`` (k,)."""
        if not len(which):
            return np.zeros((0, 0))
        self.fill(which)
        return self._times(self.table.square(which))

    def folded(self, rows: sp.csr_array) -> Array:
        """Compliance ``C B^T A^-1 B C^T`` (k, k) of rows C (k, b) along the directions."""
        if not rows.nnz:
            return np.zeros((rows.shape[0], rows.shape[0]))
        self.fill(CombinedRows(rows).used)
        return self._times(congruence_of_columns(rows, self.table.stored, self.table.place, self.table.extent))

    def solve_push(self, push: Array) -> Array:
        """Solution ``R A^-1 B push`` (f,) for forces ``push`` (b,) along the directions."""
        index = np.flatnonzero(push)
        if not len(index):
            return np.zeros(self.basis.directions.shape[0])
        if self.local is not None or index[-1] >= self.basis.known:
            return self._answered(push)
        self.fill(index)
        if len(self.solutions.missing(index)):
            return self._answered(push)
        return self._times(self.solutions.product(index, push[index]))

    def _answered(self, push: Array) -> Array:
        """Solution (f,) for forces (b,) along the directions, without stored columns."""
        found = (self.local or self.factor).solve(self._along(push))
        return self._times(found if self.turning is None else np.asarray(self.turning @ found))

    def _along(self, amounts: Array) -> Array:
        """Field (f,) of amounts along all directions, or along the first of them."""
        missing = self.basis.directions.shape[1] - len(amounts)
        return np.asarray(self.basis.directions @ (np.pad(amounts, (0, missing)) if missing else amounts))

    def fill(self, which: IntArray) -> None:
        """Compute the missing columns of the directions ``which`` (k,), in one batch.

        Many are taken from one Schur complement, with those of all other directions; then no ``solutions`` are stored:
        :meth:`solve_push` solves for the sum, which is cheaper.
        """
        missing, directions = self.table.missing(which), self.basis.directions
        together = None if self.local is not None else condensed_compliance(self.factor, directions, len(missing))
        if together is not None:
            missing = self.table.missing(np.arange(len(together)))
            self.table.add(missing, together[missing])
            return
        known = 0 if self.local is not None else self.basis.known
        self.table.reserve(len(missing))
        if known:
            self.solutions.reserve(int(np.count_nonzero(missing < known)))
        for start in range(0, len(missing), TOGETHER):
            some = missing[start : start + TOGETHER]
            pushes = directions[:, some]
            if self.local is not None:
                self.table.add(some, (directions.T @ self.local.solve(pushes)).toarray().T)
                continue
            new = self.factor.solve(np.ascontiguousarray(pushes.toarray()))
            self.table.add(some, (directions.T @ new).T)
            own = some < known
            if own.any():
                self.solutions.add(some[own], new.T[own].astype(self.kind))


def row_basis(
    rows: ContactRows, dofs: DofMap, fixed: bool, nodes: IntArray, known: BoolArray | None = None
) -> RowBasis:
    """Contact directions: the rows (m,) that the unknowns move if rows are ``fixed``, else the unknowns that move the
    ``nodes`` (k,).

    Where only the rows ``known`` (m,) never change, these are directions, and the ``nodes`` those of the others.
    """
    never = np.ones(len(rows.node), bool) if fixed else known
    if never is None:
        component = dofs.moving(nodes)
        return RowBasis(directions=_components(component, dofs), component=component)
    moved = never & rows.reachable(dofs)
    place = np.where(moved, np.cumsum(moved) - 1, -1)
    directions = sp.csc_array(rows.matrix(dofs)[moved].T)
    if fixed:
        return RowBasis(directions=directions, component=None, place=place)
    component = dofs.moving(nodes)
    both = sp.csc_array(sp.hstack([directions, _components(component, dofs)], format="csc"))
    return RowBasis(directions=both, component=component, place=place, changing=np.flatnonzero(~never))


def _components(component: IntArray, dofs: DofMap) -> sp.csc_array:
    """Unit vectors (f, c) of unknowns (c,)."""
    c = len(component)
    return sp.csc_array((np.ones(c), (component, np.arange(c))), shape=(dofs.size, c))


def frozen_operator(matrix: sp.csc_array, directions: RowBasis, solver: LinearSolver) -> FrozenOperator:
    """Factor a matrix (f, f) as a frozen operator."""
    return FrozenOperator(solver.factor(matrix), directions)
