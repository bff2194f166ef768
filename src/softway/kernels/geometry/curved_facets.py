"""Polynomial curves and surface patches: points, tangents and closest points, batched.

A facet is a polynomial in its local coordinates, ``X(xi) = sum_m A_m prod_j xi_j^powers[m, j]`` with powers up to two.
The foot of a point x on the facet satisfies ``(x - X) . dX/dxi_j = 0``.  It is found by Newton's method.  Where the
second derivatives would make the Hessian nearly singular or indefinite, they are left out (Gauss-Newton method).

The last axis of every array in this module runs over the points of the batch.
"""

from math import perm

import numpy as np

from softway.arrays import Array, IntArray

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


def places(local: Array, powers: IntArray, terms: Array, derivative: tuple[int, ...]) -> Array:
    """Points (d, p) of facets with the coefficients ``terms`` (b, d, p), or their derivatives."""
    out = np.zeros(terms.shape[1:])
    for (factor, values), term in zip(monomials(local, powers, derivative), terms, strict=True):
        if factor:
            out += factor * term if values is None else (factor * values) * term
    return out


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
    step = _line_step if powers.shape[1] == 1 else _sheet_step
    limit = STEP if powers.sum(axis=1).max() > 1 else np.inf
    out = np.clip(start, low, high)
    todo, here = np.arange(x.shape[1]), out
    for _ in range(ITERATIONS):
        move = step(x, powers, terms, here)
        move *= np.minimum(1.0, limit / np.maximum(np.abs(move).max(axis=0), STEP))
        after = np.clip(here + move, low, high)
        moving = np.abs(after - here).max(axis=0) > STILL
        out[:, todo] = here = after
        if not moving.any():
            break
        if 2 * np.count_nonzero(moving) < len(todo):
            todo, here = todo[moving], here[:, moving]
            x, terms = x[:, moving], terms[:, :, moving]
    return out


def _dot(u: Array, v: Array) -> Array:
    return np.asarray(np.einsum("ip,ip->p", u, v))


def _line_step(x: Array, powers: IntArray, terms: Array, local: Array) -> Array:
    """Newton step (1, p) on curves."""
    r = x - places(local, powers, terms, (0,))
    along, bend = places(local, powers, terms, (1,)), places(local, powers, terms, (2,))
    metric = _dot(along, along)
    slope = metric - _dot(r, bend)
    slope = np.where(slope > 0.1 * metric, slope, metric)
    return np.asarray(_dot(r, along) / slope)[None]


def _sheet_step(x: Array, powers: IntArray, terms: Array, local: Array) -> Array:
    """Newton step (2, p) on surface patches."""
    r = x - places(local, powers, terms, (0, 0))
    u, v = places(local, powers, terms, (1, 0)), places(local, powers, terms, (0, 1))
    uu, uv, vv = _dot(u, u), _dot(u, v), _dot(v, v)
    a, b, c = (
        metric - _dot(r, places(local, powers, terms, twice))
        for metric, twice in ((uu, (2, 0)), (uv, (1, 1)), (vv, (0, 2)))
    )
    flat = ~((a > 0.0) & (a * c - b * b > 0.1 * (uu * vv - uv * uv)))
    a, b, c = np.where(flat, uu, a), np.where(flat, uv, b), np.where(flat, vv, c)
    f, g = _dot(r, u), _dot(r, v)
    return np.stack([c * f - b * g, a * g - b * f]) / (a * c - b * b)
