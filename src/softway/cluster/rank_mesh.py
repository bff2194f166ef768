"""Mesh of a rank: the cells that it computes, and the nodes that it holds; some of them belong to none of its cells."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.discretised import DiscreteSolid
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


def rank_mesh(part: DiscreteSolid, number: int, held: Holding) -> RankMesh:
    """Mesh of what a rank holds of the solid with this number, which has cells of one type."""
    mesh, at = part.mesh, part.nodes.start
    ((kind, cells),) = mesh.blocks.items()
    nodes = held.nodes[local_nodes(part.nodes, held)] - at
    return RankMesh(
        points=mesh.points[nodes],
        blocks={kind: np.searchsorted(nodes, cells[held.cells[number]])},
        cell_dim=mesh.cell_dim,
        shortest=mesh.edge(),
    )
