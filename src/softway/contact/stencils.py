"""Stencils of contact rows: gap, normal, and weights of the nodes."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Stencils:
    """Gaps at one configuration with their derivatives ``d gap_r = normal_r . sum_j weights[r, j] dx_j``.

    If a row depends on its nodes in different directions, ``slopes`` contains the derivatives; normal and weights are
    means.

    Parameters
    ----------
    gap
        (m,) [m], negative inside the opponent; infinite where no opponent is in reach.
    normal
        (m, d) unit normals, out of the opponent into free space.
    weights
        (m, n) one on the slave node, minus the weights of the nodes of a deformable opponent.
    slopes
        (m, n d) derivatives with respect to the components ``j d + i`` of the positions; None: from normal and weights.
    """

    gap: Array
    normal: Array
    weights: sp.csr_array
    slopes: sp.csr_array | None = None

    def gradient(self) -> sp.csr_array:
        """Derivatives (m, n d) of the gaps with respect to the components ``j d + i`` of the positions."""
        return normal_component(self.weights, self.normal) if self.slopes is None else self.slopes


class PairedSurfaces(Protocol):
    """Surfaces that may come into contact in one slab."""

    @property
    def found(self) -> int:
        """Number of pairs found by the search."""
        ...

    def at(self, x: Array) -> Stencils:
        """Gaps and their derivatives at positions ``x`` (n, d)."""
        ...


class SurfacePair(Protocol):
    """Contact method between deformable surfaces; its rows stay the same throughout a march."""

    @property
    def node(self) -> IntArray:
        """Slave node (m,) of each row."""
        ...

    def meet(self, x0: Array, x1: Array, reach: float, margin: float | None = None) -> PairedSurfaces:
        """Pairs that may touch in a slab from positions ``x0`` to about ``x1`` (n, d), within ``reach`` [m].

        With a ``margin`` [m], only rows with an opponent within the margin have pairs.
        """
        ...


def open_rows(rows: int, nodes: int, dim: int) -> Stencils:
    """Stencils of rows without an opponent: infinite gaps, and no normals and weights.

    Examples
    --------
    >>> found = open_rows(2, 3, 2)
    >>> found.gap.tolist(), found.gradient().nnz, found.normal.shape
    ([inf, inf], 0, (2, 2))
    """
    return Stencils(gap=np.full(rows, np.inf), normal=np.zeros((rows, dim)), weights=sp.csr_array((rows, nodes)))


@dataclass(frozen=True, slots=True, kw_only=True)
class NoPairs:
    """Surfaces that are out of reach in a slab, with a number of ``rows``."""

    rows: int
    found: int = 0

    def at(self, x: Array) -> Stencils:
        """Open rows at any positions ``x`` (n, d)."""
        return open_rows(self.rows, *x.shape)


def normal_component(weights: sp.csr_array, normal: Array) -> sp.csr_array:
    """Rows (m, n d): weights (m, n) times the normals (m, d).

    Examples
    --------
    >>> normal_component(sp.csr_array(np.array([[1.0, -1.0]])), np.array([[0.0, 2.0]])).toarray().tolist()
    [[0.0, 2.0, 0.0, -2.0]]
    """
    m, n = weights.shape
    d = normal.shape[1]
    row = np.repeat(np.arange(m), np.diff(weights.indptr))
    data = (weights.data[:, None] * normal[row]).ravel()
    column = (weights.indices[:, None].astype(np.int64) * d + np.arange(d)).ravel()
    return sp.csr_array((data, column, weights.indptr * d), shape=(m, n * d))
