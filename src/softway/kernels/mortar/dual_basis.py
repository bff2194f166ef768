"""Dual shape functions of linear facets that may be partly covered (``contact/mortar/dual_basis.py``)."""

from softway.kernels.jit.compilation import uncounted, uncounted_kernel

DUAL, MEAN = 0.999, 0.5
"""Covered fractions above which the basis is dual, and below which it is the shape functions; mixed in between: a dual
function on a partly covered facet extrapolates, and would detect overlap where curved surfaces separate."""
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
def dual_functions(mass, b, coverage, warp, coefficients, own):
    """Write the coefficients and integrals (b, b) of one facet."""
    mean, whole = min(max((DUAL - coverage) / (DUAL - MEAN), 0.0), 1.0), 0.0
    for i in range(b):
        for j in range(b):
            whole += mass[i, j]
    penalty = STIFF * whole * max(1.0 - coverage, 0.0)
    for i in range(b):
        total = 0.0
        for j in range(b):
            total += mass[i, j]
            lifted = mass[i, j] + (penalty * warp[i] * warp[j] if penalty > 0.0 else 0.0)
            coefficients[i, j] = lifted if mean < 1.0 else 0.0
            own[i, j] = mean * mass[i, j]
        own[i, i] += (1.0 - mean) * total
    if mean < 1.0:
        _invert(coefficients, b)
    for i in range(b):
        total = 0.0
        for j in range(b):
            total += mass[i, j]
        for j in range(b):
            coefficients[i, j] *= (1.0 - mean) * total
        coefficients[i, i] += mean


@uncounted
def _invert(a, b):
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
