"""Broad phase: pairs of moving boxes that may come within reach of one another in a slab.

Boxes are grouped by similar size (octaves), each group with a grid of centres: a graded mesh costs no more than a
uniform one.  Paths that are long compared with the boxes are cut into pieces, whose centres are in a tree.  Motion is
relative to the mean motion of the second set: two bodies that fly together have no pairs.  Boxes that do not come near
the box around the whole other set are left out before.  The cost is O(n log n) unless many boxes overlap.
"""

from dataclasses import dataclass
from functools import reduce

import numpy as np
from scipy.spatial import cKDTree

from softway.arrays import Array, IntArray
from softway.kernels.geometry.box_pairs import box_pairs

PIECES = 256
"""Greatest number of pieces of a path."""
ROUNDING = 1e-12
"""Tolerance relative to the coordinates, so that boxes that only touch are found."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Sweep:
    """Boxes that move along straight lines: centres (k, d) at both ends of a slab, greatest half widths (k, d) [m]."""

    start: Array
    end: Array
    half: Array

    def subset(self, which: IntArray) -> "Sweep":
        """Subset of the boxes."""
        return Sweep(start=self.start[which], end=self.end[which], half=self.half[which])


def sweep(x0: Array, x1: Array, nodes: IntArray, swelling: float = 0.0) -> Sweep:
    """Boxes around groups of nodes (k, b) that move from x0 (n, d) to x1 (n, d).

    ``swelling`` is the distance, relative to its width, by which curved groups extend beyond the box of their nodes.

    Examples
    --------
    >>> x = np.array([[0.0, 0.0], [2.0, 1.0]])
    >>> sweep(x, x, np.array([[0, 1]])).half.tolist()
    [[1.0, 0.5]]
    """
    (low0, high0), (low1, high1) = (_box(x, nodes) for x in (x0, x1))
    half = np.maximum(high0 - low0, high1 - low1) * (0.5 + swelling)
    return Sweep(start=0.5 * (low0 + high0), end=0.5 * (low1 + high1), half=half)


def _box(x: Array, nodes: IntArray) -> tuple[Array, Array]:
    """Least and greatest coordinates (k, d) of groups of nodes (k, b)."""
    parts = [x[column] for column in nodes.T]
    return reduce(np.minimum, parts), reduce(np.maximum, parts)


def near(one: Sweep, two: Sweep, reach: float, which: IntArray | None = None) -> tuple[IntArray, IntArray]:
    """Pairs (p,), (p,) of boxes whose paths come within ``reach`` [m], sorted by the first and then the second.

    Of the first set only the boxes ``which`` (k,), in ascending order, are taken if these are given.

    Examples
    --------
    A point that flies through two plates in one slab, and a plate beside its path:

    >>> x0 = np.array([[0.0, 9.0], [-1.0, 5.0], [1.0, 5.0], [-1.0, 2.0], [1.0, 2.0], [3.0, 2.0], [5.0, 2.0]])
    >>> x1 = x0.copy()
    >>> x1[0, 1] = -9.0
    >>> point, plates = sweep(x0, x1, np.array([[0]])), sweep(x0, x1, np.array([[1, 2], [3, 4], [5, 6]]))
    >>> [found.tolist() for found in near(point, plates, 0.1)]
    [[0, 0], [0, 1]]
    """
    if which is not None:
        i, j = near(one.subset(which), two, reach)
        return which[i], j
    if not len(one.half) or not len(two.half):
        return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64)
    drift = (two.end - two.start).mean(axis=0)
    rest = 0.5 * np.abs(two.end - two.start - drift)  # half of the motion relative to the mean
    centre, half = 0.5 * (two.start + two.end - drift), two.half + rest
    start, end = one.start, one.end - drift
    middle, wide = 0.5 * (start + end), one.half + 0.5 * np.abs(end - start) + reach
    first = _beside(middle, wide, centre, half)
    second = _beside(centre, half, middle[first], wide[first]) if len(first) else first
    if not len(second):
        return second, second
    paths = _Paths(start=start[first], end=end[first], thick=one.half[first], middle=middle[first], wide=wide[first])
    i, j = _met(paths, centre[second], half[second], reach)
    return first[i], second[j]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Paths:
    """Boxes (k, d) on their way: centres at the ends, half widths, and the middles and half widths of boxes around the
    paths, which include the reach.
    """

    start: Array
    end: Array
    thick: Array
    middle: Array
    wide: Array


def _beside(middle: Array, wide: Array, other: Array, half: Array) -> IntArray:
    """Numbers of the boxes ``middle`` +- ``wide`` (k, d) that meet the box around all boxes ``other`` +- ``half``."""
    low, high = (other - half).min(axis=0), (other + half).max(axis=0)
    slack = ROUNDING * np.maximum(np.abs(low), np.abs(high))
    return np.flatnonzero(((middle + wide >= low - slack) & (middle - wide <= high + slack)).all(axis=1))


def _met(paths: _Paths, centre: Array, half: Array, reach: float) -> tuple[IntArray, IntArray]:
    """Pairs of paths and boxes that may come within reach, sorted, each once."""
    keys = [
        _pairs(a, b, paths, centre, half, reach)
        for b in _octaves(half.max(axis=1))
        for a in _octaves(paths.thick.max(axis=1))
    ]
    key = keys[0] if len(keys) == 1 else np.sort(np.concatenate(keys))
    i = key // len(half)
    return i, key - i * len(half)


def _octaves(size: Array) -> list[IntArray]:
    """Numbers of the boxes in groups of similar size."""
    level = np.frexp(size)[1]
    return [np.flatnonzero(level == k) for k in np.unique(level)]


def _pairs(a: IntArray, b: IntArray, paths: _Paths, centre: Array, half: Array, reach: float) -> IntArray:
    """Keys ``first * number + second`` of the pairs of one group ``a`` of paths with one group ``b`` of boxes, sorted.

    Boxes around paths that are short compared with the boxes are compared on a grid.
    """
    motion = paths.end[a] - paths.start[a]
    size = max(float(half[b].max() + paths.thick[a].max()) + reach, np.finfo(float).tiny)
    pieces = np.clip(np.ceil(0.5 * np.abs(motion).max(axis=1) / size), 1, PIECES).astype(np.int64)
    if pieces.max() == 1:
        i, j = box_pairs(paths.middle[a], paths.wide[a], centre[b], half[b])
        return np.asarray(a[i] * len(half) + b[j])
    path = np.repeat(np.arange(len(a)), pieces)
    number = np.arange(len(path)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    middles = paths.start[a][path] + ((number + 0.5) / pieces[path])[:, None] * motion[path]
    radius = size + float((0.5 * np.abs(motion).max(axis=1) / pieces).max())
    tree, other = cKDTree(middles), cKDTree(centre[b])
    # distances have a small tolerance, so that boxes that only touch are found
    met = tree.sparse_distance_matrix(other, radius * (1.0 + 1e-12), p=np.inf, output_type="ndarray")
    i, j = a[path[met["i"]]], b[met["j"]]
    for axis in range(half.shape[1]):
        keep = np.abs(paths.middle[i, axis] - centre[j, axis]) <= paths.wide[i, axis] + half[j, axis]
        i, j = i[keep], j[keep]
    return np.unique(i * len(half) + j)
