"""Test functions of the gaps on all facets of a slave surface, from the covered parts of its simplices."""

from softway.kernels.jit.compilation import uncounted, uncounted_kernel
from softway.kernels.mortar.dual_basis import dual_functions, warping_of

LEAST = 1e-9
"""Covered fraction of a facet below which it is ignored."""
QUARTER = 0.25
"""Shape functions of a four-node facet in its middle, where its simplices meet."""


@uncounted_kernel
def gap_functions(facets, points, size, mass, whole, warp, coefficients, values, own):
    """Write the functions ``values`` (p, b, k) and integrals ``own`` (f, b, b), which are zero at first.

    Arguments: table of facets, vertices (v, d), sizes (p,) and masses (p, k, k) of the simplices, and room: ``whole``
    and ``coefficients`` (b, b), and ``warp`` (4,).
    """
    k = mass.shape[1]
    for f in range(len(facets.cells)):
        first, end, b = facets.simplex[f], facets.simplex[f + 1], 0
        for place in range(facets.cells.shape[1]):
            b += facets.cells[f, place] >= 0
        split, area, covered = end - first > 1, 0.0, 0.0
        whole[:b, :b], warp[:] = 0.0, 0.0
        for i in range(first, end):
            area += size[i]
            for a in range(k):
                for c in range(k):
                    covered += mass[i, a, c]
                    add_mass(whole, i - first, a, c, mass[i, a, c], split)
        coverage = covered / area
        if not coverage > LEAST:
            whole[:b, :b] = 0.0
        elif split and coverage < 1.0:
            warping_of(points, facets.cells[f], warp)
        dual_functions(whole, b, coverage, warp, coefficients, own[f])
        for i in range(first, end):
            for j in range(b):
                for a in range(k):
                    values[i, j, a] = at_corner(coefficients, j, i - first, a, split)


@uncounted
def add_mass(whole, piece, a, c, amount, split):
    """Add the integral of two coordinates of a simplex to those (b, b) of the shape functions of the facet."""
    if not split:
        whole[a, c] += amount
        return
    for i in range(4):
        one = shape(i, piece, a, split)
        if one != 0.0:
            for j in range(4):
                whole[i, j] += one * shape(j, piece, c, split) * amount


@uncounted
def shape(node, piece, corner, split):
    """Shape function of a facet at a corner of one of its simplices; the corners of those of a four-node facet are the
    node ``piece``, the next one and the middle.
    """
    if not split:
        return 1.0 if node == corner else 0.0
    if corner == 2:
        return QUARTER
    return 1.0 if node == (piece + corner) % 4 else 0.0


@uncounted
def at_corner(coefficients, function, piece, corner, split):
    """Value, at a corner of a simplex, of a function with ``coefficients`` (b, b) of the shape functions."""
    if not split:
        return coefficients[function, corner]
    value = 0.0
    for node in range(4):
        value += coefficients[function, node] * shape(node, piece, corner, split)
    return value


@uncounted_kernel
def sum_masses(slave, own, out):
    """Add the integrals ``own`` (s, k, k) of pairs to those (p, k, k) of their slave simplices (s,)."""
    for s in range(len(slave)):
        for a in range(own.shape[1]):
            for c in range(own.shape[1]):
                out[slave[s], a, c] += own[s, a, c]
