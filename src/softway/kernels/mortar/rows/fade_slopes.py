"""Slopes of a gap by the weights of pairs: of the mean, and of the test functions (docs/theory/contact/mortar.md)."""

from softway.kernels.jit.compilation import uncounted
from softway.kernels.mortar.dual_basis import (
    invert,
    mean_change,
    mean_part,
    stiffness_of_warping,
    warping_change,
    warping_of,
)
from softway.kernels.mortar.gap_functions import add_mass, at_corner, shape
from softway.kernels.mortar.rows.spread import spread_terms

COVERAGE, AREA, TOTAL, PART = 0, 1, 2, 3


@uncounted
def add_fades(use, mean, slave, master, facets, functions, pairs, distances, fading, room):
    """Add the slopes by which the weights of the pairs of a facet change, for their distances from the ``mean`` one."""
    facet, place, share = facets.facet[use], facets.place[use], facets.share[use]
    first, end = facets.simplex[facet], facets.simplex[facet + 1]
    if not _fades(first, end, pairs, fading):
        return
    sums, split = room.facet, end - first > 1
    _sum(first, end, mean, split, pairs, distances, sums)
    _solve(facet, place, facets, fading, sums)
    room.terms[0] = 0.0
    for i in range(first, end):
        for s in range(pairs.first[i], pairs.first[i + 1]):
            number = fading.number[s]
            if number >= 0:
                amount = share * _amount(
                    s, i - first, place, mean, split, functions.values[i, place], pairs, distances, sums
                )
                _spread(amount, slave, slave.corner[i], fading.slave[number], room)
                _spread(amount, master, master.corner[pairs.master[s]], fading.master[number], room)


@uncounted
def _fades(first, end, pairs, fading):
    """True if the weight of a pair of the simplices of a facet changes."""
    changing = 0
    for s in range(pairs.first[first], pairs.first[end]):
        changing += fading.number[s] >= 0
    return changing > 0


@uncounted
def _sum(first, end, mean, split, pairs, distances, sums):
    """Write the integrals ``mass`` (b, b) of the shape functions of a facet, and those ``apart`` (b,) of the shape
    functions and the distance from the ``mean`` one.
    """
    k = pairs.own.shape[1]
    sums.mass[:], sums.apart[:] = 0.0, 0.0
    for i in range(first, end):
        for s in range(pairs.first[i], pairs.first[i + 1]):
            for a in range(k):
                apart = _apart(s, a, mean, pairs, distances)
                for n in range(len(sums.apart)):
                    sums.apart[n] += shape(n, i - first, a, split) * apart
                for e in range(k):
                    add_mass(sums.mass, i - first, a, e, pairs.own[s, a, e], split)


@uncounted
def _apart(s, a, mean, pairs, distances):
    """Integral of a coordinate a and the distance of a pair from the mean one."""
    apart = distances.span[s, a] - distances.height[s, a]
    for e in range(pairs.cross.shape[2]):
        apart -= mean * pairs.cross[s, a, e]
    return apart


@uncounted
def _solve(facet, place, facets, fading, sums):
    """Write the ``inverse`` of the mass, its product ``dual`` (1, b) with the integrals of the distance, and ``known``:
    covered fraction and area of the facet, integral of the shape function ``place``, part of the shape functions.
    """
    first, end, covered, known, b = facets.simplex[facet], facets.simplex[facet + 1], 0.0, sums.known, 0
    for node in range(facets.cells.shape[1]):
        b += facets.cells[facet, node] >= 0
    known[AREA] = known[TOTAL] = 0.0
    for i in range(first, end):
        known[AREA] += fading.size[i]
    for n in range(b):
        known[TOTAL] += sums.mass[place, n]
        for m in range(b):
            covered += sums.mass[n, m]
    known[COVERAGE] = covered / known[AREA]
    known[PART], sums.warp[:], sums.dual[:] = mean_part(known[COVERAGE]), 0.0, 0.0
    if end - first > 1 and known[COVERAGE] < 1.0:
        warping_of(fading.points, facets.cells[facet], sums.warp)
    penalty = stiffness_of_warping(covered, known[COVERAGE])
    for n in range(b):
        for m in range(b):
            sums.inverse[n, m] = sums.mass[n, m] + penalty * sums.warp[n] * sums.warp[m]
    if known[PART] < 1.0:
        invert(sums.inverse, b)
        for n in range(b):
            for m in range(b):
                sums.dual[0, n] += sums.inverse[n, m] * sums.apart[m]


@uncounted
def _amount(s, piece, place, mean, split, values, pairs, distances, sums):
    """Change of the integral of a test function and the distance, per relative change of the weight of a pair."""
    k, amount, own, own_place, bent = len(values), 0.0, 0.0, 0.0, 0.0
    for a in range(k):
        amount += values[a] * _apart(s, a, mean, pairs, distances)
        here, one = shape(place, piece, a, split), at_corner(sums.inverse, place, piece, a, split)
        for e in range(k):
            mass = pairs.own[s, a, e]
            own += mass
            own_place += here * mass
            bent += one * mass * at_corner(sums.dual, 0, piece, e, split)
    part, total, dual = sums.known[PART], sums.known[TOTAL], sums.dual[0, place]
    if part < 1.0:
        stiff = slack = 0.0
        for n in range(sums.dual.shape[1]):
            stiff += sums.inverse[place, n] * sums.warp[n]
            slack += sums.warp[n] * sums.dual[0, n]
        bent += warping_change(own, sums.known[COVERAGE]) * stiff * slack
        amount += (1.0 - part) * (own_place * dual - total * bent)
        amount += mean_change(sums.known[COVERAGE]) * own / sums.known[AREA] * (sums.apart[place] - total * dual)
    return amount


@uncounted
def _spread(amount, surface, corner, change, room):
    """Add an amount times the ``change`` (k, d) under a motion of the corners of a simplex."""
    for b in range(len(corner)):
        for c in range(change.shape[1]):
            room.terms[1 + c] = amount * change[b, c]
        spread_terms(surface, corner[b], room)
