"""Middles of curved edges from the directions at their ends, exact on circles, spheres and cylinders
(docs/theory/bodies/adaptive.md#curved-boundaries).

Directions that are no numbers are unknown: the edge is then an arc with the known one at the other end.
"""

import numpy as np

from softway.arrays import Array

FLAT = 0.3
"""Cosine of half the angle between the directions at the ends of an edge below which it is left straight."""


def over_normals(ends: Array, normals: Array) -> tuple[Array, Array]:
    """Middles (k, d) of edges between ``ends`` (k, 2, d) in a surface with ``normals`` (k, 2, d), and normals there.

    Examples
    --------
    >>> right = np.array([[[1.0, 0.0], [0.0, 1.0]]])
    >>> [found.round(12).tolist() for found in over_normals(right, right)]
    [[[0.707106781187, 0.707106781187]], [[0.707106781187, 0.707106781187]]]
    """
    e = _direction(ends)
    along = _dot(normals, e[:, None])[..., None]
    normals = _filled(normals, (normals - 2.0 * along * e[:, None])[:, ::-1])
    along = _dot(normals, e[:, None])[..., None]
    both = normals.sum(axis=1)
    cosine = 0.5 * np.linalg.norm(both, axis=1)  # of half the angle between the normals
    known = cosine > FLAT  # not so for what is no number
    cosine = np.where(known, cosine, 1.0)
    size = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / (4.0 * cosine * (1.0 + cosine))
    way = along[:, 1] * normals[:, 1] - along[:, 0] * normals[:, 0]
    middles = ends.mean(axis=1) + np.where(known[:, None], size[:, None] * way, 0.0)
    return middles, _unit(both - 1.5 * _dot(both, e)[:, None] * e)


def over_tangents(ends: Array, tangents: Array) -> tuple[Array, Array]:
    """Middles (k, d) of edges between ``ends`` (k, 2, d) with ``tangents`` (k, 2, d) of any sign, and tangents there.

    Examples
    --------
    >>> found = over_tangents(np.array([[[1.0, 0.0], [0.0, 1.0]]]), np.array([[[0.0, 1.0], [-1.0, 0.0]]]))
    >>> [part.round(12).tolist() for part in found]
    [[[0.707106781187, 0.707106781187]], [[-0.707106781187, 0.707106781187]]]
    """
    e = _direction(ends)
    tangents = tangents * np.where(_dot(tangents, e[:, None]) < 0.0, -1.0, 1.0)[..., None]
    tangents = _filled(tangents, (2.0 * _dot(tangents, e[:, None])[..., None] * e[:, None] - tangents)[:, ::-1])
    cosine = _dot(tangents, e[:, None]).mean(axis=1)
    known = cosine > FLAT  # not so for what is no number
    size = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / (4.0 * (1.0 + np.where(known, cosine, 1.0)))
    bulge = np.where(known[:, None], size[:, None] * (tangents[:, 0] - tangents[:, 1]), 0.0)
    return ends.mean(axis=1) + bulge, _unit(1.5 * e - 0.25 * tangents.sum(axis=1))


def _direction(ends: Array) -> Array:
    return _unit(ends[:, 1] - ends[:, 0])


def _unit(vectors: Array) -> Array:
    """Unit vectors (..., d)."""
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))


def _dot(one: Array, other: Array) -> Array:
    return np.asarray((one * other).sum(axis=-1))


def _filled(values: Array, others: Array) -> Array:
    """Values, and others where they are no numbers."""
    return np.where(np.isnan(values), others, values)
