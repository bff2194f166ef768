"""Topology of a mesh: cells that occur twice or lie in the same place, facets of more than two cells, hanging nodes,
and smooth surfaces through the nodes of its boundary.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import InputError
from softway.meshes.cells import CELLS, FACETS

ONCE = "a mesh that lists every cell once"
SAME_PLACE = 1e-9
"""Distance of the centres of two cells, relative to the shortest edge, below which they are in the same place."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HangingNodes:
    """Hanging nodes of a mesh, on edges or faces of larger cells.

    Parameters
    ----------
    node
        (k,) nodes.
    parents
        (k, p) nodes of the edge or face; -1 for none.  None of them hangs.
    weights
        (k, p) shape functions of the edge or face at the hanging node; zero for no parent.
    inner
        (f, c) corners of the facets of larger cells beside smaller ones, and of those of the smaller ones: they belong
        to one cell, and are no boundary.

    Examples
    --------
    >>> edges = np.array([[0, 1], [0, 2], [2, 1]])
    >>> half = HangingNodes(node=np.array([2]), parents=edges[:1], weights=np.array([[0.5, 0.5]]), inner=edges)
    >>> half.following(np.array([[0.0], [4.0], [9.0]])).tolist()
    [[0.0], [4.0], [2.0]]
    """

    node: IntArray
    parents: IntArray
    weights: Array
    inner: IntArray

    def __post_init__(self) -> None:
        for table in (self.node, self.parents, self.weights, self.inner):
            table.flags.writeable = False

    def follow(self, count: int) -> sp.csr_array:
        """Motion (n, n) of all nodes from that of those that do not hang; n is the ``count`` of nodes."""
        rest, used = np.setdiff1d(np.arange(count), self.node), self.weights != 0.0
        rows = np.concatenate([rest, np.broadcast_to(self.node[:, None], used.shape)[used]])
        columns = np.concatenate([rest, self.parents[used]])
        values = np.concatenate([np.ones(len(rest)), self.weights[used]])
        return sp.csr_array((values, (rows, columns)), shape=(count, count))

    def following(self, field: Array) -> Array:
        """Field (n, k) whose values at the hanging nodes follow their parents."""
        return np.asarray(self.follow(len(field)) @ field)

    def at(self, nodes: IntArray) -> IntArray:
        """Hanging nodes (k,) that are among some nodes, or follow one of them."""
        return self.node[np.isin(np.column_stack([self.node, self.parents]), nodes).any(axis=1)]

    def inside(self, facets: IntArray) -> BoolArray:
        """True (f,) for facets of one cell, by their corners (f, c), that are no boundary."""
        both = np.sort(np.concatenate([self.inner, facets]), axis=1)
        number = np.unique(both, axis=0, return_inverse=True)[1].ravel()
        return np.asarray(np.isin(number[len(self.inner) :], number[: len(self.inner)]))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Rounding:
    """Smooth surface through the n nodes of a base mesh with e cells.

    The boundary consists of patches: facets that meet at small angles.

    Parameters
    ----------
    patches
        (n, s) patches at each node; -1 for none.
    normals
        (n, s, d) normals of these patches at the node; not a number where unknown.
    tangents
        (n, d) tangents of the edges between two patches; not a number where they end, or have a corner.
    edges, sides
        (k, 2) corners, the greater number first, of the curved edges on the boundary, and (k, 2) their patches: one and
        -1, or two where patches meet.
    facets, on
        (f, c) corners, in falling order, of the curved facets in space, and (f,) their patch.
    moments
        (e, 1 + d) integrals of 1 and the place over the body in each cell, that is the cell with its curved facets, by
        :func:`~softway.meshes.adaptive.rounded.volumes.moments_by_root`; not a number where it is not curved.
    bulge
        (e,) greatest distance of the surface from the facets and edges of each cell [m].
    radial
        True for a body of revolution: the integrals are those of the distance from the axis.
    """

    patches: IntArray
    normals: Array
    tangents: Array
    edges: IntArray
    sides: IntArray
    facets: IntArray
    on: IntArray
    moments: Array
    bulge: Array
    radial: bool = False

    def sides_of(self, carriers: IntArray) -> IntArray:
        """Patches (k, 2) of new nodes by their ``carriers`` (k, c), corners of the base mesh that they lie between, in
        falling order and filled with -1; -1 off the curved boundary.
        """
        out = np.full((len(carriers), 2), -1)
        for table, own in ((self.edges, self.sides), (self.facets, self.on[:, None])):
            wide = np.full((len(table), carriers.shape[1]), -1)
            wide[:, : table.shape[1]] = table
            number = np.unique(np.concatenate([wide, carriers]), axis=0, return_inverse=True)[1].ravel()
            place = np.full(number.max(initial=0) + 1, -1)
            place[number[: len(table)]] = np.arange(len(table))
            at = place[number[len(table) :]]
            out[at >= 0, : own.shape[1]] = own[at[at >= 0]]
        return out


def require_none(hanging: HangingNodes | None, what: str) -> None:
    """Refuse a mesh with hanging nodes, which do not fit ``what``.

    Raises
    ------
    InputError
        At the place of the mesh.

    Examples
    --------
    >>> require_none(None, "ties")
    """
    if hanging is not None:
        problem = f"{len(hanging.node)} hanging nodes, and {what}"
        raise InputError("mesh", problem, f"a mesh whose cells share whole facets, or no {what}")


