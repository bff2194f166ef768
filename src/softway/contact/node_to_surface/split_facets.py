"""Quadrilaterals as four triangles around their centres: surfaces of flat facets that meet at straight edges.

A bilinear facet is warped: two of them may cross each other between nodes and edges.  Flat facets cannot, as long as no
node is behind a facet and no edge behind another one.  The centre of a quadrilateral is the mean of its corners, a
point of the bilinear facet; rows on a centre act on the four corners.
"""

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.stencils import Stencils
from softway.contact.surfaces.boundary import ContactSurface


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SplitSurface:
    """Surface of triangles on the ``count`` nodes of a model and the centres of its quadrilaterals.

    Parameters
    ----------
    given
        The surface, of triangles ``tri3`` and quadrilaterals ``quad4``.
    count
        Number n of the nodes of the model; centre k has the number n + k.
    side
        The triangles; the first ones are those given, then four for each quadrilateral.

    Examples
    --------
    >>> x = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]])
    >>> split = SplitSurface(given=ContactSurface(facets={"quad4": np.array([[0, 1, 2, 3]])}), count=4)
    >>> split.positions(x)[4:].tolist(), split.side.facets["tri3"].tolist()
    ([[1.0, 1.0, 0.0]], [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    """

    given: ContactSurface
    count: int
    side: ContactSurface = field(init=False)
    means: sp.csr_array = field(init=False)

    def __post_init__(self) -> None:
        none = np.zeros((0, 3), np.int64)
        quads = self.quads
        centre = self.count + np.arange(len(quads))
        turned = [np.stack([quads[:, k], quads[:, (k + 1) % 4], centre], axis=1) for k in range(4)]
        fans = np.stack(turned, axis=1).reshape(-1, 3) if len(quads) else none
        ones, mean = np.ones(self.count), np.full(4 * len(quads), 0.25)
        rows = np.concatenate([np.arange(self.count), np.repeat(centre, 4)])
        columns = np.concatenate([np.arange(self.count), quads.ravel()])
        shape = (self.count + len(quads), self.count)
        side = ContactSurface(facets={"tri3": np.concatenate([self.given.facets.get("tri3", none), fans])})
        object.__setattr__(self, "side", side)
        object.__setattr__(self, "means", sp.csr_array((np.concatenate([ones, mean]), (rows, columns)), shape=shape))

    @property
    def quads(self) -> IntArray:
        """Corners (q, 4) of the quadrilaterals."""
        return self.given.facets.get("quad4", np.zeros((0, 4), np.int64))

    def positions(self, x: Array) -> Array:
        """Positions (n + q, 3) of the nodes, at x (n, 3), and of the centres."""
        return np.concatenate([x, x[self.quads].mean(axis=1)])

    def of_facets(self, values: BoolArray) -> BoolArray:
        """Values (t, k) of the triangles from those of the given facets (f, k)."""
        plain = len(self.given.facets.get("tri3", ()))
        kinds = {kind: values[first : first + len(f)] for kind, first, f in self.given.numbers}
        fans = kinds.get("quad4", values[:0])
        return np.concatenate([kinds.get("tri3", values[:0])[:plain], np.repeat(fans, 4, axis=0)])

    def joined(self, stencils: Stencils) -> Stencils:
        """Stencils on the nodes (n,) from those on nodes and centres (n + q,)."""
        weights = sp.csr_array(stencils.weights @ self.means)
        return Stencils(gap=stencils.gap, normal=stencils.normal, weights=weights)


class Rows(Protocol):
    """Rows on nodes and centres in a slab."""

    @property
    def found(self) -> int:
        """Number of pairs found by the search."""
        ...

    def at(self, x: Array) -> Stencils:
        """Gaps and their derivatives at positions of nodes and centres."""
        ...


class Method(Protocol):
    """Contact method on nodes and centres."""

    @property
    def node(self) -> IntArray:
        """Node (m,) of each row."""
        ...

    def meet(self, x0: Array, x1: Array, reach: float, margin: float | None = None) -> Rows:
        """Pairs that may touch in a slab."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OnSplitSurface:
    """A contact ``method`` on the triangles of a surface."""

    method: Method
    surface: SplitSurface

    @property
    def node(self) -> IntArray:
        """Node (m,) of each row; the first corner for a centre."""
        node, surface = self.method.node, self.surface
        corner = np.concatenate([np.arange(surface.count), surface.quads[:, 0]])
        return np.asarray(corner[node])

    def meet(self, x0: Array, x1: Array, reach: float, margin: float | None = None) -> "SplitContact":
        """Pairs that may touch in a slab from positions x0 to about x1 (n, 3), within ``reach`` [m].

        With a ``margin`` [m], only rows with an opponent within the margin have pairs.
        """
        surface = self.surface
        found = self.method.meet(surface.positions(x0), surface.positions(x1), reach, margin)
        return SplitContact(contact=found, surface=surface)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SplitContact:
    """``contact`` on the triangles of a surface in a slab."""

    contact: Rows
    surface: SplitSurface

    @property
    def found(self) -> int:
        """Number of pairs found by the search."""
        return self.contact.found

    def at(self, x: Array) -> Stencils:
        """Gaps and their derivatives at positions x (n, 3)."""
        return self.surface.joined(self.contact.at(self.surface.positions(x)))
