"""Lengths of the edges that new cells should have."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from softway.adaptivity.rezoning.rim import lengths_along, turns
from softway.adaptivity.unrelated.fields import interpolation, simplices
from softway.arrays import Array, IntArray
from softway.meshes.mesh import Mesh

GROWTH = 0.4
"""Greatest growth of the length of the edges per distance."""
BEND = 0.6
"""Greatest length of a side over the radius of curvature of the boundary."""
LAYERS = 1.5
"""Least number of edges across a thin part."""
FINEST = 3.0
"""Factor by which thin and bent parts may make edges shorter."""
OPPOSITE, INWARD = -0.3, -0.7
"""Cosines between two normals, and between a normal and the way across, of opposite sides of a thin part."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SizeField:
    """Length of the edges in a body.

    Parameters
    ----------
    blocks, places, sizes
        Cells, places (n, d) of their nodes, and the lengths (n,) asked for there [m].
    points, limits
        Points (b, d) of the boundary, and the lengths (b,) there, from which those inside grow [m].
    """

    blocks: Mapping[str, IntArray]
    places: Array
    sizes: Array
    points: Array
    limits: Array

    def at(self, points: Array) -> Array:
        """Lengths (m,) at points (m, d) inside [m].

        Examples
        --------
        >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
        >>> field = SizeField(blocks={"quad4": np.array([[0, 1, 2, 3]])}, places=square, sizes=np.full(4, 0.5),
        ...                   points=square, limits=np.full(4, 0.25))
        >>> field.at(np.array([[0.5, 0.0], [0.5, 0.5]])).round(3).tolist()
        [0.45, 0.5]
        """
        if not len(points):
            return np.zeros(0)
        asked = np.asarray(interpolation(self.blocks, self.places, points) @ self.sizes)
        asked = np.clip(asked, self.sizes.min(), self.sizes.max())
        away = np.linalg.norm(points[:, None] - self.points[None], axis=2)
        return np.asarray(np.minimum(asked, (self.limits + GROWTH * away).min(axis=1)))


def edge_lengths(mesh: Mesh) -> Array:
    """Length (n,) of the edges of regular triangles or tetrahedra of the mean size of the cells at each node [m].

    Examples
    --------
    >>> from softway.meshes.generators.shapes import rectangle
    >>> length = edge_lengths(rectangle((1.0, 1.0), cells=(2, 2), cell="tri3"))
    >>> bool(abs(0.25 * 3.0**0.5 * length**2 - 0.125).max() < 1e-15)
    True
    """
    d = mesh.cell_dim
    total, count = np.zeros(mesh.n_nodes), np.zeros(mesh.n_nodes)
    for cell, cells in mesh.blocks.items():
        corners = mesh.points[simplices({cell: cells})]
        share = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])).reshape(len(cells), -1)
        np.add.at(total, cells, share.mean(axis=1)[:, None])
        np.add.at(count, cells, 1.0)
    regular = np.sqrt(0.75) if d == 2 else np.sqrt(0.5)
    return np.asarray((total / count / regular) ** (1.0 / d))


def rim_sizes(rings: list[Array], asked: list[Array], kink: float) -> list[Array]:
    """Lengths (k,) of the sides along closed polygons (k, 2): those asked for, shorter where the boundary is bent or
    the body thin, with limited growth.

    Parameters
    ----------
    rings
        Polygons with the body to the left.
    asked
        Lengths asked for at their corners [m].
    kink
        Turn above which a corner is one of the body, not of a bent boundary [degrees].
    """
    points, wanted = np.concatenate(rings), np.concatenate(asked)
    least = wanted / FINEST
    across = LAYERS * np.ones(len(points))
    found = np.minimum(wanted, np.maximum(np.concatenate([_bend(ring, kink) for ring in rings]), least))
    normal = np.concatenate([_normals(ring) for ring in rings])
    way = points[None] - points[:, None]
    apart = np.linalg.norm(way, axis=2)
    facing = np.einsum("ijd,id->ij", way, normal) < INWARD * apart
    facing &= (np.einsum("ijd,jd->ij", way, normal) > -INWARD * apart) & (normal @ normal.T < OPPOSITE)
    thickness = np.where(facing, apart, np.inf).min(axis=1)
    found = np.minimum(found, np.maximum(thickness / across, least))
    found = (found[None] + GROWTH * apart).min(axis=1)
    return np.split(found, np.cumsum([len(ring) for ring in rings])[:-1])


def _normals(ring: Array) -> Array:
    """Unit outward normals (k, 2) at the corners of a closed polygon."""
    along = np.roll(ring, -1, axis=0) - np.roll(ring, 1, axis=0)
    outward = np.stack([along[:, 1], -along[:, 0]], axis=1)
    return np.asarray(outward / np.maximum(np.linalg.norm(outward, axis=1), np.finfo(float).tiny)[:, None])


def _bend(ring: Array, kink: float) -> Array:
    """Greatest length (k,) of sides by the curvature at each corner; infinite at corners of the body."""
    turn = np.radians(np.abs(turns(ring)))
    sides = np.diff(lengths_along(np.vstack([ring, ring[:1]])))
    radius = 0.5 * (sides + np.roll(sides, 1)) / np.maximum(turn, 1e-3)
    return np.where(turn < np.radians(kink), BEND * radius, np.inf)
