"""Facets of larger cells beside smaller ones, found from places, against the hanging nodes of the mesh."""

import numpy as np
import pytest
from adapted import BASES, HANGING, adapted

from softway.meshes.adaptive.squares.inner_facets import beside_smaller
from softway.meshes.cells import CELLS
from softway.meshes.mesh import Mesh
from softway.record.audit.geometry.solids import solids


def sorted_facets(facets):
    return {tuple(sorted(row)) for found in facets.values() for row in found.tolist()}


@pytest.mark.parametrize("name", BASES)
def test_the_boundary_is_that_of_the_mesh(name):
    """Also beside a second body with nodes in the same places of its surface."""
    mesh = adapted(name, 5).mesh
    n, kind = mesh.n_nodes, next(iter(mesh.blocks))
    cells = mesh.blocks[kind]
    beside = mesh.points + np.ptp(mesh.points, axis=0) * (np.arange(mesh.dim) == 0)
    twice = Mesh(points=np.concatenate([mesh.points, beside]), blocks={kind: np.concatenate([cells, cells + n])})
    single, owner = twice.boundary(), np.repeat([0, 1], n)
    left = {facet: f[~beside_smaller(twice.points, owner, facet, f)] for facet, f in single.items()}
    own = sorted_facets(mesh.boundary())
    assert sorted_facets(left) == own | {tuple(node + n for node in facet) for facet in own}
    if name in HANGING:
        assert len(sorted_facets(single)) > 2 * len(own)
    if CELLS[kind].dim == mesh.dim:
        body = np.repeat([0, 1], len(cells))
        found = solids(("one", "other"), twice.points, dict(twice.blocks), {kind: body})
        assert sorted_facets(found.facets) == sorted_facets(left)
