"""Pairs of simplices of two surfaces that may touch in a slab."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.contact.surfaces.broad_phase import Sweep, near, sweep
from softway.contact.surfaces.wall_thickness import DEPTH
from softway.kernels.mortar.facing import Limits, Side, facing

ANGLE = -0.5
"""Greatest product of unit normals that face each other: 60 degrees."""
DEEP = 0.2
"""Overlap at the start of the slab, in sizes of the simplices, beyond which they belong to opposite sides of bodies;
less where a body is thin, see :func:`~softway.contact.surfaces.wall_thickness.admissible_depth`."""
FEW = 3.0
"""Distance in sizes of the simplices, in addition to travel and reach, beyond which a pair is ignored in the slab."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FacetPairs:
    """Pairs of simplices.

    Parameters
    ----------
    slave, master
        (s,) numbers of the simplices; ``slave`` ascends.
    limit
        (s,) greatest distance, in front or behind, at which the pair is considered [m].
    """

    slave: IntArray
    master: IntArray
    limit: Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Margin:
    """Distance [m] within which one of the simplices of a row must come for the row to have pairs.

    ``support`` (m, p) are the weights of the slave simplices in the rows.
    """

    distance: float
    support: sp.csr_array

    def taken(self, slave: Sweep, master: Sweep) -> IntArray:
        """Slave simplices (k,) of all rows with one within the distance, in ascending order."""
        p = self.support.shape[1]
        close = np.zeros(p)
        close[near(slave, master, self.distance)[0]] = 1.0
        if not close.any():
            return np.zeros(0, dtype=np.int64)
        rows = self.support @ close > 0.0
        return np.flatnonzero(self.support.T @ rows.astype(float) > 0.0)


def vector_areas(corners: Array) -> Array:
    """Outward normals (d, p) of segments (2, 2, p) or triangles (3, 3, p), with their length or area as magnitude.

    Examples
    --------
    >>> vector_areas(np.array([[0.0, 2.0], [0.0, 0.0]])[:, :, None])[:, 0].tolist()
    [0.0, -2.0]
    """
    edge = corners[:, 1:] - corners[:, :1]
    if len(corners) == 2:
        return np.stack([edge[1, 0], -edge[0, 0]])
    return np.asarray(0.5 * np.cross(edge[:, 0], edge[:, 1], axis=0))


def unit(vectors: Array, axis: int = 0) -> Array:
    """Unit vectors along an axis; zero vectors stay zero."""
    length = np.sqrt(np.sum(vectors**2, axis=axis, keepdims=True))
    return np.asarray(vectors / np.where(length > 0.0, length, 1.0))


def facet_pairs(
    slave: tuple[Array, Array],
    master: tuple[Array, Array],
    reach: float,
    thickness: tuple[Array | float, Array | float] = (np.inf, np.inf),
    margin: Margin | None = None,
) -> FacetPairs:
    """Find the pairs that may touch between two configurations.

    Their paths come within ``reach``.  At the start they face each other and the master is not behind the slave along
    its normal, or along the direction midway between both normals where no thin body limits the overlap; at the start
    or at the end it is within ``reach`` in front of the slave.

    Parameters
    ----------
    slave, master
        Coordinates (d, k, p) of the corners at the start and at the end [m].
    reach
        [m].
    thickness
        Thickness of the bodies behind the simplices of the slave (p,) and of the master (q,) [m].
    margin
        Rows that have pairs; by default all.

    Examples
    --------
    >>> below, above = (np.array([[a, b], [y, y]])[:, :, None] for a, b, y in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.3)))
    >>> [len(facet_pairs((below, below), (above, above), reach).slave) for reach in (0.2, 0.5)]
    [0, 1]
    """
    first, second = _sweep(slave), _sweep(master)
    i, j = near(first, second, reach, None if margin is None else margin.taken(first, second))
    if not len(i):
        return FacetPairs(slave=i, master=j, limit=np.zeros(0))
    sides = [_side(corners, t) for corners, t in zip((slave, master), thickness, strict=True)]
    limits = Limits(angle=ANGLE, deep=DEEP, part=DEPTH, reach=float(reach), few=FEW)
    kept, limit = np.empty(len(i), np.int64), np.empty(len(i))
    count = facing(sides[0], sides[1], i, j, limits, kept, limit)
    return FacetPairs(slave=i[kept[:count]], master=j[kept[:count]], limit=limit[:count])


def _side(corners: tuple[Array, Array], thickness: Array | float) -> Side:
    """Simplices of one surface, with corners (d, k, p) at both ends, for the loop."""
    start, end = (np.ascontiguousarray(c) for c in corners)
    return Side(
        start=start,
        end=end,
        normal=np.ascontiguousarray(unit(vector_areas(start))),
        last=np.ascontiguousarray(unit(vector_areas(end))),
        size=_sizes(start),
        motion=_centre_motion(corners),
        wall=np.full(start.shape[2], thickness, float),
    )


def _sweep(corners: tuple[Array, Array]) -> Sweep:
    """Moving boxes around the simplices."""
    d, k, p = corners[0].shape
    start, end = (points.reshape(d, -1).T for points in corners)
    return sweep(start, end, np.arange(k * p).reshape(k, p).T)


def _sizes(corners: Array) -> Array:
    """Longest edge (p,)."""
    return np.asarray(np.sqrt(np.sum((corners - np.roll(corners, 1, axis=1)) ** 2, axis=0)).max(axis=0))


def _centre_motion(corners: tuple[Array, Array]) -> Array:
    """Displacement (d, p) of the centres."""
    return np.asarray((corners[1] - corners[0]).mean(axis=1))
