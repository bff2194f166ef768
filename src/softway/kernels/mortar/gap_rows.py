"""Rows of mortar contact: mean gaps, their derivatives and normals, from the overlaps of the simplices.

One row follows the other: its terms are added up node by node, and the nodes of the row are sorted.  The derivatives
are explained in docs/theory/contact/mortar.md.
"""

import numpy as np

from softway.kernels.jit.compilation import inlined, kernel
from softway.kernels.mortar.simplices import vector_area

STEEP = 0.2
"""Lower bound of the cosine between two surfaces when their distance is measured."""
ROOM = 32
"""Number of nodes of a row for which there is room at first."""
OWN, CROSS, SLOPE = 0, 1, 2


@kernel
def gap_rows(slave, master, facets, functions, pairs, below, above, node, x, gap, normal):
    """Rows of the nodes of the slave: ``gap`` (m,) and ``normal`` (m, d) of those that are met, in place.

    Arguments: tables of :mod:`~softway.kernels.mortar.tables`, vertices ``below`` (v, d) and ``above`` (w, d), numbers
    ``node`` (u,) of the nodes in the model, ascending, and their positions ``x`` (u, d).  Returns the weights and the
    slopes of the gaps as sparse matrices: starts of the rows, columns, values.
    """
    (u, d), m = x.shape, len(gap)
    count, starts = np.zeros(2, np.int64), np.zeros((2, m + 1), np.int32)
    columns, weights = np.empty(ROOM * m, np.int32), np.empty(ROOM * m)
    places, slopes = np.empty(d * ROOM * m, np.int32), np.empty(d * ROOM * m)
    facing, leaning = _distance_slopes(slave, master, pairs, below, above)
    sums, used, listed, mean = np.zeros((u, SLOPE + d)), np.zeros(u, np.bool_), np.empty(u, np.int64), np.empty(d)
    row = (sums, used, listed)
    for r in range(m):
        met, covered, total = 0, 0.0, 0.0
        mean[:] = 0.0
        for use in range(facets.start[r], facets.start[r + 1]):
            part, met = _own_part(use, slave, facets, functions, row, met)
            covered += part
            part, met = _common_part(use, slave, master, facets, functions, pairs, facing, leaning, row, mean, met)
            total += part
        if covered > 0.0 and total > 0.0:
            columns, weights = _room(columns, weights, count[0] + met)
            places, slopes = _room(places, slopes, count[1] + d * met)
            _sort(listed, met)
            gap[r] = _write(row, met, covered, total, node, x, columns, weights, places, slopes, count)
            _set_direction(mean, normal, r)
        for q in range(met):
            sums[listed[q]], used[listed[q]] = 0.0, False
        starts[0, r + 1], starts[1, r + 1] = count[0], count[1]
    first, second = count[0], count[1]
    return starts[0], columns[:first], weights[:first], starts[1], places[:second], slopes[:second]


@inlined
def _distance_slopes(slave, master, pairs, below, above):
    """Slopes of the distances: ``facing`` (s, d) of the pairs, and ``leaning`` (p, k, k, d) of the slave simplices.

    The former are those of a shift of the slave.  The latter are integrals of coordinates on the slave times the change
    of the distance when its corners move: this also turns the direction in which it is measured.  Without the turn a
    row of two surfaces that are not parallel would have a moment.
    """
    d, p, k = below.shape[1], slave.corner.shape[0], slave.corner.shape[1]
    facing, leaning = np.empty((len(pairs.master), d)), np.zeros((p, k, k, d))
    square, gradient = np.empty((1, d)), np.empty((k, d))
    for i in range(p):
        if pairs.first[i] < pairs.first[i + 1]:
            _gradients(below, slave.corner, i, square, gradient)
        for s in range(pairs.first[i], pairs.first[i + 1]):
            _face(above, master.corner, pairs.master[s], square, facing, s)
            for a in range(k):
                distance = 0.0
                for b in range(k):
                    own, cross = slave.corner[i, b], master.corner[pairs.master[s], b]
                    for c in range(d):
                        both = pairs.own[s, a, b] * below[own, c] - pairs.cross[s, a, b] * above[cross, c]
                        distance += facing[s, c] * both
                for b in range(k):
                    lean = 0.0
                    for c in range(d):
                        lean += gradient[b, c] * facing[s, c]
                    for c in range(d):
                        leaning[i, a, b, c] += pairs.own[s, a, b] * facing[s, c] - distance * lean * square[0, c]
    return facing, leaning


