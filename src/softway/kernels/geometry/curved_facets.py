"""Polynomial curves and surface patches: monomials, and closest points in a compiled loop.

A facet is a polynomial in its local coordinates, ``X(xi) = sum_m A_m prod_j xi_j^powers[m, j]`` with powers up to two.
The foot of a point x on the facet satisfies ``(x - X) . dX/dxi_j = 0``.  It is found by Newton's method.  Where the
second derivatives would make the Hessian nearly singular or indefinite, they are left out (Gauss-Newton method).

The last axis of every array in this module runs over the points of the batch.
"""

from math import perm

import numpy as np

from softway.arrays import Array, IntArray
from softway.kernels.jit.compilation import uncounted, uncounted_kernel

ITERATIONS = 30
"""Greatest number of iterations; a foot that still moves then is accepted."""
STEP = 0.5
"""Greatest step in a local coordinate, for facets that are not linear."""
STILL = 1e-9
"""Step in the local coordinates below which a foot has converged; its error is of the order of the step squared."""

Term = tuple[float, Array | None]


def monomials(local: Array, powers: IntArray, derivative: tuple[int, ...]) -> list[Term]:
    """Monomials of the local coordinates, or their derivatives, each as a pair of a factor and values (None for ones).

    Parameters
    ----------
    local
        (r, p) local coordinates.
    powers
        (b, r) exponents 0, 1 or 2.
    derivative
        Order of differentiation along each of the r coordinates: 0, 1 or 2.

    Examples
    --------
    >>> monomials(np.array([[0.5]]), np.array([[0], [1], [2]]), (1,))
    [(0.0, None), (1.0, None), (2.0, array([0.5]))]
    """
    return [_monomial(local, exponents, derivative) for exponents in powers.tolist()]


def _monomial(local: Array, exponents: list[int], derivative: tuple[int, ...]) -> Term:
    factor, values = 1.0, None
    for xi, power, order in zip(local, exponents, derivative, strict=True):
        factor *= perm(power, order)
        for _ in range(power - order):
            values = xi if values is None else values * xi
    return factor, values


def feet(x: Array, powers: IntArray, terms: Array, start: Array, low: float, high: float) -> Array:
    """Local coordinates (r, p) of the feet of points on curves (r = 1) or surface patches (r = 2).

    Parameters
    ----------
    x
        (d, p) points [m].
    powers
        (b, r) exponents.
    terms
        (b, d, p) coefficients [m].
    start
        (r, p) local coordinates at the start of the iteration.
    low, high
        Bounds of every local coordinate; a foot stops there.

    Examples
    --------
    The parabola (t, t^2) from a point on its axis below the centre of curvature, and the line (t, 0):

    >>> terms = np.zeros((3, 2, 2))
    >>> terms[1, 0], terms[2, 1, 0] = 1.0, 1.0
    >>> x = np.array([[0.0, 0.7], [0.4, 3.0]])
    >>> feet(x, np.array([[0], [1], [2]]), terms, np.full((1, 2), 0.2), -1.0, 2.0).round(12).tolist()
    [[0.0, 0.7]]
    """
    limit = STEP if powers.sum(axis=1).max() > 1 else np.inf
    out = np.clip(start, low, high)
    _find(np.ascontiguousarray(x), powers, terms, out, low, high, limit, np.empty((6, len(x))))
    return out


@uncounted_kernel
def _find(x, powers, terms, local, low, high, limit, work):
    """Move the local coordinates (r, p) of all points to their feet.

    ``work`` (6, d) holds the vector from the foot to the point, the tangents u and v, and the second derivatives uu, uv
    and vv.
    """
    for p in range(x.shape[1]):
        for _ in range(ITERATIONS):
            _derivatives(x, powers, terms, local, p, work)
            if powers.shape[1] == 1:
                first, second = _line_step(work), 0.0
            else:
                first, second = _sheet_step(work)
            scale = min(1.0, limit / max(abs(first), abs(second), STEP))
            way = _moved(local, 0, p, first * scale, low, high)
            if powers.shape[1] == 2:
                way = max(way, _moved(local, 1, p, second * scale, low, high))
            if not way > STILL:
                break


@uncounted
def _moved(local, j, p, step, low, high):
    """Move one local coordinate of a point within the bounds; returns the distance."""
    before = local[j, p]
    after = before + step
    if after < low:
        after = low
    if after > high:
        after = high
    local[j, p] = after
    return abs(after - before)


@uncounted
def _derivatives(x, powers, terms, local, p, work):
    """Write the vector from the point of a facet to x, its tangents, and its second derivatives."""
    sheet = powers.shape[1] == 2
    for i in range(len(x)):
        work[0, i] = x[i, p]
        for row in range(1, 6):
            work[row, i] = 0.0
    for m in range(len(powers)):
        e, f = _powers(local[0, p], powers[m, 0]), (1.0, 0.0, 0.0)
        if sheet:
            f = _powers(local[1, p], powers[m, 1])
        for i in range(len(x)):
            term = terms[m, i, p]
            work[0, i] -= e[0] * f[0] * term
            work[1, i] += e[1] * f[0] * term
            work[2, i] += e[0] * f[1] * term
            work[3, i] += e[2] * f[0] * term
            work[4, i] += e[1] * f[1] * term
            work[5, i] += e[0] * f[2] * term


@uncounted
def _powers(xi, exponent):
    """Power 0, 1 or 2 of a local coordinate with its derivatives."""
    if exponent == 0:
        return 1.0, 0.0, 0.0
    if exponent == 1:
        return xi, 1.0, 0.0
    return xi * xi, 2.0 * xi, 2.0


@uncounted
def _times(work, a, b):
    """Product of two of the vectors."""
    out = 0.0
    for i in range(work.shape[1]):
        out += work[a, i] * work[b, i]
    return out


@uncounted
def _line_step(work):
    """Newton step on a curve."""
    metric = _times(work, 1, 1)
    slope = metric - _times(work, 0, 3)
    if not slope > 0.1 * metric:
        slope = metric
    return _times(work, 0, 1) / slope


@uncounted
def _sheet_step(work):
    """Newton step on a surface patch."""
    uu, uv, vv = _times(work, 1, 1), _times(work, 1, 2), _times(work, 2, 2)
    a, b, c = uu - _times(work, 0, 3), uv - _times(work, 0, 4), vv - _times(work, 0, 5)
    if not (a > 0.0 and a * c - b * b > 0.1 * (uu * vv - uv * uv)):
        a, b, c = uu, uv, vv
    f, g, det = _times(work, 0, 1), _times(work, 0, 2), a * c - b * b
    return (c * f - b * g) / det, (a * g - b * f) / det
