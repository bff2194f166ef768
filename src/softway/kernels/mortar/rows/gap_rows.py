"""Rows of mortar contact: mean gaps, their derivatives and normals, from the overlaps of the simplices."""

import numpy as np

from softway.arrays import Array, IntArray
from softway.kernels.mortar.rows.distance_slopes import distance_slopes, slope_room
from softway.kernels.mortar.rows.fading import weight_slopes
from softway.kernels.mortar.rows.row_sums import sum_rows
from softway.kernels.mortar.tables import (
    Distances,
    Entries,
    Facets,
    FacetSums,
    Fading,
    Functions,
    Pairs,
    Room,
    Vertices,
)

NODES = 40
"""Number of nodes of a row for which there is place at first."""


def gap_rows(
    surfaces: tuple[Vertices, Vertices, Facets],
    functions: Functions,
    pairs: Pairs,
    vertices: tuple[Array, Array],
    heights: tuple[Array, Array],
    size: Array,
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
    size
        (p,) length or area of the slave simplices [m^r].
    node, x
        (u,) numbers of the nodes of both surfaces in the model, ascending, and their positions (u, d) [m].
    normal
        (m, d) normals, which are overwritten where a row is met.
    """
    slave, master, facets = surfaces
    m, d = normal.shape
    distances = _distances(slave, master, pairs, vertices, heights)
    fading, room = _fading(slave, master, pairs, vertices, size), _room(len(x), vertices[1], facets)
    gap, row, made = np.full(m, np.inf), 0, _entries(m, NODES * m, d)
    while True:
        row = sum_rows(
            row, slave, master, facets, functions, pairs, distances, fading, node, x, room, made, gap, normal
        )
        if row == m:
            return gap, made
        more = _entries(m, 2 * len(made.weight) + len(x), d)
        for old, new in zip(made, more, strict=True):
            new[: len(old)] = old
        made = more


def _distances(
    slave: Vertices, master: Vertices, pairs: Pairs, vertices: tuple[Array, Array], heights: tuple[Array, Array]
) -> Distances:
    """Distances of the pairs."""
    count, (p, k), d = len(pairs.master), slave.corner.shape, vertices[0].shape[1]
    found = Distances(
        facing=np.empty((count, k if len(heights[1]) else 1, d)),
        span=np.zeros((count, k)),
        height=np.zeros((count, k)),
        leaning=np.zeros((p, k, k, d)),
    )
    distance_slopes(slave, master, pairs, *vertices, heights, slope_room(k, d), found)
    return found


def _fading(slave: Vertices, master: Vertices, pairs: Pairs, vertices: tuple[Array, Array], size: Array) -> Fading:
    """Pairs whose weights change."""
    fades, k, d = pairs.change > 0.0, slave.corner.shape[1], vertices[0].shape[1]
    count = int(np.count_nonzero(fades))
    fading = Fading(
        number=np.where(fades, np.cumsum(fades) - 1, -1),
        slave=np.empty((count, k, d)),
        master=np.empty((count, k, d)),
        points=vertices[0],
        size=size,
    )
    if count:
        weight_slopes(slave, master, pairs, vertices[1], slope_room(k, d), fading)
    return fading


def _room(u: int, above: Array, facets: Facets) -> Room:
    """Place for a row of a model with ``u`` nodes."""
    (w, d), b = above.shape, facets.cells.shape[1]
    return Room(
        sums=np.zeros((u, 2 + d)),
        used=np.zeros(u, bool),
        listed=np.empty(u, np.int64),
        held=np.zeros((w, 1 + d)),
        seen=np.zeros(w, bool),
        opposite=np.empty(w, np.int64),
        number=np.zeros(2, np.int64),
        mean=np.empty(d),
        height=np.empty(1),
        terms=np.empty(1 + d),
        facet=FacetSums(*(np.zeros(shape) for shape in ((b, b), (b, b), (b,), (1, b), (4,), (4,)))),
    )


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
