"""Pairs of boxes that overlap, by a grid of the centres of the second set."""

import numpy as np

from softway.arrays import Array, IntArray
from softway.kernels.jit.compilation import kernel

CELLS = 2
"""Cells of the grid for each box of the second set, at most."""
APART = 1.0 + 1e-9
"""Width of the cells beyond what is needed: rounding in the number of a cell misses no pair."""


def box_pairs(middle: Array, wide: Array, centre: Array, half: Array) -> tuple[IntArray, IntArray]:
    """Pairs (p,), (p,) of boxes ``middle`` +- ``wide`` (k, d) and ``centre`` +- ``half`` (m, d) that overlap or touch,
    sorted by the first and then the second.

    The order of the tests does not matter, so neither does the grid: it has cells as wide as the greatest distance of
    two centres that overlap, or wider ones where there would be many more cells than boxes.

    Examples
    --------
    >>> points = np.array([[0.0], [1.0], [2.0]])
    >>> [found.tolist() for found in box_pairs(points, np.full((3, 1), 0.5), points, np.full((3, 1), 0.5))]
    [[0, 0, 1, 1, 1, 2, 2], [0, 1, 0, 1, 2, 1, 2]]
    """
    if not len(middle) or not len(centre):
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    low, extent = centre.min(axis=0), np.ptp(centre, axis=0)
    side = np.maximum(wide.max(axis=0) + half.max(axis=0), np.finfo(float).tiny)
    number = np.maximum(np.minimum(extent / side, 2.0**20).astype(np.int64), 1)
    while number.prod() > max(CELLS * len(centre), 8):
        number[np.argmax(number)] = (number.max() + 1) // 2
    side = APART * np.maximum(side, extent / number)
    boxes = (middle, wide, centre, half)
    first, members = _binned(centre, low, side, number)
    ends = np.zeros(len(middle) + 1, np.int64)
    _visit(boxes, low, side, number, first, members, ends, np.zeros(0, np.int64))
    np.cumsum(ends, out=ends)
    found = np.empty(ends[-1], np.int64)
    _visit(boxes, low, side, number, first, members, ends, found)
    return np.repeat(np.arange(len(middle)), np.diff(ends)), found


def _binned(centre: Array, low: Array, side: Array, number: IntArray) -> tuple[IntArray, IntArray]:
    """Starts (c + 1,) of the cells of a grid in the list (m,) of the boxes in them."""
    place = np.minimum(((centre - low) / side).astype(np.int64), number - 1)
    cell = np.ravel_multi_index(tuple(place.T), tuple(number.tolist()))
    members = np.argsort(cell, kind="stable")
    return np.searchsorted(cell[members], np.arange(number.prod() + 1)), members


@kernel
def _visit(boxes, low, side, number, first, members, ends, found):
    """Count the partners of each box in ``ends[i + 1]``; with room in ``found``, write them from ``ends[i]`` on."""
    middle, wide, centre, half = boxes
    d, counts = middle.shape[1], len(found) == 0
    least, most = np.zeros(3, np.int64), np.zeros(3, np.int64)
    for i in range(len(middle)):
        place = ends[i]
        for x in range(d):
            at = (middle[i, x] - low[x]) / side[x]
            least[x] = min(max(np.floor(at) - 1.0, 0.0), number[x])
            most[x] = min(max(np.floor(at) + 2.0, 0.0), number[x])
        for x in range(d, 3):
            most[x] = 1
        for a in range(least[0], most[0]):
            for b in range(least[1], most[1]):
                for c in range(least[2], most[2]):
                    cell = a
                    if d > 1:
                        cell = cell * number[1] + b
                    if d > 2:
                        cell = cell * number[2] + c
                    for q in range(first[cell], first[cell + 1]):
                        j = members[q]
                        meets = True
                        for x in range(d):
                            meets &= abs(middle[i, x] - centre[j, x]) <= wide[i, x] + half[j, x]
                        if meets and counts:
                            ends[i + 1] += 1
                        elif meets:
                            _insert(found, ends[i], place, j)
                            place += 1


@kernel
def _insert(found, first, place, j):
    """Insert a number into an ascending list from ``first`` to ``place``."""
    while place > first and found[place - 1] > j:
        found[place] = found[place - 1]
        place -= 1
    found[place] = j
