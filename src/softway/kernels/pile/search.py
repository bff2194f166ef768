"""Search for contacts of balls by a grid of cells: its time is proportional to their number.

Cells are as wide as the greatest distance at which two balls are a pair, so that a ball has its partners in its own
cell and the 26 around.  Half of them are looked at, since the others look back.
"""

import numpy as np

from softway.kernels.jit.compilation import inlined, kernel, uncounted

FEW = 64
"""Entries that tables have at least."""


@inlined
def _key(i, j, k, most, keys):
    """Key of a cell; different cells may have the same."""
    return ((k * (most[1] + 1) + j) * (most[0] + 1) + i) % keys


@kernel
def _cells(place, size):
    """Balls in the order of the keys of their cells, starts of the keys, and the cells with their greatest numbers."""
    n = len(place)
    low, cell, most, total = np.empty(3), np.empty((n, 3), np.int64), np.zeros(3, np.int64), 1.0
    for c in range(3):
        low[c] = place[:, c].min()
        for i in range(n):
            cell[i, c] = np.int64((place[i, c] - low[c]) / size)
            most[c] = max(most[c], cell[i, c])
        total *= most[c] + 1.0
    keys = np.int64(min(total, 8.0 * n + FEW))
    start, order = np.zeros(keys + 1, np.int64), np.empty(n, np.int64)
    for i in range(n):
        start[_key(cell[i, 0], cell[i, 1], cell[i, 2], most, keys) + 1] += 1
    for k in range(keys):
        start[k + 1] += start[k]
    fill = start[:-1].copy()
    for i in range(n):
        k = _key(cell[i, 0], cell[i, 1], cell[i, 2], most, keys)
        order[fill[k]] = i
        fill[k] += 1
    return order, start, cell, most


@kernel
def near_pairs(place, radius, reach, walls):
    """Pairs (c, 2) whose gap is at most the sum of their reaches: lower ball, and higher ball or n + wall."""
    n, count = len(place), 0
    pairs = np.empty((8 * n + FEW, 2), np.int64)
    order, start, cell, most = _cells(place, 2.0 * (radius[:n].max() + reach.max()))
    for q in range(n):
        i = order[q]
        for w in range(len(walls.offset)):
            if wall_gap(place, radius, walls, i, w) <= reach[i]:
                pairs = _room(pairs, count)
                pairs[count, 0], pairs[count, 1] = i, n + w
                count += 1
        for turn in range(13, 27):
            a, b, c = cell[i, 0] + turn % 3 - 1, cell[i, 1] + (turn // 3) % 3 - 1, cell[i, 2] + turn // 9 - 1
            if min(a, b, c) < 0 or a > most[0] or b > most[1] or c > most[2]:
                continue
            k = _key(a, b, c, most, len(start) - 1)
            for p in range(start[k], start[k + 1]):
                j = order[p]
                if cell[j, 0] != a or cell[j, 1] != b or cell[j, 2] != c or (turn == 13 and p <= q):
                    continue
                if _distance(place, i, j) <= radius[i] + radius[j] + reach[i] + reach[j]:
                    pairs = _room(pairs, count)
                    pairs[count, 0], pairs[count, 1] = min(i, j), max(i, j)
                    count += 1
    return pairs[:count].copy()


@uncounted
def wall_gap(place, radius, walls, i, w):
    """Gap of a ball to a wall [m]."""
    total = -walls.offset[w] - radius[i]
    for c in range(3):
        total += walls.normal[w, c] * place[i, c]
    return total


@uncounted
def _distance(place, i, j):
    """Distance of two centres [m]."""
    total = 0.0
    for c in range(3):
        total += (place[j, c] - place[i, c]) ** 2
    return np.sqrt(total)


@kernel
def _room(pairs, count):
    """Table with room for one pair more."""
    if count < len(pairs):
        return pairs
    more = np.empty((2 * len(pairs), 2), np.int64)
    more[:count] = pairs
    return more
