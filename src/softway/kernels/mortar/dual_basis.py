"""Dual shape functions of linear facets that may be partly covered (``contact/mortar/dual_basis.py``)."""

from softway.kernels.jit.compilation import uncounted, uncounted_kernel

DUAL, MEAN = 0.999, 0.5
"""Covered fractions above which the basis is dual, and below which it is the shape functions; mixed in between: a dual
function on a partly covered facet extrapolates, and would detect overlap where curved surfaces separate."""
ROUND = 0.2
"""Last part of the way from dual functions to shape functions, which is round: a row may have its least distance at a
kink, and the iterates would alternate between its sides."""
STIFF = 1e-6
"""Penalty of warping, relative to the mass: a partly covered four-node facet does not determine it."""


@uncounted_kernel
def dual_bases(mass, coverage, warp, coefficients, own):
    """Write the bases (f, b, b) of facets, see :func:`~softway.contact.mortar.dual_basis.dual_basis`; ``warp`` (f, b)
    is zero for facets that cannot be warped.
    """
    for f in range(len(mass)):
        dual_functions(mass[f], len(warp[f]), coverage[f], warp[f], coefficients[f], own[f])


@uncounted
def mean_part(coverage):
    """Part of the shape functions in the basis of a facet of which this fraction is covered: from zero to one, linear
    but for the last ``ROUND`` of the way, which ends flat.
    """
    way = (DUAL - coverage) / (DUAL - MEAN)
    slope = 1.0 / (1.0 - 0.5 * ROUND)
    if way <= 0.0 or way >= 1.0:
        return 0.0 if way <= 0.0 else 1.0
    left = 1.0 - way
    return slope * way if left >= ROUND else 1.0 - 0.5 * slope * left * left / ROUND


@uncounted
def mean_change(coverage):
    """Derivative of the part of the shape functions with respect to the covered fraction."""
    way = (DUAL - coverage) / (DUAL - MEAN)
    if way <= 0.0 or way >= 1.0:
        return 0.0
    return -min(1.0, (1.0 - way) / ROUND) / ((1.0 - 0.5 * ROUND) * (DUAL - MEAN))


@uncounted
def dual_functions(mass, b, coverage, warp, coefficients, own):
    """Write the coefficients and integrals (b, b) of one facet."""
    mean, whole = mean_part(coverage), 0.0
    for i in range(b):
        for j in range(b):
            whole += mass[i, j]
    penalty = stiffness_of_warping(whole, coverage)
    for i in range(b):
        total = 0.0
        for j in range(b):
            total += mass[i, j]
            lifted = mass[i, j] + (penalty * warp[i] * warp[j] if penalty > 0.0 else 0.0)
            coefficients[i, j] = lifted if mean < 1.0 else 0.0
            own[i, j] = mean * mass[i, j]
        own[i, i] += (1.0 - mean) * total
    if mean < 1.0:
        invert(coefficients, b)
    for i in range(b):
        total = 0.0
        for j in range(b):
            total += mass[i, j]
        for j in range(b):
            coefficients[i, j] *= (1.0 - mean) * total
        coefficients[i, i] += mean


@uncounted
def stiffness_of_warping(mass, coverage):
    """Penalty of warping of a facet with the covered ``mass``."""
    return STIFF * mass * max(1.0 - coverage, 0.0)


@uncounted
def warping_change(own, coverage):
    """Change of this penalty as the covered mass grows by ``own``."""
    return STIFF * own * (1.0 - 2.0 * coverage) if coverage < 1.0 else 0.0


@uncounted
def invert(a, b):
    """Replace a positive definite matrix (b, b) by its inverse (Gauss and Jordan)."""
    for p in range(b):
        pivot = 1.0 / a[p, p]
        a[p, p] = 1.0
        for j in range(b):
            a[p, j] *= pivot
        for i in range(b):
            if i != p:
                part = a[i, p]
                a[i, p] = 0.0
                for j in range(b):
                    a[i, j] -= part * a[p, j]


@uncounted_kernel
def warped(points, cells, out):
    """Write the warping (f, 4) of the facets ``cells`` (f, 4), see :func:`warping_of`."""
    for f in range(len(cells)):
        warping_of(points, cells[f], out[f])


@uncounted
def warping_of(points, corner, out):
    """Write the nodal values (4,) of the function on a four-node facet that is orthogonal to every linear one."""
    a, b, c, d = corner[0], corner[1], corner[2], corner[3]
    square = 0.0
    for node in range(4):
        out[node] = 0.0
    for x in range(3):
        y, z = (x + 1) % 3, (x + 2) % 3
        first = (points[c, y] - points[a, y]) * (points[d, z] - points[b, z])
        normal = first - (points[c, z] - points[a, z]) * (points[d, y] - points[b, y])
        square += normal * normal
        for node in range(4):  # twice the triangle at the opposite corner, along the normal
            here, after, before = corner[(node + 2) % 4], corner[(node + 3) % 4], corner[(node + 1) % 4]
            turn = (points[after, y] - points[here, y]) * (points[before, z] - points[here, z])
            turn -= (points[after, z] - points[here, z]) * (points[before, y] - points[here, y])
            out[node] += normal * turn if node % 2 == 0 else -normal * turn
    for node in range(4):
        out[node] /= square
