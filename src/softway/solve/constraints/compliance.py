"""Frozen operator of a slab, with the compliance of the contact directions (Delassus operator)."""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.bodies.dof_map import DofMap
from softway.contact.contact_rows import ContactRows
from softway.kernels.linalg.dense import DenseFactor
from softway.solve.constraints.column_cache import ColumnCache
from softway.solve.constraints.row_basis import CombinedRows, RowCoefficients, UnitRows
from softway.solve.linear.interface import Factor, LinearSolver

TOGETHER = 64
"""Number of columns that are solved for together: more are no faster, and take memory."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RowBasis:
    """Contact directions, constant while an operator is kept.

    Parameters
    ----------
    directions
        (f, b): the movable contact rows if they never change, else the unknowns that move the contact nodes.
    component
        (b,) unknown of each direction; None if the directions are the rows.
    place
        (m,) direction of each row if directions are rows, -1 for a row that no unknown moves.
    transposed
        (b, f) transposed directions.
    """

    directions: sp.csc_array
    component: IntArray | None
    place: IntArray | None = None
    transposed: sp.csr_array = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "transposed", sp.csr_array(self.directions.T))

    def restrict(self, y: Array) -> Array:
        """Components (b,) of a field (f,) along the directions."""
        return np.asarray(self.transposed @ y) if self.component is None else y[self.component]

    def coefficients(self, rows: ContactRows, dofs: DofMap) -> sp.csr_array:
        """Coefficients C (m, b) of the rows, ``G = C directions^T``."""
        if self.component is not None:
            return sp.csr_array(rows.matrix(dofs)[:, self.component])
        assert self.place is not None
        own = np.flatnonzero(self.place >= 0)
        shape = (len(rows.node), self.directions.shape[1])
        return sp.csr_array((np.ones(len(own)), (own, self.place[own])), shape=shape)


@dataclass(frozen=True, slots=True, eq=False)
class FrozenOperator:
    """Factored operator A with the nodal rotation R since then, and the compliance ``B^T A^-1 B`` (Delassus operator)
    of the contact directions B.

    The operator of a slab is ``R A R^T``; R is by default the identity.  Contact directions rotate with the nodes: the
    compliance stays the same.

    ``table`` (columns (b,) of ``B^T A^-1 B``), ``solutions`` (columns (f,) of ``A^-1 B``, kept if directions are rows)
    and ``factored_sets`` (factored compliances of active sets) are caches, filled on demand.  Their values depend on A
    and B only, up to rounding also on the batches of columns, which ``table`` keeps.

    Parameters
    ----------
    factor
        A.
    basis
        B.
    turning
        (f, f) block-diagonal R, for directions that are components.
    local
        Approximate inverse that solves for contact forces if ``factor`` is an iteration, whose solutions are not
        reproducible to machine precision.  Every iterate then satisfies the contact conditions exactly, and the forces
        converge with the iterates.
    kind
        Number type of the stored solutions: no more digits than the factor has.
    scale
        Factor of all solutions: the operator is ``R A R^T / scale``.
    """

    factor: Factor
    basis: RowBasis
    turning: sp.csr_array | None = None
    local: Factor | None = None
    kind: type[np.floating[Any]] = np.float64
    scale: float = 1.0
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

    @property
    def exact(self) -> bool:
        """True if contact forces are solved for with the operator itself."""
        return self.local is None

    def restrict(self, y: Array) -> Array:
        """Components (b,) of a field (f,) along the rotated directions."""
        return self.basis.restrict(y if self.turning is None else self.turning.T @ y)

    def prolong(self, amounts: Array) -> Array:
        """Field (f,) of forces (b,) along the rotated directions."""
        out = np.asarray(self.basis.directions @ amounts)
        return out if self.turning is None else np.asarray(self.turning @ out)

    def coefficients(self, rows: ContactRows, dofs: DofMap) -> RowCoefficients:
        """Coefficients C of the rows along the rotated directions: ``G = C B^T R^T``."""
        own = self.basis.component
        if own is None:
            assert self.basis.place is not None
            return UnitRows(self.basis.place, self.basis.directions.shape[1])
        plain = self.basis.coefficients(rows, dofs)
        return CombinedRows(plain if self.turning is None else sp.csr_array(plain @ self.turning[own][:, own]))

    def compliance(self, which: IntArray) -> Array:
        """Columns (b, k) of ``B^T A^-1 B`` for the directions ``which`` (k,); new ones are computed in one batch."""
        if not len(which):
            return np.zeros((self.basis.directions.shape[1], 0))
        self.fill(which)
        return self._times(self.table.columns(which))

    def compliance_times(self, push: Array) -> Array:
        """Product ``B^T A^-1 B push`` (b,) for forces ``push`` (b,) along the directions."""
        which = np.flatnonzero(push)
        if not len(which):
            return np.zeros(self.basis.directions.shape[1])
        self.fill(which)
        return self._times(self.table.product(which, push[which]))

    def solve_push(self, push: Array) -> Array:
        """Solution ``R A^-1 B push`` (f,) for forces ``push`` (b,) along the directions."""
        index = np.flatnonzero(push)
        if not len(index):
            return np.zeros(self.basis.directions.shape[0])
        if self.basis.component is not None or self.local is not None:
            return self._answered(push)
        self.fill(index)
        return self._times(self.solutions.product(index, push[index]))

    def _answered(self, push: Array) -> Array:
        """Solution (f,) for forces (b,) along the directions, without stored columns."""
        found = (self.local or self.factor).solve(np.asarray(self.basis.directions @ push))
        return self._times(found if self.turning is None else np.asarray(self.turning @ found))

    def fill(self, which: IntArray) -> None:
        """Compute the missing columns of the directions ``which`` (k,), in one batch."""
        missing, directions = self.table.missing(which), self.basis.directions
        kept = self.basis.component is None and self.local is None
        self.table.reserve(len(missing))
        if kept:
            self.solutions.reserve(len(missing))
        for start in range(0, len(missing), TOGETHER):
            some = missing[start : start + TOGETHER]
            pushes = directions[:, some]
            if self.local is not None:
                self.table.add(some, (directions.T @ self.local.solve(pushes)).toarray().T)
                continue
            new = self.factor.solve(np.ascontiguousarray(pushes.toarray()))
            self.table.add(some, (directions.T @ new).T)
            if kept:
                self.solutions.add(some, new.T.astype(self.kind))


def row_basis(rows: ContactRows, dofs: DofMap, fixed: bool, nodes: IntArray) -> RowBasis:
    """Contact directions: the rows (m,) that the unknowns move if rows are ``fixed``, else the unknowns that move the
    ``nodes`` (k,).
    """
    if fixed:
        moved = rows.reachable(dofs)
        place = np.where(moved, np.cumsum(moved) - 1, -1)
        return RowBasis(directions=sp.csc_array(rows.matrix(dofs)[moved].T), component=None, place=place)
    component = dofs.moving(nodes)
    b = len(component)
    directions = sp.csc_array((np.ones(b), (component, np.arange(b))), shape=(dofs.size, b))
    return RowBasis(directions=directions, component=component)


def frozen_operator(matrix: sp.csc_array, directions: RowBasis, solver: LinearSolver) -> FrozenOperator:
    """Factor a matrix (f, f) as a frozen operator."""
    return FrozenOperator(solver.factor(matrix), directions)
