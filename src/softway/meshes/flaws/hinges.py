"""Nodes and edges at which the cells of a mesh meet without sharing a facet."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from softway.arrays import IntArray
from softway.meshes.cells import CELLS
from softway.meshes.mesh import Mesh
from softway.meshes.topology import repeated


def hinges(mesh: Mesh) -> IntArray:
    """Sorted boundary nodes (k,) at which the boundary touches itself, in the plane or in space.

    Around any other node the boundary facets form one fan, and any other edge belongs to two of them.

    Examples
    --------
    Two triangles that share one corner:

    >>> points = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    >>> hinges(Mesh(points=points, blocks={"tri3": np.array([[0, 1, 2], [0, 3, 4]])})).tolist()
    [0]
    """
    corners = [facets[:, : CELLS[kind].corners] for kind, facets in mesh.boundary().items()]
    if mesh.dim == 2:
        count = np.bincount(np.concatenate([c.ravel() for c in corners]), minlength=mesh.n_nodes)
        return np.flatnonzero(count > 2)
    ends, slot = _edges(corners)
    node = np.concatenate([c.ravel() for c in corners])
    order = np.lexsort((ends[:, 0], ends[:, 1]))
    pair = np.flatnonzero((ends[order[1:]] == ends[order[:-1]]).all(axis=1))
    one, two = slot[order[pair]], slot[order[pair + 1]]
    links = coo_array((np.ones(2 * len(pair), dtype=bool), (one.ravel(), two.ravel())), shape=(len(node), len(node)))
    fan = connected_components(links, directed=False)[1]
    fans = np.bincount(node[np.unique(fan, return_index=True)[1]], minlength=mesh.n_nodes)
    shared = [ends[rows[0]] for rows in repeated(ends, least=3)]
    return np.unique(np.concatenate([np.flatnonzero(fans > 1), *shared]))


def _edges(corners: list[IntArray]) -> tuple[IntArray, IntArray]:
    """Sorted ends (e, 2) of the edges of all facets, and the places (e, 2) of the ends among all corners of facets."""
    ends, slot, first = [], [], 0
    for nodes in corners:
        after = np.roll(nodes, -1, axis=1)
        place = first + np.arange(nodes.size).reshape(nodes.shape)
        pairs = np.stack([nodes.ravel(), after.ravel()], axis=1)
        places = np.stack([place.ravel(), np.roll(place, -1, axis=1).ravel()], axis=1)
        turned = pairs[:, 0] > pairs[:, 1]
        pairs[turned], places[turned] = pairs[turned, ::-1], places[turned, ::-1]
        ends.append(pairs)
        slot.append(places)
        first += nodes.size
    return np.concatenate(ends), np.concatenate(slot)
