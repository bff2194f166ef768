"""Rows of mortar contact: mean gaps, their derivatives and normals, from the overlaps of the simplices."""

import numpy as np

from softway.arrays import Array, IntArray
from softway.kernels.mortar.distance_slopes import distance_slopes, slope_room
from softway.kernels.mortar.row_sums import sum_rows
from softway.kernels.mortar.tables import Distances, Entries, Facets, Functions, Pairs, Room, Vertices

NODES = 40
"""Number of nodes of a row for which there is place at first."""


def gap_rows(
    surfaces: tuple[Vertices, Vertices, Facets],
    functions: Functions,
    pairs: Pairs,
    vertices: tuple[Array, Array],
    heights: tuple[Array, Array],
    node: IntArray,
    x: Array,
    normal: Array,
) -> tuple[Array, Entries]:
    """Gaps (m,) of the rows, infinite where nothing is met, and the entries of weights and slopes.

    Parameters
    ----------
    surfaces, functions, pairs
        Tables of slave, master and facets; test functions; pairs of simplices that overlap.
    vertices
        (v, d) of the slave and (w, d) of the master [m].
    heights
        (p, k, k) and (q, k, k) above their simplices, as quadratic forms of coordinates [m]; none of flat surfaces.
    node, x
        (u,) numbers of the nodes of both surfaces in the model, ascending, and their positions (u, d) [m].
    normal
        (m, d) normals, which are overwritten where a row is met.
    """
    slave, master, facets = surfaces
    (u, d), m, (p, k) = x.shape, len(normal), slave.corner.shape
    count = len(pairs.master)
    each = k if len(heights[1]) else 1
    distances = Distances(
        facing=np.empty((count, each, d)), height=np.zeros((count, k)), leaning=np.zeros((p, k, k, d))
    )
    distance_slopes(slave, master, pairs, *vertices, heights, slope_room(k, d), distances)
    room = Room(
        sums=np.zeros((u, 2 + d)),
        used=np.zeros(u, bool),
        listed=np.empty(u, np.int64),
        held=np.zeros((len(vertices[1]), 1 + d)),
        seen=np.zeros(len(vertices[1]), bool),
        opposite=np.empty(len(vertices[1]), np.int64),
        number=np.zeros(2, np.int64),
        mean=np.empty(d),
        height=np.empty(1),
        terms=np.empty(1 + d),
    )
    gap, row, made = np.full(m, np.inf), 0, _entries(m, NODES * m, d)
    while True:
        row = sum_rows(row, slave, master, facets, functions, pairs, distances, node, x, room, made, gap, normal)
        if row == m:
            return gap, made
        more = _entries(m, 2 * len(made.weight) + u, d)
        for old, new in zip(made, more, strict=True):
            new[: len(old)] = old
        made = more


def _entries(m: int, z: int, d: int) -> Entries:
    """Place for z weights and d z slopes of m rows."""
    return Entries(
        first=np.zeros(m + 1, np.int64),
        column=np.empty(z, np.int64),
        weight=np.empty(z),
        start=np.zeros(m + 1, np.int64),
        component=np.empty(d * z, np.int64),
        slope=np.empty(d * z),
    )
