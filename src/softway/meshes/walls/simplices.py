"""Bisection of triangles and tetrahedra at the middles of some of their edges."""

import numpy as np

from softway.arrays import Array, BoolArray, IntArray


def bisected(
    cells: IntArray, edges: IntArray, marked: IntArray, middle: IntArray, length: Array
) -> tuple[IntArray, IntArray]:
    """Triangles or tetrahedra cut at the middles of all marked edges, the longest first.

    All cells at an edge are cut together, so that facets of neighbours stay the same, and each cut keeps the sense of a
    cell.

    Parameters
    ----------
    cells
        (e, a) nodes.
    edges
        (b, 2) local nodes of the edges of a cell.
    marked, middle, length
        Edges (k, 2) in rising order, the node (k, 1) in the middle of each, and their lengths (k,) [m].

    Returns
    -------
    New cells (f, a), in the order of the old ones, and the numbers (f,) of these.

    Examples
    --------
    >>> square = np.array([[0, 1, 2], [0, 2, 3]])
    >>> sides = np.array([[0, 1], [1, 2], [2, 0]])
    >>> new, old = bisected(square, sides, np.array([[0, 2]]), np.array([[4]]), np.array([1.4]))
    >>> new.tolist(), old.tolist()
    ([[4, 1, 2], [0, 1, 4], [0, 4, 3], [4, 2, 3]], [0, 0, 1, 1])
    """
    count = 1 + int(max(cells.max(initial=0), marked.max(initial=0), middle.max(initial=0)))
    codes = marked[:, 0] * count + marked[:, 1]
    rank = np.empty(len(marked), int)
    rank[np.lexsort((np.arange(len(marked)), -length))] = np.arange(len(marked))
    parent = np.arange(len(cells))
    while True:
        at = _marked(cells, edges, codes, count)
        order = np.where(at >= 0, rank[at] if len(rank) else at, len(marked))
        best = order.argmin(axis=1)
        top = at[np.arange(len(cells)), best]
        chosen = _agreed(at, top, len(marked))
        cut = np.flatnonzero((top >= 0) & chosen[top]) if len(marked) else np.zeros(0, int)
        if not len(cut):
            return cells, parent
        cells, parent = _cut(cells, parent, cut, edges[best[cut]], middle[top[cut], 0])


def _marked(cells: IntArray, edges: IntArray, codes: IntArray, count: int) -> IntArray:
    """Number (e, b) of each edge of the cells among the marked ones, -1 for others."""
    pairs = np.sort(cells[:, edges], axis=2)
    code = pairs[..., 0] * count + pairs[..., 1]
    place = np.minimum(np.searchsorted(codes, code), max(len(codes) - 1, 0))
    found = codes[place] == code if len(codes) else np.zeros(code.shape, bool)
    return np.where(found, place, -1)


def _agreed(at: IntArray, top: IntArray, count: int) -> BoolArray:
    """True (k,) for the edges that are the next one of all cells around them."""
    around = np.bincount(at[at >= 0], minlength=count)
    return np.asarray(around == np.bincount(top[top >= 0], minlength=count))


def _cut(
    cells: IntArray, parent: IntArray, cut: IntArray, ends: IntArray, middle: IntArray
) -> tuple[IntArray, IntArray]:
    """Cells with those numbered ``cut`` (c,) in two, between the local nodes ``ends`` (c, 2)."""
    first, second = cells.copy(), cells[cut]
    first[cut, ends[:, 1]] = middle
    second[np.arange(len(cut)), ends[:, 0]] = middle
    order = np.argsort(np.concatenate([np.arange(len(cells)), cut]), kind="stable")
    return np.concatenate([first, second])[order], np.concatenate([parent, parent[cut]])[order]
