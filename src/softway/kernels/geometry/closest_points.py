"""Closest points on segments and triangles, batched: one facet for each point."""

import numpy as np

from softway.arrays import Array


def on_segments(x: Array, a: Array, b: Array) -> Array:
    """Barycentric coordinates (p, 2) of the closest points on segments.

    Parameters
    ----------
    x
        (p, d) points [m].
    a, b
        (p, d) ends of the segments [m]; a segment of zero length is treated as its first end.

    Examples
    --------
    >>> x = np.array([[0.5, 1.0], [3.0, 1.0]])
    >>> on_segments(x, np.zeros((2, 2)), np.array([[2.0, 0.0], [2.0, 0.0]])).tolist()
    [[0.75, 0.25], [0.0, 1.0]]
    """
    along = b - a
    length2 = dot(along, along)
    t = np.clip(dot(x - a, along) / np.where(length2 > 0.0, length2, 1.0), 0.0, 1.0)
    return np.stack([1.0 - t, t], axis=-1)


def on_triangles(x: Array, a: Array, b: Array, c: Array) -> Array:
    """Barycentric coordinates (p, 3) of the closest points on triangles.

    The signs of barycentric coordinates distinguish the Voronoi regions of the corners, the edges and the interior
    (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).

    Parameters
    ----------
    x
        (p, d) points [m], d = 2 or 3.
    a, b, c
        (p, d) corners [m].

    Examples
    --------
    >>> corners = np.eye(3)[:, None, :]
    >>> on_triangles(np.array([[0.5, 0.5, -3.0]]), *corners).tolist()
    [[0.5, 0.5, 0.0]]
    """
    ab, ac, ax = b - a, c - a, x - a
    bb, bc, cc = dot(ab, ab), dot(ab, ac), dot(ac, ac)
    d1, d2 = dot(ab, ax), dot(ac, ax)
    d3, d4 = d1 - bb, d2 - bc  # the same products from corner b
    d5, d6 = d1 - bc, d2 - cc  # and from corner c
    weights = np.stack([d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2], axis=-1)  # of a, b, c, not scaled
    total = bb * cc - bc * bc
    flat = np.where(total > 0.0, total, 1.0)
    out = weights / flat[:, None]
    zero = np.zeros_like(d1)
    with np.errstate(divide="ignore", invalid="ignore"):
        on_ab, on_ac, on_bc = d1 / bb, d2 / cc, (d4 - d3) / ((d4 - d3) + (d5 - d6))
    places = (
        ((weights[:, 0] <= 0.0) & (d4 >= d3) & (d5 >= d6), (zero, 1.0 - on_bc, on_bc)),
        ((weights[:, 1] <= 0.0) & (d2 >= 0.0) & (d6 <= 0.0), (1.0 - on_ac, zero, on_ac)),
        ((weights[:, 2] <= 0.0) & (d1 >= 0.0) & (d3 <= 0.0), (1.0 - on_ab, on_ab, zero)),
        ((d6 >= 0.0) & (d5 <= d6), (zero, zero, zero + 1.0)),
        ((d3 >= 0.0) & (d4 <= d3), (zero, zero + 1.0, zero)),
        ((d1 <= 0.0) & (d2 <= 0.0), (zero + 1.0, zero, zero)),
    )
    for here, values in places:  # corners come last: they override edges, which override the interior
        for column, value in enumerate(values):
            np.copyto(out[:, column], value, where=here)
    return out


def dot(u: Array, v: Array) -> Array:
    """Scalar products (p,) of vectors (p, d)."""
    return np.asarray(np.einsum("pi,pi->p", u, v))
