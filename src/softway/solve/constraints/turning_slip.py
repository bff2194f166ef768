"""Direction of friction at the end of a slab (time step) whose slip turns.

The slip of a slab is a chord; its direction d belongs to the middle of the slab.  The force at the end is along

    -e,    e = (d + r (d - d_before)) / |d + r (d - d_before)|,

extrapolated with the direction of the slip of the slab before (docs/theory/contact/friction.md).  d -> e is a
bijection of the directions, so it extends to forces of any size: the *chord force* has the same size, along -d.
In all functions ``turning`` (m, k) is ``r d_before``, zero for rows that keep their direction; None if all do.
"""

import numpy as np

from softway.arrays import Array


def chord_force(turning: Array | None, force: Array) -> Array:
    """Forces (m, k) along the slip of the slab, from forces (m, k) along the slip at its end.

    Examples
    --------
    The slip has turned from the first direction to the second: at the end it has turned further.

    >>> turning, chord = np.array([[0.5, 0.0]]), np.array([[0.0, -2.0]])
    >>> end_force(turning, chord).round(6).tolist()
    [[0.632456, -1.897367]]
    >>> chord_force(turning, end_force(turning, chord)).round(12).tolist() == chord.tolist()
    True
    """
    if turning is None:
        return force
    size, _, along, root, reach = _parts(turning, force)
    return ((along + root)[:, None] * force - size[:, None] * turning) / reach[:, None]


def end_force(turning: Array | None, force: Array) -> Array:
    """Forces (m, k) along the slip at the end of the slab, from forces (m, k) along its chord."""
    if turning is None:
        return force
    size, _, _, _, reach = _parts(turning, force)
    out = reach[:, None] * force + size[:, None] * turning
    return (size / np.maximum(np.linalg.norm(out, axis=1), 1e-300))[:, None] * out


def chord_slope(turning: Array | None, force: Array) -> Array | None:
    """Derivatives (m, k, k) of the chord forces with respect to the forces (m, k) at the end; one without a force."""
    if turning is None:
        return None
    size, way, along, root, reach = _parts(turning, force)
    sideways = (1.0 + along / root)[:, None] * (turning - along[:, None] * way)
    unit = np.eye(force.shape[1])
    out = (along + root)[:, None, None] * unit + way[:, :, None] * sideways[:, None, :]
    out -= turning[:, :, None] * way[:, None, :]
    return np.where((size > 0.0)[:, None, None], out / reach[:, None, None], unit)


def _parts(turning: Array, force: Array) -> tuple[Array, Array, Array, Array, Array]:
    """Sizes (m,) and directions (m, k) of forces, their component along ``turning``, its root in the inverse, 1 + r."""
    size, ratio = np.linalg.norm(force, axis=1), np.linalg.norm(turning, axis=1)
    way = force / np.maximum(size, 1e-300)[:, None]
    along = np.einsum("mk,mk->m", way, turning)
    return size, way, along, np.sqrt(along**2 + 1.0 + 2.0 * ratio), 1.0 + ratio
