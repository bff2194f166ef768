"""NumPy reference: conditions on pairs of simplices that may touch in a slab, all of them at once."""

import numpy as np

from softway.arrays import Array, IntArray
from softway.contact.mortar.facet_pairs import ANGLE, DEEP, FEW, unit, vector_areas
from softway.contact.surfaces.wall_thickness import admissible_depth


def facing_pairs(
    slave: tuple[Array, Array],
    master: tuple[Array, Array],
    near: tuple[IntArray, IntArray],
    reach: float,
    thickness: tuple[Array | float, Array | float],
) -> tuple[IntArray, IntArray, Array]:
    """Pairs (s,), (s,) of the ``near`` ones that may touch, and their limits (s,) [m]; arguments as of facet_pairs."""
    i, j = near
    own, other = (unit(vector_areas(corners[0])) for corners in (slave, master))
    opposite = np.einsum("ds,ds->s", np.take(own, i, axis=1), np.take(other, j, axis=1)) <= ANGLE
    i, j = i[opposite], j[opposite]
    size = np.maximum(_sizes(slave[0])[i], _sizes(master[0])[j])
    start, end = (_heights(below, above, i, j) for below, above in zip(slave, master, strict=True))
    walls = [np.broadcast_to(t, c[0].shape[2])[k] for t, c, k in zip(thickness, (slave, master), (i, j), strict=True)]
    depth = admissible_depth(DEEP * size, walls[0] + walls[1])
    between = _height_between(slave[0], master[0], unit(np.take(own, i, axis=1) - np.take(other, j, axis=1)), i, j)
    overlap = -np.where(depth < DEEP * size, start[1], np.maximum(start[1], between))
    kept = (overlap <= depth) & (np.minimum(start[0], end[0]) <= reach)
    i, j, size = i[kept], j[kept], size[kept]
    motion = _centre_motion(slave)[:, i] - _centre_motion(master)[:, j]
    return i, j, FEW * size + reach + np.sqrt(np.sum(motion**2, axis=0))


def _heights(slave: Array, master: Array, i: IntArray, j: IntArray) -> tuple[Array, Array]:
    """Least and greatest height (s,) of the master corners above the slave corners, along the slave normals."""
    normal = unit(vector_areas(slave))
    base = np.sum(normal[:, None] * slave, axis=0)
    over = np.einsum("ds,dks->ks", np.take(normal, i, axis=1), np.take(master, j, axis=2))
    return over.min(axis=0) - base.max(axis=0)[i], over.max(axis=0) - base.min(axis=0)[i]


def _height_between(slave: Array, master: Array, direction: Array, i: IntArray, j: IntArray) -> Array:
    """Height (s,) of the highest corner of the masters above the lowest one of the slaves, along directions (d, s)."""
    low = np.einsum("ds,dks->ks", direction, np.take(slave, i, axis=2)).min(axis=0)
    return np.asarray(np.einsum("ds,dks->ks", direction, np.take(master, j, axis=2)).max(axis=0) - low)


def _sizes(corners: Array) -> Array:
    """Longest edge (p,)."""
    return np.asarray(np.sqrt(np.sum((corners - np.roll(corners, 1, axis=1)) ** 2, axis=0)).max(axis=0))


def _centre_motion(corners: tuple[Array, Array]) -> Array:
    """Displacement (d, p) of the centres."""
    return np.asarray((corners[1] - corners[0]).mean(axis=1))
