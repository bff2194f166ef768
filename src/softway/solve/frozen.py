"""The frozen operator of a slab with the compliance of the contact, and the carry that keeps it."""

from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp

from softway.contact.candidates import Candidates
from softway.kernels.dense import Shared
from softway.solve.linear import Factor, LinearSolver
from softway.typing import Array, BoolArray, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Basis:
    """The directions in which contact pushes, the same for as long as an operator is kept.

    Parameters
    ----------
    directions
        (f, b): the contact rows themselves where they never change, else the components of the contact nodes.
    component
        (b,) free component of each direction; None where the directions are the rows.
    """

    directions: sp.csc_array
    component: IntArray | None

    def coefficients(self, rows: Candidates, free: BoolArray) -> sp.csr_array:
        """Rows C (m, b) with ``G = C directions^T``."""
        if self.component is None:
            return sp.csr_array(sp.eye_array(len(rows.node), format="csr"))
        return sp.csr_array(rows.matrix(free)[:, self.component])


@dataclass(frozen=True, slots=True, eq=False)
class Frozen:
    """A factored operator A and the compliance ``B^T A^-1 B`` of the contact directions B, computed when first asked
    for.

    ``columns`` (``B^T A^-1 B`` (b,) of each direction), ``answers`` (``A^-1 B`` (k, f) of batches of them, kept where
    directions are rows), ``latest`` and ``held`` are caches of values that depend on A and B only, so the answer does
    not depend on when they were made.
    """

    factor: Factor
    basis: Basis
    columns: dict[int, Array] = field(default_factory=dict)
    answers: list[tuple[IntArray, Array]] = field(default_factory=list)
    latest: dict[bytes, Array] = field(default_factory=dict)
    held: dict[bytes, Shared] = field(default_factory=dict)

    def solve(self, b: Array) -> Array:
        """A^-1 b."""
        return self.factor.solve(b)

    def sense(self, y: Array) -> Array:
        """Components (b,) of a field (f,) along the directions."""
        return np.asarray(self.basis.directions.T @ y)

    def compliance(self, which: IntArray) -> Array:
        """``B^T A^-1 B`` (b, k) of some directions; new columns are solved for in one batch."""
        key = which.tobytes()
        if key not in self.latest:
            self._fill(which)
            out = np.empty((len(which), self.basis.directions.shape[1]))
            for k, i in enumerate(which.tolist()):
                out[k] = self.columns[i]
            self.latest.clear()
            self.latest[key] = out.T
        return self.latest[key]

    def answer(self, push: Array) -> Array:
        """A^-1 B push (f,) of pushes (b,) along the directions."""
        index = np.flatnonzero(push)
        if self.basis.component is not None:
            return self.solve(self.basis.directions @ push) if len(index) else np.zeros(self.basis.directions.shape[0])
        self._fill(index)
        out = np.zeros(self.basis.directions.shape[0])
        for batch, block in self.answers:
            part = push[batch]
            few = np.flatnonzero(part)
            if 2 * len(few) > len(part):
                out += part @ block
            else:
                for k in few.tolist():
                    out += part[k] * block[k]
        return out

    def _fill(self, which: IntArray) -> None:
        missing = [i for i in which.tolist() if i not in self.columns]
        if not missing:
            return
        new = self.factor.solve(np.ascontiguousarray(self.basis.directions[:, missing].toarray()))
        sensed = np.ascontiguousarray((self.basis.directions.T @ new).T)
        self.columns.update(zip(missing, sensed, strict=True))
        if self.basis.component is None:
            self.answers.append((np.array(missing), np.ascontiguousarray(new.T)))


def basis(rows: Candidates, free: BoolArray, fixed: bool, nodes: IntArray) -> Basis:
    """The contact directions: the rows (m,) if they are ``fixed``, else the free components of ``nodes`` (k,)."""
    if fixed:
        return Basis(directions=sp.csc_array(rows.matrix(free).T), component=None)
    flat = np.zeros(free.shape, bool)
    flat[nodes] = True
    component = np.flatnonzero(flat[free])
    b = len(component)
    directions = sp.csc_array((np.ones(b), (component, np.arange(b))), shape=(int(free.sum()), b))
    return Basis(directions=directions, component=component)


def freeze(matrix: sp.csc_array, directions: Basis, solver: LinearSolver) -> Frozen:
    """Factor an operator for slabs of one length."""
    return Frozen(solver.factor(matrix), directions)


@dataclass(frozen=True, slots=True, eq=False)
class Carry:
    """What is kept between slabs besides the state, all of it disposable: one frozen operator for a slab length.

    ``span`` is the length that ``frozen`` belongs to; ``stale`` asks for a new factor at the next slab.
    """

    frozen: Frozen | None = None
    span: float = 0.0
    stale: bool = False
    factorisations: int = 0
