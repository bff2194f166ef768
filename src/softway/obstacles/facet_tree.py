"""Tree over the facets of a surface, for the search of the facets nearest to many points."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray
from softway.obstacles.half_space import unit_vectors


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FacetTree:
    """Binary tree of facets; groups are split along the longest side of the bounding box of their centres.

    Parameters
    ----------
    leaves
        (2^l,) numbers of the facets in the order of the leaves; one facet is repeated to fill the last leaves.
    bounds
        One table (2^k, 3 d + 2) of groups for every level, from all facets down to single facets; the halves of group g
        are the groups 2 g and 2 g + 1 of the next level. A flat cylinder across its mean normal encloses each group.
        The columns are the centre of the cylinder, its axis (a unit vector), the centre of one of the facets, half the
        height of the cylinder and its radius [m].
    """

    leaves: IntArray
    bounds: tuple[Array, ...]

    def near(self, x: Array, rounding: float, most: float = np.inf) -> tuple[IntArray, IntArray] | None:
        """Pairs of a point and a facet: the nearest facet of each point, and others at nearly the same distance.

        Groups further away than the centre of some facet are discarded, level by level.

        Parameters
        ----------
        x
            (p, d) points [m].
        rounding
            Error of the positions [m].
        most
            Greatest number of pairs; if there are more, the result is None.

        Returns
        -------
        point, facet
            (k,) numbers, sorted by points; a pair may occur twice.

        Examples
        --------
        >>> corners = np.array([[[0.0, 0.0], [1.0, 0.0]], [[1.0, 0.0], [2.0, 0.0]], [[2.0, 0.0], [3.0, 0.0]]])
        >>> tree = facet_tree(corners, np.tile([0.0, -1.0], (3, 1)))
        >>> point, facet = tree.near(np.array([[0.7, 0.2]]), 1e-15)
        >>> sorted(set(facet.tolist()))
        [0]
        """
        d, every = x.shape[1], np.arange(len(x))
        point, group, reach = every, np.zeros(len(x), dtype=np.int64), np.full(len(x), np.inf)
        for table in self.bounds:
            if len(table) > 1:
                point, group = np.repeat(point, 2), (2 * group[:, None] + np.arange(2)).ravel()
            row, at = table.take(group, axis=0), x.take(point, axis=0)
            known = _length(at - row[:, 2 * d : 3 * d])
            least = np.minimum.reduceat(known, np.searchsorted(point, every))
            reach = np.minimum(reach, least * (1.0 + 1e-12) + rounding)
            met = np.flatnonzero(
                _apart(at - row[:, :d], row[:, d : 2 * d], row[:, -2], row[:, -1]) <= reach.take(point)
            )
            point, group = point.take(met), group.take(met)
            if len(point) > most:
                return None
        return point, self.leaves[group]


def facet_tree(corners: Array, normals: Array) -> FacetTree:
    """Build the tree over facets with the corners (f, b, d) and the unit normals (f, d)."""
    count, centre = len(corners), corners.mean(axis=1)
    depth = int(np.ceil(np.log2(count)))
    leaves, bounds = np.minimum(np.arange(2**depth), count - 1), []
    for k in range(depth + 1):
        groups = leaves.reshape(2**k, -1)
        bounds.append(_bounds(corners[groups].reshape(2**k, -1, corners.shape[2]), normals[groups], centre[groups]))
        if k < depth:
            longest = np.ptp(centre[groups], axis=1).argmax(axis=1)
            order = np.argsort(centre[groups, longest[:, None]], axis=1, kind="stable")
            leaves = np.take_along_axis(groups, order, axis=1).ravel()
    return FacetTree(leaves=leaves, bounds=tuple(bounds))


def _bounds(vertices: Array, normals: Array, centres: Array) -> Array:
    """Table (g, 3 d + 2) of groups with the vertices (g, v, d); normals and centres (g, m, d) of their facets."""
    axis, middle = unit_vectors(normals.mean(axis=1)), vertices.mean(axis=1)
    arm = vertices - middle[:, None]
    height = np.einsum("gvi,gi->gv", arm, axis)
    low, high = height.min(axis=1), height.max(axis=1)
    radius = np.linalg.norm(arm - height[..., None] * axis[:, None], axis=-1).max(axis=1)
    sample = centres[np.arange(len(centres)), np.linalg.norm(centres - middle[:, None], axis=-1).argmin(axis=1)]
    return np.column_stack([middle + 0.5 * (low + high)[:, None] * axis, axis, sample, 0.5 * (high - low), radius])


def _apart(arm: Array, axis: Array, half: Array, radius: Array) -> Array:
    """Distances (p,) of points from cylinders, with vectors ``arm`` (p, d) from their centres and axes (p, d)."""
    height = np.einsum("pi,pi->p", axis, arm)
    across = np.sqrt(np.maximum(np.einsum("pi,pi->p", arm, arm) - height**2, 0.0))
    above, beside = np.maximum(np.abs(height) - half, 0.0), np.maximum(across - radius, 0.0)
    return np.asarray(np.sqrt(above**2 + beside**2))


def _length(v: Array) -> Array:
    return np.asarray(np.sqrt(np.einsum("pi,pi->p", v, v)))
