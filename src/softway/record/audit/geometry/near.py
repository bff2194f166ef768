"""Pairs of boxes that overlap: the broad phase of the audit."""

import numpy as np
from scipy.spatial import cKDTree

from softway.arrays import Array, IntArray

SMALLEST = 1e-12
"""Radius of a box, relative to the largest one, below which all boxes are treated alike."""


def near(low: Array, high: Array, other_low: Array, other_high: Array) -> tuple[IntArray, IntArray]:
    """Numbers (k,), (k,) of the boxes of a first and a second list that overlap, in lexical order.

    Boxes of similar size (within a factor of two) are searched together by trees of their centres.

    Parameters
    ----------
    low, high
        (n, d) least and greatest coordinates of the first list [m].
    other_low, other_high
        (m, d) those of the second list [m].

    Examples
    --------
    >>> a, b = np.array([[0.0], [2.0]]), np.array([[0.5]])
    >>> [found.tolist() for found in near(a, a + 1.0, b, b + 1.0)]
    [[0], [0]]
    """
    firsts, seconds = _classes(low, high), _classes(other_low, other_high)
    left, right = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
    for mine, tree, size in firsts:
        for theirs, other, other_size in seconds:
            found = tree.sparse_distance_matrix(other, size + other_size, p=np.inf, output_type="ndarray")
            i, j = mine[found["i"]], theirs[found["j"]]
            keep = ((low[i] <= other_high[j]) & (other_low[j] <= high[i])).all(axis=1)
            left.append(i[keep])
            right.append(j[keep])
    i, j = np.concatenate(left), np.concatenate(right)
    order = np.lexsort((j, i))
    return i[order], j[order]


def _classes(low: Array, high: Array) -> list[tuple[IntArray, cKDTree, float]]:
    """Members, tree of centres and greatest half side of the boxes of each octave of size."""
    if not len(low):
        return []
    half = 0.5 * (high - low).max(axis=1)
    octave = np.round(np.log2(np.maximum(half, max(SMALLEST * half.max(), np.finfo(float).tiny)))).astype(int)
    out = []
    for one in np.unique(octave):
        mine = np.flatnonzero(octave == one)
        out.append((mine, cKDTree(0.5 * (low[mine] + high[mine])), float(half[mine].max())))
    return out
