"""The frozen operator of a slab with the compliance of the contact."""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from softway.contact.candidates import Candidates
from softway.kernels.dense import Shared
from softway.solve.along import Along, Mixed, Own
from softway.solve.columns import Columns
from softway.solve.linear import Factor, LinearSolver
from softway.typing import Array, BoolArray, IntArray

TOGETHER = 64
"""Columns that are solved for at once: more are no faster, and take memory."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Basis:
    """The directions in which contact pushes, the same for as long as an operator is kept.

    Parameters
    ----------
    directions
        (f, b): the contact rows that can be moved where they never change, else the components of the contact nodes.
    component
        (b,) free component of each direction; None where the directions are the rows.
    place
        (m,) the direction of each row where directions are rows, -1 for a row that no free component moves.
    transposed
        (b, f) the directions as rows.
    """

    directions: sp.csc_array
    component: IntArray | None
    place: IntArray | None = None
    transposed: sp.csr_array = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "transposed", sp.csr_array(self.directions.T))

    def sense(self, y: Array) -> Array:
        """Components (b,) of a field (f,) along the directions."""
        return np.asarray(self.transposed @ y) if self.component is None else y[self.component]

    def coefficients(self, rows: Candidates, free: BoolArray) -> sp.csr_array:
        """Rows C (m, b) with ``G = C directions^T``."""
        if self.component is not None:
            return sp.csr_array(rows.matrix(free)[:, self.component])
        assert self.place is not None
        own = np.flatnonzero(self.place >= 0)
        shape = (len(rows.node), self.directions.shape[1])
        return sp.csr_array((np.ones(len(own)), (own, self.place[own])), shape=shape)


@dataclass(frozen=True, slots=True, eq=False)
class Frozen:
    """A factored operator A, the turning R of the nodes since, and the compliance ``B^T A^-1 B`` of the contact
    directions B, computed when first asked for.

    The operator of a slab is ``R A R^T``; R is the identity where it is not given.  Contact directions turn with the
    nodes, so that the compliance stays.

    ``table`` (columns (b,) of ``B^T A^-1 B``), ``answers`` (columns (f,) of ``A^-1 B``, kept where directions are rows)
    and ``held`` are caches of values that depend on A and B only; in the last digits also on which columns were made
    together, which ``table`` keeps.

    Parameters
    ----------
    factor
        A.
    basis
        B.
    turning
        (f, f) block-diagonal R, between directions that are components.
    local
        What answers the pushes of the contact, where ``factor`` is an iteration whose answers are not alike to the last
        digit: a crude inverse that is.  The contact conditions are then met exactly at every iterate, and the forces
        settle with the iterates.
    kind
        Type of the kept answers: no more digits than the factor has.
    scale
        What the answers are multiplied by: the operator is ``R A R^T / scale``.
    """

    factor: Factor
    basis: Basis
    turning: sp.csr_array | None = None
    local: Factor | None = None
    kind: type[np.floating[Any]] = np.float64
    scale: float = 1.0
    table: Columns = field(default_factory=Columns)
    answers: Columns = field(default_factory=Columns)
    held: dict[bytes, Shared] = field(default_factory=dict)

    def filled(self, batches: tuple[IntArray, ...]) -> "Frozen":
        """The same, with columns made in these batches."""
        for which in batches:
            self.fill(which)
        return self

    def turned(self, turning: sp.csr_array | None) -> "Frozen":
        """The same factor for nodes turned by R (f, f) since it was made."""
        return replace(self, turning=turning)

    def scaled(self, scale: float) -> "Frozen":
        """The same factor for an operator that is ``1 / scale`` of it."""
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
        """Whether the answers to pushes are those of the operator."""
        return self.local is None

    def sense(self, y: Array) -> Array:
        """Components (b,) of a field (f,) along the turned directions."""
        return self.basis.sense(y if self.turning is None else self.turning.T @ y)

    def push(self, amounts: Array) -> Array:
        """Field (f,) of pushes (b,) along the turned directions."""
        out = np.asarray(self.basis.directions @ amounts)
        return out if self.turning is None else np.asarray(self.turning @ out)

    def coefficients(self, rows: Candidates, free: BoolArray) -> Along:
        """The rows along the turned directions: ``G = C B^T R^T``."""
        own = self.basis.component
        if own is None:
            assert self.basis.place is not None
            return Own(self.basis.place, self.basis.directions.shape[1])
        plain = self.basis.coefficients(rows, free)
        return Mixed(plain if self.turning is None else sp.csr_array(plain @ self.turning[own][:, own]))

    def compliance(self, which: IntArray) -> Array:
        """``B^T A^-1 B`` (b, k) of some directions; new columns are solved for in one batch."""
        if not len(which):
            return np.zeros((self.basis.directions.shape[1], 0))
        self.fill(which)
        return self._times(self.table.columns(which))

    def give(self, push: Array) -> Array:
        """``B^T A^-1 B push`` (b,) of pushes (b,) along the directions."""
        which = np.flatnonzero(push)
        if not len(which):
            return np.zeros(self.basis.directions.shape[1])
        self.fill(which)
        return self._times(self.table.product(which, push[which]))

    def answer(self, push: Array) -> Array:
        """``R A^-1 B push`` (f,) of pushes (b,) along the directions."""
        index = np.flatnonzero(push)
        if not len(index):
            return np.zeros(self.basis.directions.shape[0])
        if self.basis.component is not None or self.local is not None:
            return self._answered(push)
        self.fill(index)
        return self._times(self.answers.product(index, push[index]))

    def _answered(self, push: Array) -> Array:
        """Answer (f,) to pushes (b,) by a solution."""
        found = (self.local or self.factor).solve(np.asarray(self.basis.directions @ push))
        return self._times(found if self.turning is None else np.asarray(self.turning @ found))

    def fill(self, which: IntArray) -> None:
        """Make the columns of some directions that are not there yet, in one batch."""
        missing, directions = self.table.missing(which), self.basis.directions
        kept = self.basis.component is None and self.local is None
        self.table.reserve(len(missing))
        if kept:
            self.answers.reserve(len(missing))
        for start in range(0, len(missing), TOGETHER):
            some = missing[start : start + TOGETHER]
            pushes = directions[:, some]
            if self.local is not None:
                self.table.add(some, (directions.T @ self.local.solve(pushes)).toarray().T)
                continue
            new = self.factor.solve(np.ascontiguousarray(pushes.toarray()))
            self.table.add(some, (directions.T @ new).T)
            if kept:
                self.answers.add(some, new.T.astype(self.kind))


def basis(rows: Candidates, free: BoolArray, fixed: bool, nodes: IntArray) -> Basis:
    """The contact directions: the rows (m,) that free components move if they are ``fixed``, else the free components
    of ``nodes`` (k,).
    """
    if fixed:
        moved = rows.reachable(free)
        place = np.where(moved, np.cumsum(moved) - 1, -1)
        return Basis(directions=sp.csc_array(rows.matrix(free)[moved].T), component=None, place=place)
    flat = np.zeros(free.shape, bool)
    flat[nodes] = True
    component = np.flatnonzero(flat[free])
    b = len(component)
    directions = sp.csc_array((np.ones(b), (component, np.arange(b))), shape=(int(free.sum()), b))
    return Basis(directions=directions, component=component)


def freeze(matrix: sp.csc_array, directions: Basis, solver: LinearSolver) -> Frozen:
    """Factor an operator."""
    return Frozen(solver.factor(matrix), directions)
