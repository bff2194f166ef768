"""Bisection of cells: bars, triangles by the newest corner, tetrahedra of Arnold, Mukherjee and Pouly.

A cell of c corners is a row of integers: its corners with the refinement edge first, the two corners off the marked
edges of its faces (tetrahedra), its flag, the start of its key, and its level.  Middles of edges are in a hash table of
the codes of the edges.
"""

import numpy as np

from softway.kernels.jit.compilation import called, inlined, kernel

DEPTH = 40
"""Exponent of the length of the key of a base cell."""
SHIFT = 32
"""Bits of the greater node in the code of an edge."""
FREE = -1
"""Code of a free place of the table."""


@kernel
def bisected(rows, place, codes, nodes, count, start, level, closed):
    """Cells bisected until none is coarser than wanted and, if ``closed``, the mesh is conforming.

    Parameters
    ----------
    rows, place
        (e, c + 5) cells, and (e, c, c) barycentric coordinates of their corners in the base cell.
    codes, nodes
        (m,) codes of the edges with a middle, and the node there.
    count
        Number of nodes.
    start, level
        (g,) leaves in rising order, and the level wanted there.
    closed
        False to bisect the wanted cells alone.

    Returns
    -------
    The cells in rising order of their keys with their coordinates, codes in rising order with their nodes, and the
    number of nodes.
    """
    c, n = place.shape[1], len(rows)
    cells, places, table = _room(rows, n + 64), _room(place, n + 64), _table(codes, nodes, 4 * (n + len(codes)) + 256)
    parent, corners, order = np.empty(c + 5, np.int64), np.empty((c + 1, c)), np.empty(c, np.int64)
    i = 0
    while i < n:
        if _wanted(cells[i, c + 3], cells[i, c + 4], start, level):
            if n == len(cells):
                cells, places = _room(cells, 2 * n), _room(places, 2 * n)
            if 2 * count > len(table):
                table = _larger(table)
            count = _halved(cells, places, i, n, table, count, parent, corners, order)
            n += 1
        else:
            i += 1
    again = closed
    while again:
        again = False
        greatest = _greatest(cells, n, c, count)
        i = 0
        while i < n:
            coarse = _too_coarse(cells, i, c, greatest) if c == 2 else _has_middle(cells, i, c, table)
            if coarse:
                if n == len(cells):
                    cells, places = _room(cells, 2 * n), _room(places, 2 * n)
                if 2 * count > len(table):
                    table = _larger(table)
                before = count
                count = _halved(cells, places, i, n, table, count, parent, corners, order)
                again |= count > before
                n += 1
            if c == 2 or not coarse:
                i += 1
    order = np.argsort(cells[:n, c + 3])
    known = table[table[:, 0] != FREE]
    by_code = np.argsort(known[:, 0])
    return cells[order], places[order], known[by_code, 0], known[by_code, 1], count


@called
def _wanted(start, level, given, levels):
    """True if a deeper level is wanted in the interval of a cell."""
    k = np.searchsorted(given, start, side="right") - 1
    end = start + (np.int64(1) << (DEPTH - level))
    while k < len(given) and given[k] < end:
        if levels[k] > level:
            return True
        k += 1
    return False


@called
def _halved(cells, places, i, n, table, count, old, corners, order):
    """Put the halves of cell i into the rows i and n; the number of nodes after it.

    ``old`` (c + 5,), ``corners`` (c + 1, c) and ``order`` (c,) are room.
    """
    c = places.shape[1]
    one, two = cells[i, 0], cells[i, 1]
    middle, count = _middle(table, _code(one, two), count)
    for k in range(c + 5):
        old[k] = cells[i, k]
    for k in range(c):
        for j in range(c):
            corners[j, k] = places[i, j, k]
        corners[c, k] = (corners[0, k] + corners[1, k]) / 2.0
    level = old[c + 4] + 1
    for side in range(2):
        at = i if side == 0 else n
        first, second, flag = _child(old, side, c, order)
        for k in range(c):
            cells[at, k] = middle if order[k] == c else old[order[k]]
            for j in range(c):
                places[at, k, j] = corners[order[k], j]
        cells[at, c], cells[at, c + 1], cells[at, c + 2] = first, second, flag
        cells[at, c + 3] = old[c + 3] + side * (np.int64(1) << (DEPTH - level))
        cells[at, c + 4] = level
    return count