def check_topology(points: Array, blocks: Mapping[str, IntArray], edge: float) -> None:
    """Refuse cells that occur twice, cells in the place of another, and facets of more than two cells.

    Their mass and stiffness would count twice, and facets that occur twice are no boundary: contact would not see them.

    Parameters
    ----------
    points
        (n, d) coordinates of the nodes [m].
    blocks
        Cell name -> (e, a) node numbers.
    edge
        Length of the shortest edge [m].

    Raises
    ------
    InputError
        With the number of the cell, its centre and the number of such cells.

    Examples
    --------
    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> check_topology(square, {"quad4": np.array([[0, 1, 2, 3]])}, 1.0)
    >>> check_topology(square, {"quad4": np.array([[0, 1, 2, 3], [1, 2, 3, 0]])}, 1.0)
    Traceback (most recent call last):
    softway.errors.InputError: blocks.quad4[1]: cell number 1 has the corners of cell number 0, with the centre \
(0.5, 0.5) m; 1 cell occurs twice
      try: a mesh that lists every cell once
    """
    for name, cells in blocks.items():
        _check_copies(points, name, cells)
    if CELLS[next(iter(blocks))].dim == points.shape[1]:
        _check_places(points, blocks, edge)
        _check_facets(points, blocks)


def repeated(keys: IntArray, least: int = 2) -> tuple[IntArray, ...]:
    """Numbers of equal rows of ``keys`` (n, k), one array for each row that occurs ``least`` times or more.

    Examples
    --------
    >>> [rows.tolist() for rows in repeated(np.array([[3, 1], [0, 2], [3, 1]]))]
    [[0, 2]]
    """
    order = np.lexsort(keys.T)
    ordered = keys[order]
    first = np.concatenate([[True], (ordered[1:] != ordered[:-1]).any(axis=1)]).nonzero()[0]
    count = np.diff(np.append(first, len(keys)))
    many = count >= least
    return tuple(np.sort(order[a : a + n]) for a, n in zip(first[many], count[many], strict=True))


def described(point: Array) -> str:
    """Coordinates of a point (d,) in text, such as ``(0.5, 0.25) m``."""
    return f"({', '.join(f'{value:.6g}' for value in point)}) m"


def _check_copies(points: Array, name: str, cells: IntArray) -> None:
    """Refuse cells of a block that have the same corners."""
    corners = cells[:, : CELLS[name].corners]
    found = repeated(np.sort(corners, axis=1))
    if not found:
        return
    first, second = min(((int(rows[0]), int(rows[1])) for rows in found), key=lambda pair: pair[1])
    copies = sum(len(rows) - 1 for rows in found)
    centre = described(points[corners[second]].mean(axis=0))
    raise InputError(
        f"blocks.{name}[{second}]",
        f"cell number {second} has the corners of cell number {first}, with the centre {centre}; "
        f"{copies} {'cell occurs' if copies == 1 else 'cells occur'} twice",
        ONCE,
    )


def _check_places(points: Array, blocks: Mapping[str, IntArray], edge: float) -> None:
    """Refuse cells with other nodes that have the same centre."""
    centres = np.concatenate([points[cells[:, : CELLS[name].corners]].mean(axis=1) for name, cells in blocks.items()])
    pairs = cKDTree(centres).query_pairs(SAME_PLACE * edge, output_type="ndarray")
    if not len(pairs):
        return
    names = [(name, k) for name, cells in blocks.items() for k in range(len(cells))]
    first, second = (int(k) for k in min(pairs.tolist(), key=lambda pair: (pair[1], pair[0])))
    (name, k), (other, j) = names[second], names[first]
    copies = len(np.unique(pairs[:, 1]))
    raise InputError(
        f"blocks.{name}[{k}]",
        f"cell number {k} is in the place of cell number {j}{'' if name == other else f' of {other}'}, with the centre "
        f"{described(centres[second])}; {copies} {'cell lies' if copies == 1 else 'cells lie'} in the place of another",
        ONCE,
    )


def _check_facets(points: Array, blocks: Mapping[str, IntArray]) -> None:
    """Refuse facets that belong to more than two cells; facets that have collapsed to an edge or a point may."""
    rows: dict[int, list[IntArray]] = {}
    for name, cells in blocks.items():
        for facet, local in FACETS[name]:
            n = CELLS[facet].corners
            rows.setdefault(n, []).append(np.sort(cells[:, local[:n]], axis=1))
    for parts in rows.values():
        keys = np.concatenate(parts)
        distinct = 1 + (np.diff(keys, axis=1) > 0).sum(axis=1)
        found = repeated(keys[distinct >= points.shape[1]], least=3)
        if found:
            nodes = keys[distinct >= points.shape[1]][found[0][0]]
            raise InputError(
                "blocks",
                f"{len(found[0])} cells share the facet of the nodes {nodes.tolist()}, with the centre "
                f"{described(points[nodes].mean(axis=0))}; "
                f"{len(found)} {'facet has' if len(found) == 1 else 'facets have'} more than two cells",
                "cells that do not overlap, at most two at a facet",
            )
