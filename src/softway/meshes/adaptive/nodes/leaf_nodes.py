"""Nodes of the leaves of an adapted mesh: their numbers, and where they lie in the base mesh."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray
from softway.meshes.adaptive.nodes.middles import Middles, edge_codes
from softway.meshes.cells import CELLS
from softway.meshes.mesh import Mesh


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FirstPlaces:
    """Where each new node occurs first.

    Parameters
    ----------
    leaf, local
        (k,) leaf, and node of the leaf.
    """

    leaf: IntArray
    local: IntArray


def leaf_nodes(base: Mesh, corners: IntArray, middles: Middles) -> tuple[IntArray, FirstPlaces]:
    """Nodes (e, a) of leaves with given ``corners`` (e, c), and where the new ones occur first.

    Nodes of the base mesh keep their numbers; new ones follow in the order of the leaves, so that the numbers depend on
    the leaves alone.
    """
    name, rows = next(iter(base.blocks)), corners
    if CELLS[name].order == 2:
        edges = np.array(CELLS[name].edges)
        middles, nodes = middles.with_middles(corners[:, edges].reshape(-1, 2))
        rows = np.concatenate([corners, nodes.reshape(len(corners), len(edges))], axis=1)
        rows = _known_middles(base, middles)[rows]
    return numbered(rows, base.n_nodes)


def _known_middles(base: Mesh, middles: Middles) -> IntArray:
    """Node of the base mesh for each node (n,) that lies in the middle of one of its edges; others for themselves."""
    name, cells = next(iter(base.blocks.items()))
    known = np.arange(middles.count)
    corners, edges = CELLS[name].corners, np.array(CELLS[name].edges)
    code = edge_codes(cells[:, edges]).ravel()
    at = np.minimum(np.searchsorted(middles.codes, code), len(middles.codes) - 1)
    met = middles.codes[at] == code
    known[middles.nodes[at[met]]] = cells[:, corners : corners + len(edges)].ravel()[met]
    return known


def numbered(rows: IntArray, old: int) -> tuple[IntArray, FirstPlaces]:
    """Nodes (e, a) with new numbers, from ``old`` on, in the order in which they occur first, and where they do."""
    found, first, number = np.unique(rows, return_index=True, return_inverse=True)
    fresh = found >= old
    where = np.sort(first[fresh])
    rank = found.copy()
    rank[fresh] = old + np.searchsorted(where, first[fresh])
    places = FirstPlaces(leaf=where // rows.shape[1], local=where % rows.shape[1])
    return rank[number.ravel()].reshape(rows.shape), places


def shape_functions(name: str, place: Array) -> Array:
    """Shape functions (..., a) of a cell at barycentric coordinates (..., c).

    Those of quadrilaterals and hexahedra are their linear shape functions.

    Examples
    --------
    >>> shape_functions("bar3", np.array([0.5, 0.5])).tolist()
    [0.0, 0.0, 1.0]
    """
    if CELLS[name].order == 1:
        return place
    if _square(name):
        at = place @ CELLS[name].nodes[: CELLS[name].corners]
        return np.asarray((at[..., None, :] ** CELLS[name].powers).prod(axis=-1) @ _coefficients(name))
    i, j = np.array(CELLS[name].edges).T
    return np.concatenate([place * (2.0 * place - 1.0), 4.0 * place[..., i] * place[..., j]], axis=-1)


def node_places(name: str, place: Array) -> Array:
    """Barycentric coordinates (..., a, c) of the nodes of cells from those of their corners (..., c, c).

    Examples
    --------
    >>> node_places("bar3", np.eye(2)).tolist()
    [[1.0, 0.0], [0.0, 1.0], [0.5, 0.5]]
    """
    if CELLS[name].order == 1:
        return place
    if _square(name):
        return np.asarray(np.einsum("ac,...cd->...ad", _linear(name), place))
    i, j = np.array(CELLS[name].edges).T
    return np.concatenate([place, (place[..., i, :] + place[..., j, :]) / 2.0], axis=-2)


def _square(name: str) -> bool:
    """True for quadrilaterals and hexahedra."""
    return CELLS[name].dim > 1 and not CELLS[name].simplex


def _coefficients(name: str) -> Array:
    """Coefficients (k, a) of the monomials of the shape functions of a quadrilateral or hexahedron, whole numbers."""
    it = CELLS[name]
    return np.rint(np.linalg.inv((it.nodes[:, None, :] ** it.powers).prod(axis=-1)))


def _linear(name: str) -> Array:
    """Linear shape functions (a, c) at the nodes of a quadrilateral or hexahedron."""
    own = CELLS[name].nodes
    corners = own[: CELLS[name].corners]
    return np.asarray(np.where(corners[None] == 1.0, own[:, None], 1.0 - own[:, None]).prod(axis=-1))


def located(base: Mesh, roots: IntArray, place: Array, first: FirstPlaces) -> tuple[Array, IntArray]:
    """Places (k, d) of the new nodes [m], and the corners (k, c) of the base mesh that they lie between, in falling
    order and filled with -1.

    Parameters
    ----------
    base
        Base mesh.
    roots
        (e, a) nodes of the base cell of each leaf.
    place
        (e, c, c) barycentric coordinates of the corners of the leaves.
    first
        Where the nodes occur.
    """
    name = next(iter(base.blocks))
    chosen = roots[first.leaf]
    own = node_places(name, place[first.leaf])[np.arange(len(first.local)), first.local]
    points = np.einsum("ka,kai->ki", shape_functions(name, own), base.points[chosen])
    carriers = np.sort(np.where(own > 0.0, chosen[:, : own.shape[1]], -1), axis=1)[:, ::-1]
    return points, carriers
