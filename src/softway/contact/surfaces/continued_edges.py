"""Edges of a surface that continue edges beyond a node: where there is none, the surface ends."""

import numpy as np

from softway.arrays import Array, BoolArray, IntArray

CONTINUED = -0.5
"""Greatest cosine between an edge and another one that continues it."""


def continued_edges(node: IntArray, unit: Array) -> tuple[IntArray, BoolArray]:
    """Edges (e,) that continue edges best at the same node, and if they do.

    Parameters
    ----------
    node
        (e,) node where each edge begins, or the number of its fan of facets there.
    unit
        (e, d) directions of the edges away from it.

    Examples
    --------
    Of three edges the first two go on in each other; at a second node there is one edge only:

    >>> unit = np.array([[1.0, 0.0], [-0.8, 0.6], [0.0, 1.0], [1.0, 0.0]])
    >>> other, continued = continued_edges(np.array([0, 0, 0, 1]), unit)
    >>> other.tolist(), continued.tolist()
    ([1, 0, 0, 3], [True, True, False, False])
    """
    order = np.argsort(node, kind="stable")
    count = np.bincount(node)
    width, first = count[node[order]], (np.cumsum(count) - count)[node[order]]
    begin = np.cumsum(width) - width
    row = np.repeat(np.arange(len(order)), width)
    other = np.arange(len(row)) - np.repeat(begin, width) + np.repeat(first, width)
    cosine = np.einsum("ed,ed->e", unit[order][row], unit[order][other])
    least = np.minimum.reduceat(cosine, begin)
    best = np.flatnonzero(cosine == least[row])
    place = best[np.searchsorted(row[best], np.arange(len(order)))]
    opposite, found = np.empty(len(node), dtype=np.int64), np.zeros(len(node), dtype=bool)
    opposite[order], found[order] = order[other[place]], least < CONTINUED
    return opposite, found
