"""Nodes on flat parts of the boundary of a mesh in space, which slide without a change of the shape."""

from collections.abc import Mapping, Sequence

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.meshes.cells import CELLS
from softway.meshes.mesh import Mesh

FLAT = 1e-9
"""Distance of a node from a plane, relative to the size of the mesh, within which it is on the plane."""
ALIKE = 1e-6
"""Difference of unit normals within which two facets are in one plane."""


def sliding(
    mesh: Mesh, places: Array, kept: BoolArray, common: Sequence[Mapping[str, IntArray]] = ()
) -> tuple[IntArray, Array]:
    """Corners (k,) of cells on the boundary that slide, and the projections (k, 3, 3) onto the directions in which they
    do.

    A node slides in a plane if all its facets are in this plane and in the same tags; along a straight edge if they are
    in two planes, and in the tags of each.  Other nodes stay.

    Parameters
    ----------
    mesh
        Mesh in space.
    places
        (n, 3) places of its nodes [m].
    kept
        (n,) nodes that stay.
    common
        Facets of the common boundaries of materials, along which nodes slide as well.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import box
    >>> mesh = box((1.0, 1.0, 1.0), cells=(2, 2, 2), cell="hex8")
    >>> nodes, ways = sliding(mesh, mesh.points, np.zeros(27, dtype=bool))
    >>> len(nodes), sorted({round(float(np.trace(way))) for way in ways})
    (18, [1, 2])
    """
    found: list[int] = []
    ways: list[Array] = []
    near, own = FLAT * float(np.ptp(places, axis=0).max()), _facets_of_corners((mesh.boundary(), *common))
    tags = np.array([np.isin(np.arange(len(places)), nodes) for tag, nodes in mesh.tags.items() if tag != "surface"])
    tags = tags.reshape(-1, len(places))
    for node, facets in own.items():
        way = None if kept[node] else _way(node, facets, places, tags, near)
        if way is not None:
            found.append(node)
            ways.append(way)
    return np.array(found, dtype=np.int64), np.array(ways).reshape(-1, 3, 3)


def _facets_of_corners(sheets: Sequence[Mapping[str, IntArray]]) -> dict[int, list[tuple[IntArray, int]]]:
    """Facets of each corner on the boundary with the number of their corners, in ascending order of the nodes."""
    found: dict[int, list[tuple[IntArray, int]]] = {}
    for sheet in sheets:
        for name, facets in sheet.items():
            corners = CELLS[name].corners
            for facet in facets:
                for node in facet[:corners].tolist():
                    found.setdefault(node, []).append((facet, corners))
    return dict(sorted(found.items()))


def _way(node: int, facets: list[tuple[IntArray, int]], places: Array, tags: BoolArray, near: float) -> Array | None:
    """Projection (3, 3) onto the directions in which a node slides; None if it stays."""
    planes: list[tuple[Array, BoolArray]] = []
    for facet, corners in facets:
        x = places[facet] - places[node]
        normal = np.cross(x[2] - x[0], x[corners - 1] - x[1])
        length = float(np.linalg.norm(normal))
        inside = np.asarray(tags[:, facet].all(axis=1))
        if not length or (np.abs(x @ normal) > near * length).any():
            return None
        normal = normal / length
        same = [other for one, other in planes if np.abs(one - normal).max() < ALIKE]
        if not same:
            planes.append((normal, inside))
        elif not np.array_equal(same[0], inside):
            return None
    named = np.logical_or.reduce([inside for _, inside in planes])
    if len(planes) > 2 or not np.array_equal(named, tags[:, node]):
        return None
    if len(planes) == 1:
        return np.asarray(np.eye(3) - np.outer(planes[0][0], planes[0][0]))
    along = np.cross(planes[0][0], planes[1][0])
    return np.asarray(np.outer(along, along) / (along @ along)) if along.any() else None
