"""Edges across walls one cell thick, in meshes of several cells."""

import numpy as np

from softway.meshes.mesh import Mesh
from softway.meshes.walls.wall_edges import wall_edges

CORNERS = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])


def test_blocks_and_simplices_in_one_mesh_have_their_own_facets() -> None:
    """A cube beside a tetrahedron: the twelve edges of the cube, and those of the tetrahedron as without the cube."""
    apart = np.array([[3.0, 0.0, 0.0], [4.0, 0.0, 0.0], [3.0, 1.0, 0.0], [3.0, 0.0, 1.0]])
    cube, simplex = np.array([[0, 1, 3, 2, 4, 5, 7, 6]]), np.array([[0, 1, 2, 3]])
    both = Mesh(points=np.concatenate([CORNERS, apart]), blocks={"hex8": cube, "tet4": simplex + 8})
    alone = wall_edges(Mesh(points=apart, blocks={"tet4": simplex}), np.arange(4))
    found = wall_edges(both, np.arange(12))
    assert (
        found[found[:, 0] < 8].tolist()
        == wall_edges(Mesh(points=CORNERS, blocks={"hex8": cube}), np.arange(8)).tolist()
    )
    assert len(found[found[:, 0] < 8]) == 12
    assert (found[found[:, 0] >= 8] - 8).tolist() == alone.tolist()
