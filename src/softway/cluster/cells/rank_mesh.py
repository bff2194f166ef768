"""Mesh of a rank: the cells that it computes, and the nodes that it holds; some of them belong to none of its cells."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.cluster.cells.pieces import Piece, of_solid
from softway.ranks.partition import Holding


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RankMesh:
    """What a march reads of a :class:`~softway.meshes.mesh.Mesh`, with its names; ``shortest`` is the shortest edge of
    the whole body [m].
    """

    points: Array
    blocks: Mapping[str, IntArray]
    cell_dim: int
    shortest: float
    hanging: None = None

    @property
    def dim(self) -> int:
        """Dimension d of space."""
        return int(self.points.shape[1])

    @property
    def n_nodes(self) -> int:
        """Number of local nodes."""
        return len(self.points)

    def edge(self) -> float:
        """Shortest edge of the body [m]."""
        return self.shortest


def local_nodes(nodes: slice, held: Holding) -> slice:
    """Local nodes of a solid with these nodes of the model."""
    first, last = np.searchsorted(held.nodes, [nodes.start, nodes.stop])
    return slice(int(first), int(last))


def own_mask(nodes: slice, held: Holding) -> BoolArray:
    """True (n,) for own nodes among the local ones of a solid with these nodes of the model."""
    local = local_nodes(nodes, held)
    return np.isin(np.arange(local.start, local.stop), held.own, assume_unique=True)


def rank_mesh(solid: int, part: DiscreteSolid, pieces: tuple[Piece, ...], held: Holding) -> RankMesh:
    """Mesh of what a rank holds of the solid with this number: its cells, material after material."""
    mesh, first = part.mesh, local_nodes(part.nodes, held).start
    corners = [held.local(pieces[k].corners[held.cells[k]]) - first for k in of_solid(pieces, solid)]
    return RankMesh(
        points=mesh.points[held.nodes[local_nodes(part.nodes, held)] - part.nodes.start],
        blocks={next(iter(mesh.blocks)): np.concatenate(corners)},
        cell_dim=mesh.cell_dim,
        shortest=mesh.edge(),
    )
