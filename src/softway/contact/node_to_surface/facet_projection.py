"""Projection of slave nodes onto the facets of their pairs, at one configuration and at the start of the slab."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.node_to_surface.pairs import NodeFacetPairs
from softway.contact.surfaces.facet_geometry import ClosestPoints
from softway.kernels.geometry.closest_points import dot

EDGE = 1e-6
"""Fraction of the size of a facet by which an inner foot may lie beyond its edge."""
BEHIND = 1e-3
"""Fraction of the size of a facet by which a slave in front of it may be behind it at the start of a slab."""
SMOOTH = 0.5
"""Least cosine of the angle between the normals of two facets that continue each other smoothly."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FacetProjection:
    """Slave nodes relative to the closest points of facets.

    Parameters
    ----------
    pairs
        The pairs.
    x
        (n, d) positions [m].
    size
        (p,) size of the facets [m].
    feet
        Closest points, offsets and normals.
    height, distance
        (p,) of the slave above the tangent plane, and from the facet [m].
    beyond
        (p, d) unit direction in the tangent plane from the closest point to the slave, where the slave is not inner.
    inner
        (p,) True where the foot of the slave lies on the facet.
    """

    pairs: NodeFacetPairs
    x: Array
    size: Array
    feet: ClosestPoints
    height: Array
    distance: Array
    beyond: Array
    inner: BoolArray

    def foot(self, which: IntArray) -> Array:
        """Closest points (k, d) of a subset of the pairs."""
        return self.x[self.pairs.node[which]] - self.feet.offset[which]

    def centre(self, which: IntArray) -> Array:
        """Centres (k, d) of the facets of a subset of the pairs."""
        return np.asarray(self.x[self.pairs.masters[which]].mean(axis=1))

    def mutually_facing(self, one: IntArray, two: IntArray) -> BoolArray:
        """True where the facets of pairs ``one`` and ``two`` face the centres of each other."""
        forth = dot(self.feet.normal[one], self.centre(two) - self.foot(one)) > 0.0
        back = dot(self.feet.normal[two], self.centre(one) - self.foot(two)) > 0.0
        return np.asarray(forth & back)

    def hinged(self, one: IntArray, two: IntArray) -> BoolArray:
        """True where the closest point of a facet ``one`` lies on its common edge with a facet ``two``."""
        used = np.abs(self.feet.shapes[one]) > EDGE
        common = (self.pairs.masters[one][:, :, None] == self.pairs.masters[two][:, None, :]).any(axis=2)
        enough = np.count_nonzero(used, axis=1) >= self.x.shape[1] - 1
        return np.asarray(enough & (common | ~used).all(axis=1))

    def came_over(self, edge: IntArray, start: Array) -> BoolArray:
        """True where slaves beyond an edge of their facet were on its near side at the positions ``start`` (n, d)."""
        nodes = start[self.pairs.masters[edge]]
        began = start[self.pairs.node[edge]] - np.einsum("pb,pbd->pd", self.feet.shapes[edge], nodes)
        return np.asarray(dot(began, self.beyond[edge]) < 0.0)

    def within(self, edge: IntArray) -> BoolArray:
        """True where a slave is inside a body at a concave edge: behind a facet whose neighbours rise in front of it.

        ``edge`` are all pairs whose facet is nearest to the slave at an edge.
        """
        slave = self.pairs.slave[edge]
        total = np.zeros((slave.max(initial=0) + 1, self.x.shape[1]))
        np.add.at(total, slave, self.centre(edge))
        around = total[slave] / np.bincount(slave)[slave, None]
        rise = dot(self.feet.normal[edge], around - self.foot(edge))
        return np.asarray((self.height[edge] < 0.0) & (rise > EDGE * self.size[edge]))


def project(pairs: NodeFacetPairs, x: Array, size: Array) -> FacetProjection:
    """Project the slaves of pairs at positions x (n, d) onto their facets of a size (p,) [m]."""
    feet = pairs.feet(x)
    height = dot(feet.normal, feet.offset)
    beyond = feet.offset - height[:, None] * feet.normal
    sideways = np.sqrt(dot(beyond, beyond))
    inner = sideways <= EDGE * size
    beyond /= np.where(inner, 1.0, sideways)[:, None]
    distance = np.hypot(height, sideways)
    return FacetProjection(
        pairs=pairs, x=x, size=size, feet=feet, height=height, distance=distance, beyond=beyond, inner=inner
    )


def convex_drop(cosine: Array) -> Array:
    """Greatest slope (p,) of the chord between points of two facets of a smooth convex surface below the tangent plane,
    from the cosine of the angle between their normals.

    It is bounded by the sine of this angle.  Zero for facets that meet at a sharp edge.

    Examples
    --------
    >>> convex_drop(np.array([1.0, 0.8, 0.0])).round(12).tolist()
    [0.0, 0.6, 0.0]
    """
    return np.where(cosine >= SMOOTH, np.sqrt(np.maximum(1.0 - cosine**2, 0.0)), 0.0)
