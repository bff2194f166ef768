"""How slaves stand to the facets of their pairs at one configuration, and how they stood when the slab began."""

from dataclasses import dataclass

import numpy as np

from softway.contact.facets import Feet
from softway.contact.slave_pairs import Pairs
from softway.kernels.closest import dot
from softway.typing import Array, BoolArray, IntArray

EDGE = 1e-6
"""Share of the size of a facet by which a foot may lie beyond its edge and still counts as inner."""
BEHIND = 1e-3
"""Share of the size of a facet by which a slave may begin a slab behind it and still counts as in front of it."""
SMOOTH = 0.5
"""Cosine of the angle between the normals of two facets up to which one may continue the other smoothly."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Sight:
    """Slaves seen from the closest points of facets.

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
        (p,) above the tangent plane, and of the slave from the facet [m].
    beyond
        (p, d) unit direction in the tangent plane from the closest point to the slave, where it is not inner.
    inner
        (p,) whether the foot of the slave lies on the facet.
    """

    pairs: Pairs
    x: Array
    size: Array
    feet: Feet
    height: Array
    distance: Array
    beyond: Array
    inner: BoolArray

    def foot(self, which: IntArray) -> Array:
        """Closest points (k, d) of some pairs."""
        return self.x[self.pairs.node[which]] - self.feet.offset[which]

    def centre(self, which: IntArray) -> Array:
        """Centres (k, d) of the facets of some pairs."""
        return np.asarray(self.x[self.pairs.masters[which]].mean(axis=1))

    def faces(self, one: IntArray, two: IntArray) -> BoolArray:
        """Whether the facets of pairs look towards the centres of the facets of others, and these back."""
        forth = dot(self.feet.normal[one], self.centre(two) - self.foot(one)) > 0.0
        back = dot(self.feet.normal[two], self.centre(one) - self.foot(two)) > 0.0
        return np.asarray(forth & back)

    def hinged(self, one: IntArray, two: IntArray) -> BoolArray:
        """Whether the closest points of the facets of pairs lie on their common edges with the facets of others."""
        used = np.abs(self.feet.shapes[one]) > EDGE
        common = (self.pairs.masters[one][:, :, None] == self.pairs.masters[two][:, None, :]).any(axis=2)
        enough = np.count_nonzero(used, axis=1) >= self.x.shape[1] - 1
        return np.asarray(enough & (common | ~used).all(axis=1))

    def came_over(self, edge: IntArray, start: Array) -> BoolArray:
        """Whether slaves beyond an edge of a facet stood on the near side of that edge at positions start (n, d)."""
        nodes = start[self.pairs.masters[edge]]
        began = start[self.pairs.node[edge]] - np.einsum("pb,pbd->pd", self.feet.shapes[edge], nodes)
        return np.asarray(dot(began, self.beyond[edge]) < 0.0)

    def within(self, edge: IntArray) -> BoolArray:
        """Whether slaves are inside a body at a concave edge: behind a facet before which its neighbours rise.

        ``edge`` are all pairs whose facets are nearest to their slave, at an edge.
        """
        slave = self.pairs.slave[edge]
        total = np.zeros((slave.max(initial=0) + 1, self.x.shape[1]))
        np.add.at(total, slave, self.centre(edge))
        around = total[slave] / np.bincount(slave)[slave, None]
        rise = dot(self.feet.normal[edge], around - self.foot(edge))
        return np.asarray((self.height[edge] < 0.0) & (rise > EDGE * self.size[edge]))


def sight(pairs: Pairs, x: Array, size: Array) -> Sight:
    """The pairs at positions x (n, d), with facets of some size (p,) [m]."""
    feet = pairs.feet(x)
    height = dot(feet.normal, feet.offset)
    beyond = feet.offset - height[:, None] * feet.normal
    sideways = np.sqrt(dot(beyond, beyond))
    inner = sideways <= EDGE * size
    beyond /= np.where(inner, 1.0, sideways)[:, None]
    distance = np.hypot(height, sideways)
    return Sight(pairs=pairs, x=x, size=size, feet=feet, height=height, distance=distance, beyond=beyond, inner=inner)


def dip(cosine: Array) -> Array:
    """Slope (p,) by which a smooth surface falls off between two facets, from the cosine of the angle of their normals.

    Seen from a point on a convex surface, another one lies below the tangent plane by no more than the angle between
    the two normals.  Zero for facets that meet sharply.

    Examples
    --------
    >>> dip(np.array([1.0, 0.8, 0.0])).round(12).tolist()
    [0.0, 0.6, 0.0]
    """
    return np.where(cosine >= SMOOTH, np.sqrt(np.maximum(1.0 - cosine**2, 0.0)), 0.0)
