"""NumPy reference: clipping of convex polygons, batched: each polygon is cut by one linear function."""

import numpy as np

from softway.arrays import Array, IntArray


def clip(values: Array, distance: Array, count: IntArray) -> tuple[Array, IntArray]:
    """Clip convex polygons to the part where a distance is not negative.

    The corners carry the values of linear functions, such as coordinates.  Values at new corners are interpolated
    along the edge (Sutherland and Hodgman, 1974).

    Parameters
    ----------
    values
        (c, v, p) values at the corners; a polygon uses the first ``count`` corners.
    distance
        (v, p) distance at the corners, linear on each polygon.
    count
        (p,) number of corners, at most v.

    Returns
    -------
    values, count
        Arrays (c, w, p) and (p,) with the greatest count w; the count is zero where nothing is left.  A polygon gains
        at most one corner, or more where rounding bends an edge that lies on the cut.

    Examples
    --------
    >>> square = np.array([[-1.0, 1.0, 1.0, -1.0], [-1.0, -1.0, 1.0, 1.0]])[:, :, None]
    >>> values, count = clip(square, square[0], np.array([4]))
    >>> values[:, : count[0], 0].T.tolist()
    [[0.0, -1.0], [1.0, -1.0], [1.0, 1.0], [0.0, 1.0]]
    """
    c, v, p = values.shape
    used = np.arange(v)[:, None] < count
    following, there = _next(values, count), _next(distance, count)
    crossed = used & ((distance >= 0.0) != (there >= 0.0))
    t = np.where(crossed, distance, 0.0) / np.where(crossed, distance - there, 1.0)
    made = np.stack([values + t * (following - values), following], axis=2).reshape(c, 2 * v, p)
    kept = np.stack([crossed, used & (there >= 0.0)], axis=1).reshape(2 * v, p)
    slot = np.cumsum(kept, axis=0, dtype=np.int64) - 1
    source, polygon = np.nonzero(kept)
    left = slot[-1] + 1
    out = np.zeros((c, int(left.max(initial=1)), p))
    out[:, slot[source, polygon], polygon] = made[:, source, polygon]
    return out, left


def _next(values: Array, count: IntArray) -> Array:
    """Values (..., v, p) at the next corners; the first corner of a polygon follows its last."""
    out = np.roll(values, -1, axis=-2)
    polygon = np.arange(len(count))
    out[..., np.maximum(count, 1) - 1, polygon] = values[..., 0, :]
    return out
