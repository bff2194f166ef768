"""Mesh of a rank: the cells that it computes, and the nodes that it holds; some of them belong to none of its cells."""

from collections.abc import Mapping
from dataclasses import dataclass

from softway.arrays import Array, IntArray
from softway.meshes.mesh import Mesh
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


def rank_mesh(mesh: Mesh, held: Holding) -> RankMesh:
    """Mesh of what a rank holds of a body with cells of one type."""
    ((kind, cells),) = mesh.blocks.items()
    return RankMesh(
        points=mesh.points[held.nodes],
        blocks={kind: held.local(cells[held.cells])},
        cell_dim=mesh.cell_dim,
        shortest=mesh.edge(),
    )
