"""Pairs of nodes that share a cell, in the order of a sparse matrix."""

import numpy as np

from softway.kernels.jit.compilation import kernel, shared


@kernel
def node_pairs(nodes, first, count):
    """Pairs of nodes of the pattern of a matrix, and the pairs of all cells that belong to each.

    The pairs of the cells have numbers, ``i a + j`` for the nodes i and j of a cell of a nodes, cell after cell.

    Parameters
    ----------
    nodes, first
        Nodes of the cells one after the other, and the place (e + 1,) of the first node of each cell there.
    count
        Number of nodes n.

    Returns
    -------
    rows
        (n + 1,) first pair of the pattern in each row.
    columns
        (p,) columns of the pairs, rising in each row.
    starts, members
        (p + 1,) place of the first member of each pair, and the members: numbers of pairs of cells, rising.
    """
    by_node, entry = _rows_of_cells(nodes, first, count)
    total = 0
    for k in range(len(first) - 1):
        total += (first[k + 1] - first[k]) ** 2
    rows, columns = np.empty(count + 1, np.int64), np.empty(total, np.int64)
    starts, members = np.empty(total + 1, np.int64), np.empty(total, np.int32)
    seen, place = np.empty(count, np.int64), np.empty(count, np.int64)
    pairs, done = 0, 0
    rows[0] = starts[0] = 0
    for node in range(count):
        seen[node] = -1
    for row in range(count):
        begin = pairs
        for k in range(by_node[row], by_node[row + 1]):
            cell = entry[k, 0]
            for j in range(first[cell], first[cell + 1]):
                if seen[nodes[j]] != row:
                    seen[nodes[j]] = row
                    place[nodes[j]] = 0
                    columns[pairs] = nodes[j]
                    pairs += 1
                place[nodes[j]] += 1
        _sort(columns, begin, pairs)
        for p in range(begin, pairs):
            number = place[columns[p]]
            place[columns[p]] = done
            done += number
            starts[p + 1] = done
        for k in range(by_node[row], by_node[row + 1]):
            cell, number = entry[k, 0], entry[k, 1]
            for j in range(first[cell], first[cell + 1]):
                members[place[nodes[j]]] = number + j - first[cell]
                place[nodes[j]] += 1
        rows[row + 1] = pairs
    return rows, columns[:pairs], starts[: pairs + 1], members


@shared
def _rows_of_cells(nodes, first, count):
    """Rows of the pairs of cells by node: where those of each node begin (n + 1,), and cell and first pair of each."""
    by_node, entry = np.empty(count + 1, np.int64), np.empty((len(nodes), 2), np.int64)
    for row in range(count + 1):
        by_node[row] = 0
    for node in nodes:
        by_node[node + 1] += 1
    fill, number = np.empty(count, np.int64), 0
    for row in range(count):
        fill[row] = by_node[row]
        by_node[row + 1] += by_node[row]
    for cell in range(len(first) - 1):
        for i in range(first[cell], first[cell + 1]):
            at = fill[nodes[i]]
            fill[nodes[i]] += 1
            entry[at, 0], entry[at, 1] = cell, number
            number += first[cell + 1] - first[cell]
    return by_node, entry


@shared
def _sort(values, begin, end):
    """Sort a part of the values; a sort by falling gaps, which compiles in a tenth of the time of that of an array."""
    gap = 1
    while 3 * gap + 1 < end - begin:
        gap = 3 * gap + 1
    while gap > 0:
        for k in range(begin + gap, end):
            value, at = values[k], k
            while at >= begin + gap and values[at - gap] > value:
                values[at] = values[at - gap]
                at -= gap
            values[at] = value
        gap //= 3


@kernel
def expanded(rows, columns, components):
    """Pattern of a matrix (n d, n d) whose pairs of nodes have full blocks.

    Parameters
    ----------
    rows, columns
        (n + 1,) first pair in each row, and columns (p,) of the pairs.
    components
        Number d of components.

    Returns
    -------
    order
        (p d d,) place of each entry of the matrix among the entries (p, d, d) of the pairs.
    indices, indptr
        Columns, and first entry of each row.
    """
    d, n = components, len(rows) - 1
    order, indices = np.empty(len(columns) * d * d, np.int32), np.empty(len(columns) * d * d, np.int32)
    indptr, at = np.empty(n * d + 1, np.int32), 0
    indptr[0] = 0
    for row in range(n):
        for i in range(d):
            for p in range(rows[row], rows[row + 1]):
                for j in range(d):
                    order[at] = (p * d + i) * d + j
                    indices[at] = columns[p] * d + j
                    at += 1
            indptr[row * d + i + 1] = at
    return order, indices, indptr
