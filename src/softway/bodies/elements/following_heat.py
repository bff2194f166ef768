"""Heat of hanging nodes: their temperature follows that of the larger cells, and their heat belongs to the nodes of
these (docs/theory/heat/conduction.md#hanging-nodes).

A hanging node has the shape functions of the edge or face of the larger cell for its temperature, and the linear
functions of the corners there for its heat: these are positive, so that no capacity gets less than nothing, and sum to
one.  In linear cells both are the same.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.meshes.cells import CELLS, linear
from softway.meshes.element import tabulate
from softway.meshes.mesh import Mesh
from softway.meshes.topology import HangingNodes

FACETS = {"quad8": ("bar3",), "quad9": ("bar3",), "hex20": ("bar3", "quad8"), "hex27": ("bar3", "quad9")}
"""Edges and faces of quadratic cells on which nodes hang."""


Entries = tuple[tuple[IntArray, IntArray, Array], ...]
"""Entries of a sparse matrix in groups of rows, columns and values; entries of one place add up."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FollowingHeat:
    """Heat of N nodes, some of which hang, from that of the n nodes that do not.

    Parameters
    ----------
    follow
        (N, n) temperatures of all nodes from those of the nodes that do not hang.
    spread
        (N, n) shares of the nodes that do not hang in the heat of each node; rows sum to one, and none is negative.
    """

    follow: sp.csr_array
    spread: sp.csr_array

    def matrix(self, full: sp.csr_array) -> sp.csr_array:
        """Matrix (n, n) of the heat that flows out of the nodes, from that (N, N) of all nodes."""
        return sp.csr_array(self.follow.T @ full @ self.follow)


def combined(left: sp.csr_array, entries: Entries, shape: tuple[int, int], right: sp.csr_array | None) -> Entries:
    """Entries of ``left^T A right`` from those of a matrix A of a ``shape``; without ``right`` of ``left^T A``."""
    if not entries:
        return ()
    rows, columns, values = (np.concatenate(part) for part in zip(*entries, strict=True))
    found = left.T @ sp.csr_array((values, (rows, columns)), shape=shape)
    found = sp.coo_array(found if right is None else found @ right)
    return ((found.coords[0].astype(np.int64), found.coords[1].astype(np.int64), found.data),)


def kept_nodes(mesh: Mesh) -> IntArray:
    """Nodes (k,) of a mesh that do not hang."""
    every = np.arange(mesh.n_nodes)
    return every if mesh.hanging is None else np.setdiff1d(every, mesh.hanging.node)


def following_heat(mesh: Mesh) -> FollowingHeat | None:
    """Heat of the hanging nodes of a mesh; None without.

    Examples
    --------
    >>> from softway.meshes.adaptive.refinement import refined
    >>> from softway.meshes.generators.shapes import rectangle
    >>> mesh = refined(rectangle((2.0, 1.0), (2, 1), cell="quad9"), np.array([0, 2])).mesh
    >>> found = following_heat(mesh)
    >>> sorted(set(found.follow.data.tolist())), sorted(set(found.spread.data.tolist()))
    ([-0.125, 0.375, 0.75, 1.0], [0.25, 0.75, 1.0])
    """
    hanging, kept = mesh.hanging, kept_nodes(mesh)
    if hanging is None:
        return None
    follow = hanging.follow(mesh.n_nodes)
    spread = follow if _linear(mesh) else _by_corners(mesh, hanging).follow(mesh.n_nodes)
    return FollowingHeat(follow=sp.csr_array(follow[:, kept]), spread=sp.csr_array(spread[:, kept]))


def joined_heat(meshes: Sequence[Mesh], lumps: int = 0) -> FollowingHeat | None:
    """Heat of the hanging nodes of several meshes, and of rigid bodies behind them; None if no node hangs."""
    if all(mesh.hanging is None for mesh in meshes):
        return None
    found = [following_heat(mesh) or _itself(mesh.n_nodes) for mesh in meshes] + [_itself(lumps)] * bool(lumps)
    follow, spread = (
        sp.csr_array(sp.block_diag(blocks, format="csr"))
        for blocks in ([one.follow for one in found], [one.spread for one in found])
    )
    return FollowingHeat(follow=follow, spread=spread)


def _itself(count: int) -> FollowingHeat:
    """Nodes of which none hangs."""
    same = sp.csr_array(sp.eye_array(count, format="csr"))
    return FollowingHeat(follow=same, spread=same)


def _linear(mesh: Mesh) -> bool:
    """True for a mesh of linear cells."""
    return not FACETS.keys() & mesh.blocks.keys()


def _by_corners(mesh: Mesh, hanging: HangingNodes) -> HangingNodes:
    """Hanging nodes of quadratic cells with the linear functions of the corners as their weights.

    The shape functions reproduce the place in the edge or face, so that they tell it.
    """
    weights: Array = np.zeros_like(hanging.weights)
    count = (hanging.parents >= 0).sum(axis=1)
    for facet in FACETS[next(cell for cell in mesh.blocks if cell in FACETS)]:
        nodes, corners = CELLS[facet].nodes, CELLS[facet].corners
        mine = np.flatnonzero(count == len(nodes))
        at = hanging.weights[mine, : len(nodes)] @ nodes
        weights[mine, :corners] = tabulate(linear(facet), at)[0]
    return HangingNodes(node=hanging.node, parents=hanging.parents, weights=weights, inner=hanging.inner)