@called
def _child(old, side, c, order):
    """Fill the ``order`` (c,) of the corners of the half with corner ``side``, c for the middle; its marks and flag.

    Cut faces of tetrahedra are marked opposite to the middle; so is the new one, except that a flagged planar parent
    marks its edge between the middle and the refinement edge of both children.
    """
    if c == 2:
        order[0], order[1] = (0, 2) if side == 0 else (2, 1)
        return 0, 0, 0
    if c == 3:
        order[0], order[1], order[2] = (2, 0, 3) if side == 0 else (1, 2, 3)
        return 0, 0, 0
    kept = old[c + 1 - side]
    planar = old[c] == old[c + 1] and old[c] > 1
    if kept == side:
        order[0], order[1], order[2], order[3] = 2, 3, 4, side
    else:
        order[0], order[1], order[2], order[3] = side, 5 - kept, 4, kept
    flagged = old[c + 2] != 0
    return (3 if planar and flagged else 2), 2, (1 if planar and not flagged else 0)


@called
def _has_middle(cells, i, c, table):
    """True if an edge of cell i has a middle."""
    for k in range(c):
        for j in range(k):
            if table[_slot(table, _code(cells[i, k], cells[i, j])), 0] != FREE:
                return True
    return False


@inlined
def _greatest(cells, n, c, count):
    """Greatest level (count,) of the bars at each node; empty for other cells."""
    out = np.zeros(count if c == 2 else 0, np.int64)
    if c == 2:
        for i in range(n):
            for k in range(2):
                out[cells[i, k]] = max(out[cells[i, k]], cells[i, 6])
    return out


@called
def _too_coarse(cells, i, c, greatest):
    """True if bar i shares a node with one that was finer by two levels or more."""
    near = 0
    for k in range(2):
        if cells[i, k] < len(greatest):
            near = max(near, greatest[cells[i, k]])
    return near > cells[i, c + 4] + 1


@called
def _code(one, two):
    """Code of an edge, the same in both directions."""
    return (min(one, two) << SHIFT) + max(one, two)


@called
def _slot(table, code):
    """Place of a code in the table, or the free one where it belongs."""
    mask = len(table) - 1
    at = ((code ^ (code >> 29)) * np.int64(-7046029254386353131) >> 17) & mask
    while table[at, 0] != FREE and table[at, 0] != code:
        at = (at + 1) & mask
    return at


@called
def _middle(table, code, count):
    """Node in the middle of an edge, and the number of nodes with it."""
    at = _slot(table, code)
    if table[at, 0] == FREE:
        table[at, 0], table[at, 1] = code, count
        count += 1
    return table[at, 1], count


@inlined
def _table(codes, nodes, size):
    """Table of the codes and nodes of middles, with room for ``size`` of them at least."""
    length = 256
    while length < size:
        length *= 2
    out = np.full((length, 2), FREE, np.int64)
    for k in range(len(codes)):
        at = _slot(out, codes[k])
        out[at, 0], out[at, 1] = codes[k], nodes[k]
    return out


@inlined
def _larger(table):
    """The same table with twice the room."""
    known = table[table[:, 0] != FREE]
    return _table(known[:, 0].copy(), known[:, 1].copy(), 2 * len(table))


@inlined
def _room(values, size):
    """Copy of an array with ``size`` rows."""
    out = np.empty((size, *values.shape[1:]), values.dtype)
    to, given = out.ravel(), values.ravel()
    for k in range(len(given)):
        to[k] = given[k]
    return out