@inlined
def _gradients(vertices, corner, i, square, gradient):
    """Unit normal (1, d) of a simplex, and gradients (k, d), along it, of its barycentric coordinates."""
    size = vector_area(vertices, corner, i, square, 0)
    for c in range(square.shape[1]):
        square[0, c] /= size
    if len(gradient) == 2:
        for c in range(2):
            gradient[1, c] = (vertices[corner[i, 1], c] - vertices[corner[i, 0], c]) / (size * size)
            gradient[0, c] = -gradient[1, c]
        return
    for k in range(3):
        start, end = corner[i, (k + 1) % 3], corner[i, (k + 2) % 3]
        for c in range(3):
            y, z = (c + 1) % 3, (c + 2) % 3
            turned = square[0, y] * (vertices[end, z] - vertices[start, z])
            gradient[k, c] = (turned - square[0, z] * (vertices[end, y] - vertices[start, y])) / (2.0 * size)


@inlined
def _face(vertices, corner, j, square, facing, s):
    """Slopes of the distance along a slave normal: the master normal divided by its cosine."""
    size, cosine = vector_area(vertices, corner, j, facing, s), 0.0
    for c in range(facing.shape[1]):
        facing[s, c] /= size if size > 0.0 else 1.0
        cosine -= square[0, c] * facing[s, c]
    for c in range(facing.shape[1]):
        facing[s, c] /= max(cosine, STEEP)


@inlined
def _own_part(use, slave, facets, functions, row, met):
    """Add a test function times the shape functions of its facet; its integral, and the number of nodes."""
    facet, place, covered = facets.facet[use], facets.place[use], 0.0
    for b in range(facets.cells.shape[1]):
        if facets.cells[facet, b] >= 0:
            amount = facets.share[use] * functions.own[facet, place, b]
            covered += amount
            if amount != 0.0:
                met = _spread(slave, facets.cells[facet, b], OWN, amount, row, met)
    return covered, met


@inlined
def _common_part(use, slave, master, facets, functions, pairs, facing, leaning, row, mean, met):
    """Add a test function times the motion of the master and the slopes; its integral, and the number of nodes.

    The normals of the pairs are added up in ``mean`` (d,).
    """
    facet, place, share = facets.facet[use], facets.place[use], facets.share[use]
    d, k, total = len(mean), slave.corner.shape[1], 0.0
    for i in range(facets.simplex[facet], facets.simplex[facet + 1]):
        if pairs.first[i] == pairs.first[i + 1]:
            continue
        for b in range(k):
            for c in range(d):
                amount = 0.0
                for a in range(k):
                    amount += share * functions.values[i, place, a] * leaning[i, a, b, c]
                met = _spread(slave, slave.corner[i, b], SLOPE + c, amount, row, met)
        for s in range(pairs.first[i], pairs.first[i + 1]):
            for b in range(k):
                amount, corner = 0.0, master.corner[pairs.master[s], b]
                for a in range(k):
                    amount += share * functions.values[i, place, a] * pairs.cross[s, a, b]
                total += amount
                met = _spread(master, corner, CROSS, amount, row, met)
                for c in range(d):
                    mean[c] += amount * facing[s, c]
                    met = _spread(master, corner, SLOPE + c, -amount * facing[s, c], row, met)
    return total, met


@inlined
def _spread(surface, vertex, term, amount, row, met):
    """Add an amount at a vertex to a term of its nodes; returns the number of nodes."""
    sums, used, listed = row
    for q in range(surface.start[vertex], surface.start[vertex + 1]):
        column = surface.column[q]
        if not used[column]:
            used[column], listed[met] = True, column
            met += 1
        sums[column, term] += surface.value[q] * amount
    return met


@inlined
def _sort(listed, count):
    """Sort the first numbers of a list by insertion."""
    for q in range(1, count):
        number, place = listed[q], q
        while place > 0 and listed[place - 1] > number:
            listed[place] = listed[place - 1]
            place -= 1
        listed[place] = number


@inlined
def _write(row, met, covered, total, node, x, columns, weights, places, slopes, count):
    """Write the weights and slopes of a row, without zeros, and add to their numbers; returns the gap."""
    (sums, _, listed), d, gap = row, x.shape[1], 0.0
    for q in range(met):
        u = listed[q]
        weight = sums[u, OWN] / covered - sums[u, CROSS] / total
        if weight != 0.0:
            columns[count[0]], weights[count[0]] = node[u], weight
            count[0] += 1
        for c in range(d):
            slope = sums[u, SLOPE + c] / total
            if slope != 0.0:
                places[count[1]], slopes[count[1]] = d * node[u] + c, slope
                count[1] += 1
                gap += slope * x[u, c]
    return gap


@inlined
def _set_direction(vector, normal, r):
    """Write the direction of a vector (d,) as the normal of a row."""
    size = 0.0
    for c in range(len(vector)):
        size += vector[c] ** 2
    size = np.sqrt(size)
    for c in range(len(vector)):
        normal[r, c] = vector[c] / size if size > 0.0 else 0.0


@inlined
def _room(indices, values, count):
    """Arrays with room for ``count`` entries at least."""
    if count <= len(indices):
        return indices, values
    more, others = np.empty(2 * count, np.int32), np.empty(2 * count)
    more[: len(indices)], others[: len(values)] = indices, values
    return more, others
