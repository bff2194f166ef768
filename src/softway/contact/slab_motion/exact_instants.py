"""Exact slab average of massless contact nodes at small strain: the Energy rule with exact instants.

Along the chord of the nodes with inertia, ``u_i(s) = u_i0 + s (u_i1 - u_i0)``, the free equilibrium position of the
massless nodes is affine in s, and so is the free gap ``gamma(s)``.  On an active set A the multipliers are
``lambda_A(s) = -W_AA^-1 gamma_A(s)`` with the compliance ``W = N K_cc^-1 N^T``; the set changes where a multiplier or a
gap vanishes.  Marching over these instants gives the mean multiplier without quadrature error, and the instants of
touch and release (docs/theory/contact/energy.md).
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.contact_rows import ContactRows
from softway.kernels.linalg.active_set import exchanged, most_sweeps
from softway.kernels.linalg.dense import solve_dense

AFTER = 1e-10
"""Fraction of a slab after an instant at which the new active set is determined."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Branch:
    """Change of one row inside the slab: ``instant`` in [0, 1] and ``row``; ``closes`` is True for a touch."""

    instant: float
    row: int
    closes: bool


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ExactInstantMean:
    """Slab averages of a linear solid with massless contact nodes.

    Parameters
    ----------
    rows
        Contact rows.
    still
        (k,) free components (flat) of the massless nodes.
    stiffness
        (k, n d) rows of the stiffness.
    load
        (k,) dead load on these components.
    flexibility
        (k, k) inverse of the stiffness between these components.
    normals
        (m, k) contact rows on these components.
    """

    rows: ContactRows
    still: IntArray
    stiffness: sp.csr_array
    load: Array
    flexibility: Array
    normals: Array

    def mean(self, u0: Array, u1: Array) -> Array:
        """Average displacement (n, d) over the slab for the displacements at its ends."""
        out = 0.5 * (u0 + u1)
        w0, w1 = self._free(u0), self._free(u1)
        force, _ = self._march(w0, w1)
        flat = out.ravel()
        flat[self.still] = 0.5 * (w0 + w1) + self.flexibility @ (self.normals.T @ force)
        return flat.reshape(out.shape)

    def branches(self, u0: Array, u1: Array, closed: BoolArray, after: BoolArray) -> list[Branch]:
        """Touches and releases in order; rows (m,) are ``closed`` at the start and ``after`` at the end."""
        w0, w1 = self._free(u0), self._free(u1)
        first, slope = self.rows.offset + self.normals @ w0, self.normals @ (w1 - w0)
        at_once = lcp(self.compliance, first + AFTER * slope) != closed
        start = [Branch(instant=0.0, row=int(r), closes=not closed[r]) for r in np.flatnonzero(at_once)]
        found = start + self._march(w0, w1)[1]
        current = closed.copy()
        for branch in found:
            current[branch.row] = branch.closes
        return found + [
            Branch(instant=1.0, row=int(r), closes=bool(after[r])) for r in np.flatnonzero(current != after)
        ]

    @property
    def compliance(self) -> Array:
        """Compliance W (m, m) of the contact rows."""
        return self.normals @ self.flexibility @ self.normals.T

    def _free(self, u: Array) -> Array:
        """Equilibrium displacement (k,) of the massless components without contact."""
        flat = u.ravel().copy()
        flat[self.still] = 0.0
        return self.flexibility @ (self.load - self.stiffness @ flat)

    def _march(self, w0: Array, w1: Array) -> tuple[Array, list[Branch]]:
        """Mean multipliers (m,) over s in [0, 1] and the changes of the active set."""
        first = self.rows.offset + self.normals @ w0
        slope = self.normals @ (w1 - w0)
        w = self.compliance
        mean, s, found = np.zeros(len(first)), 0.0, []
        active = lcp(w, first + AFTER * slope)
        while s < 1.0 - AFTER:
            index = np.flatnonzero(active)
            push = np.zeros(len(first)), np.zeros(len(first))
            inner = w[np.ix_(index, index)]
            push[0][index] = solve_dense(inner, -first[index])
            push[1][index] = solve_dense(inner, -slope[index])
            value = np.where(active, push[0], first + w @ push[0])
            rate = np.where(active, push[1], slope + w @ push[1])
            with np.errstate(divide="ignore", invalid="ignore"):
                zero = np.where(rate < 0.0, -value / rate, np.inf)
            zero[zero <= s + AFTER] = np.inf
            row = int(np.argmin(zero)) if len(zero) else 0
            end = min(float(zero[row]), 1.0) if len(zero) else 1.0
            mean += (end - s) * (push[0] + 0.5 * (s + end) * push[1])
            s = end
            if s < 1.0 - AFTER:
                found.append(Branch(instant=s, row=row, closes=not active[row]))
                active = lcp(w, first + (s + AFTER) * slope)
        return mean, found


def lcp(compliance: Array, gap: Array) -> BoolArray:
    """Active rows (m,) of 0 <= P _|_ gap + W P >= 0, W symmetric positive definite (Murty's least index at the end).

    Examples
    --------
    >>> lcp(np.eye(2), np.array([-1.0, 1.0]))
    array([ True, False])
    """
    movable = np.diag(compliance) > 0.0
    floor = 1e-14 * float(np.abs(gap).max(initial=0.0))
    active = (gap < 0.0) & movable
    for sweep in range(most_sweeps(len(gap))):
        index = np.flatnonzero(active)
        force = np.zeros(len(gap))
        force[index] = solve_dense(compliance[np.ix_(index, index)], -gap[index])
        wrong = (active & (force < 0.0)) | (~active & (gap + compliance @ force < -floor) & movable)
        if not wrong.any():
            break
        active = exchanged(active, wrong, sweep)
    return active


def exact_instant_mean(
    rows: ContactRows, free: BoolArray, massive: BoolArray, load: Array, stiffness: sp.csc_array
) -> ExactInstantMean:
    """Slab averages for a stiffness (n d, n d); ``free`` (n, d), ``massive`` (n,), ``load`` (n, d)."""
    still = np.flatnonzero((free & ~massive[:, None]).ravel())
    d = free.shape[1]
    normals = np.zeros((len(rows.node), free.size))
    for k in range(d):
        normals[np.arange(len(rows.node)), rows.node * d + k] = rows.normal[:, k]
    strip = sp.csr_array(stiffness)[still]
    return ExactInstantMean(
        rows=rows,
        still=still,
        stiffness=strip,
        load=load.ravel()[still],
        flexibility=np.linalg.inv(strip[:, still].toarray()) if len(still) else np.zeros((0, 0)),
        normals=normals[:, still],
    )
