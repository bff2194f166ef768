"""Sums over the test functions of the slave, one row after the other, node by node."""

import numpy as np

from softway.kernels.jit.compilation import uncounted, uncounted_kernel
from softway.kernels.mortar.rows.fade_slopes import add_fades
from softway.kernels.mortar.rows.spread import CROSS, list_node, spread_terms

OWN, SLOPE = 0, CROSS + 1


@uncounted_kernel
def sum_rows(first, slave, master, facets, functions, pairs, distances, fading, node, x, room, made, gap, normal):
    """Rows of the nodes of the slave from ``first`` on, until there is no place for one more; returns the next row.

    Arguments: tables of :mod:`~softway.kernels.mortar.tables`, numbers ``node`` (u,) of the
    nodes in the model, ascending, and their positions ``x`` (u, d).  ``gap`` (m,) and ``normal`` (m, d) are written
    where the row is met.
    """
    for r in range(first, len(gap)):
        covered = total = 0.0
        room.number[0], room.height[0] = 0, 0.0
        for c in range(x.shape[1]):
            room.mean[c] = 0.0
        room.number[1] = 0
        for use in range(facets.start[r], facets.start[r + 1]):
            covered += _own_part(use, slave, facets, functions, room)
            total += _common_part(use, slave, master, facets, functions, pairs, distances, room)
        _spread_opposite(master, room)
        if len(fading.slave) > 0 and covered > 0.0 and total > 0.0:
            mean = (_distance_sum(room, x) - room.height[0]) / total
            for use in range(facets.start[r], facets.start[r + 1]):
                add_fades(use, mean, slave, master, facets, functions, pairs, distances, fading, room)
        met = room.number[0]
        free = made.first[r] + met <= len(made.weight) and made.start[r] + x.shape[1] * met <= len(made.slope)
        made.first[r + 1], made.start[r + 1] = made.first[r], made.start[r]
        if free and covered > 0.0 and total > 0.0:
            _sort(room.listed, met)
            gap[r] = _write(room, covered, total, node, x, made, r + 1) - room.height[0] / total
            _set_direction(room.mean, normal, r)
        for q in range(met):
            column = room.listed[q]
            room.used[column] = False
            for term in range(room.sums.shape[1]):
                room.sums[column, term] = 0.0
        if not free:
            return r
    return len(gap)


@uncounted
def _own_part(use, slave, facets, functions, room):
    """Add a test function times the shape functions of its facet; returns its integral."""
    facet, place, covered = facets.facet[use], facets.place[use], 0.0
    for b in range(facets.cells.shape[1]):
        if facets.cells[facet, b] >= 0:
            amount = facets.share[use] * functions.own[facet, place, b]
            covered += amount
            if amount != 0.0:
                vertex = facets.cells[facet, b]
                for q in range(slave.start[vertex], slave.start[vertex + 1]):
                    list_node(slave.column[q], room)
                    room.sums[slave.column[q], OWN] += slave.value[q] * amount
    return covered


@uncounted
def _common_part(use, slave, master, facets, functions, pairs, distances, room):
    """Add a test function times the motion of the master and the slopes; returns its integral.

    The normals of the pairs, the heights, and the sums of the vertices of the master are added up in ``room``.
    """
    facet, place, share = facets.facet[use], facets.place[use], facets.share[use]
    d, k, total = distances.leaning.shape[3], slave.corner.shape[1], 0.0
    for i in range(facets.simplex[facet], facets.simplex[facet + 1]):
        if pairs.first[i] == pairs.first[i + 1]:
            continue
        for b in range(k):
            room.terms[0] = 0.0
            for c in range(d):
                room.terms[1 + c] = 0.0
                for a in range(k):
                    room.terms[1 + c] += share * functions.values[i, place, a] * distances.leaning[i, a, b, c]
            spread_terms(slave, slave.corner[i, b], room)
        for s in range(pairs.first[i], pairs.first[i + 1]):
            for a in range(k):
                room.height[0] += share * functions.values[i, place, a] * distances.height[s, a]
            total += _opposite_part(share, functions.values[i, place], s, master, pairs, distances, room)
    return total


@uncounted
def _distance_sum(room, x):
    """Sum of the distances of a row, from its slopes and the positions (u, d)."""
    total = 0.0
    for q in range(room.number[0]):
        u = room.listed[q]
        for c in range(x.shape[1]):
            total += room.sums[u, SLOPE + c] * x[u, c]
    return total


@uncounted
def _opposite_part(share, values, s, master, pairs, distances, room):
    """Add a test function with ``values`` (k,) times the motion of the master of a pair and the slopes; returns its
    integral.
    """
    k, d, total, flat = len(values), len(room.mean), 0.0, distances.facing.shape[1] == 1
    for b in range(k):
        vertex, sum_ = master.corner[pairs.master[s], b], 0.0
        if not room.seen[vertex]:
            room.seen[vertex], room.opposite[room.number[1]] = True, vertex
            room.number[1] += 1
        for a in range(k):
            amount = share * values[a] * pairs.cross[s, a, b]
            sum_ += amount
            if not flat:
                for c in range(d):
                    room.held[vertex, 1 + c] -= amount * distances.facing[s, a, c]
                    room.mean[c] += amount * distances.facing[s, a, c]
        room.held[vertex, 0] += sum_
        total += sum_
        if flat:
            for c in range(d):
                room.held[vertex, 1 + c] -= sum_ * distances.facing[s, 0, c]
    if flat:
        for c in range(d):
            room.mean[c] += total * distances.facing[s, 0, c]
    return total


@uncounted
def _spread_opposite(master, room):
    """Add the terms of the vertices of the master, the motion and the slopes, to those of their nodes; clear them."""
    for q in range(room.number[1]):
        vertex = room.opposite[q]
        for term in range(len(room.terms)):
            room.terms[term], room.held[vertex, term] = room.held[vertex, term], 0.0
        room.seen[vertex] = False
        spread_terms(master, vertex, room)


@uncounted
def _sort(listed, count):
    """Sort the first numbers of a list by insertion."""
    for q in range(1, count):
        number, place = listed[q], q
        while place > 0 and listed[place - 1] > number:
            listed[place] = listed[place - 1]
            place -= 1
        listed[place] = number


@uncounted
def _write(room, covered, total, node, x, made, end):
    """Write the weights and slopes of a row, without zeros; returns its gap."""
    d, gap = x.shape[1], 0.0
    for q in range(room.number[0]):
        u = room.listed[q]
        weight = room.sums[u, OWN] / covered - room.sums[u, CROSS] / total
        if weight != 0.0:
            place = made.first[end]
            made.column[place], made.weight[place] = node[u], weight
            made.first[end] += 1
        for c in range(d):
            slope = room.sums[u, SLOPE + c] / total
            if slope != 0.0:
                place = made.start[end]
                made.component[place], made.slope[place] = d * node[u] + c, slope
                made.start[end] += 1
                gap += slope * x[u, c]
    return gap


@uncounted
def _set_direction(vector, normal, r):
    """Write the direction of a vector (d,) as the normal of a row."""
    size = 0.0
    for c in range(len(vector)):
        size += vector[c] ** 2
    size = np.sqrt(size)
    for c in range(len(vector)):
        normal[r, c] = vector[c] / size if size > 0.0 else 0.0
