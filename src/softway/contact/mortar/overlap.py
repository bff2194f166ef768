"""Integrals over the overlap of two surfaces of simplices."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray
from softway.contact.mortar.facet_pairs import FacetPairs
from softway.contact.mortar.surface_tables import SurfaceTables
from softway.kernels.mortar.gap_functions import sum_masses
from softway.kernels.mortar.rows.fading import fade
from softway.kernels.mortar.segments import segment_overlap
from softway.kernels.mortar.simplices import keep_near
from softway.kernels.mortar.tables import Pairs
from softway.kernels.mortar.triangles import triangle_overlap, triangle_room


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Overlap:
    """Integrals of products of barycentric coordinates over the overlaps of s pairs of simplices [m^r].

    Parameters
    ----------
    slave, master
        (s,) simplices of the pairs; ``slave`` ascends.
    own
        (s, k, k) with both coordinates on the slave simplex.
    cross
        (s, k, k) with one coordinate on the slave simplex, the other on the master simplex.
    change
        (s,) change of the weight of a pair with the cosine of the angle between its surfaces, relative to the weight.

    Examples
    --------
    Two pairs of segments: the overlap of the first has a length of one, that of the second is half of it:

    >>> own = np.array([1.0, 0.5])[:, None, None] * np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0
    >>> both = {"slave": np.array([0, 0]), "master": np.array([3, 4])}
    >>> common = Overlap(**both, own=own, cross=own, change=np.zeros(2))
    >>> common.measure.round(12).tolist(), common.mass(2).sum(axis=(1, 2)).round(12).tolist()
    ([1.0, 0.5], [1.5, 0.0])
    """

    slave: IntArray
    master: IntArray
    own: Array
    cross: Array
    change: Array

    @property
    def measure(self) -> Array:
        """Length or area (s,) of the overlap."""
        return np.asarray(self.own.sum(axis=(1, 2)))

    def mass(self, count: int) -> Array:
        """Sums (count, k, k) of ``own`` over the pairs of each slave simplex."""
        out = np.zeros((count, *self.own.shape[1:]))
        sum_masses(self.slave, self.own, out)
        return out

    def pairs(self, count: int) -> Pairs:
        """Pairs of the slave simplices for the loops."""
        first = np.searchsorted(self.slave, np.arange(count + 1))
        return Pairs(first=first, master=self.master, own=self.own, cross=self.cross, change=self.change)


def overlap(
    tables: SurfaceTables, pairs: FacetPairs, below: Array, above: Array, areas: Array, normal: Array
) -> Overlap:
    """Overlap of the pairs within their limits, times the weights of pairs that hardly face each other.

    Parameters
    ----------
    tables, pairs
        The surfaces, and their simplices that may touch.
    below, above
        Vertices (v, d) of the slave and (w, d) of the master [m].
    areas
        (p, d) normals of the slave simplices, with their length or area as magnitude.
    normal
        (m, d) unit normals at the nodes of the slave, into the body.
    """
    i, j, slave, master = pairs.slave, pairs.master, tables.slave.corner, tables.master.corner
    pair, (own, cross) = np.empty(len(i), np.int64), np.empty((2, len(i), slave.shape[1], slave.shape[1]))
    if below.shape[1] == 2:
        count = segment_overlap(below, slave, -normal, above, master, i, j, pair, own, cross)
    else:
        room = triangle_room(len(slave), len(master))
        count = triangle_overlap(below, slave, above, master, i, j, room, pair, own, cross)
    count = keep_near(below, slave, above, master, areas, i, j, pairs.limit, count, pair, own, cross)
    change = np.empty(count)
    count = fade(areas, above, master, i, j, count, pair, own, cross, change, np.empty((1, below.shape[1])))
    kept = pair[:count]
    return Overlap(slave=i[kept], master=j[kept], own=own[:count], cross=cross[:count], change=change[:count])
