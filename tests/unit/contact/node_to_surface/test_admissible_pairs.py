"""Pairs of a body with itself that can never meet: neighbours, and the back of a wall."""

import numpy as np
import pytest

from softway.arrays import Array
from softway.contact.node_to_surface.admissible_pairs import AdmissiblePairs, Members
from softway.contact.node_to_surface.node_to_facet import NodeToFacet
from softway.contact.surfaces.boundary import ContactSurface
from softway.contact.surfaces.wall_thickness import nodal_thickness
from softway.meshes.generators.graded import ring
from softway.meshes.generators.shapes import box
from softway.meshes.mesh import Mesh


def alone(mesh: Mesh) -> AdmissiblePairs:
    """Pairs of a body that may touch itself."""
    side = ContactSurface(facets=mesh.boundary())
    nodes, facets = np.ones((mesh.n_nodes, 1), bool), np.ones((len(side.table), 1), bool)
    members = Members(nodes=nodes, facets=facets, meet=np.ones((1, 1), bool))
    return AdmissiblePairs(points=mesh.points, body=np.zeros(mesh.n_nodes, int), side=side, members=members)


def rows(mesh: Mesh, x: Array, reach: float) -> Array:
    """Gaps of all rows of a body with itself that begin at the positions x (n, d) and stay there."""
    pairs = alone(mesh)
    thickness = nodal_thickness(mesh.points, [pairs.side])
    contact = NodeToFacet(
        slaves=pairs.side.nodes, side=pairs.side, own=pairs.side, thickness=thickness, admissible=pairs
    )
    gap = contact.meet(x, x, reach).at(x).gap
    return gap[np.isfinite(gap)]


@pytest.mark.parametrize("cell", ["quad4", "tri3", "quad9"])
@pytest.mark.parametrize(("inner", "around"), [(0.7, 12), (0.85, 12), (0.95, 16)])
def test_a_wall_of_a_ring_never_meets_its_own_back(cell: str, inner: float, around: int) -> None:
    """Two cells thick, curved and coarse: of all pairs of an inner node with an outer facet close to it, and the other
    way round, none may touch.
    """
    mesh = ring(inner, 1.0, (2, around), cell=cell)
    pairs = alone(mesh)
    radius = np.linalg.norm(mesh.points, axis=1)
    out = radius > 0.5 * (1.0 + inner)
    node, facet = (k.ravel() for k in np.meshgrid(pairs.side.nodes, np.arange(len(pairs.side.table)), indexing="ij"))
    centre = mesh.points[pairs.side.table[facet]].mean(axis=1)
    apart = np.linalg.norm(mesh.points[node] - centre, axis=1)
    across = (out[node] != out[pairs.side.table[facet, 0]]) & (apart < 2.0 * np.pi / around)
    assert np.count_nonzero(across) >= 4 * around
    assert not pairs.nodes_and_facets(node[across], facet[across]).any()


@pytest.mark.parametrize("cell", ["quad4", "tri3", "quad9"])
@pytest.mark.parametrize("squash", [1.0, 0.6, 0.35])
def test_an_oval_ring_has_no_false_rows(cell: str, squash: float) -> None:
    """A ring pressed flat by an area-preserving map, whose wall gets thinner and thicker: its inner faces face each
    other across the hole, and nothing overlaps.
    """
    mesh = ring(0.85, 1.0, (2, 16), cell=cell)
    x = mesh.points * np.array([1.0 / squash, squash])
    gap = rows(mesh, x, 2.0 * squash)
    assert len(gap) and gap.min() > 0.05


def test_a_curled_wall_meets_itself_outside() -> None:
    """A ring cut open at one place: its two ends face each other."""
    mesh = ring(0.8, 1.0, (2, 24), angle=1.97 * np.pi)
    gap = rows(mesh, mesh.points, 0.3)
    chord = 2.0 * np.sin(0.5 * 0.03 * np.pi)
    assert len(gap) and 0.5 * chord < gap.min() <= chord


@pytest.mark.parametrize("thick", [0.3, 0.05])
def test_a_plate_in_space_never_meets_its_own_back(thick: float) -> None:
    mesh = box((1.0, 1.0, thick), (4, 4, 2))
    pairs = alone(mesh)
    node, facet = (k.ravel() for k in np.meshgrid(pairs.side.nodes, np.arange(len(pairs.side.table)), indexing="ij"))
    z = mesh.points[:, 2]
    flat = np.ptp(z[pairs.side.table[facet]], axis=1) < 1e-12
    across = flat & (np.abs(z[node] - z[pairs.side.table[facet, 0]]) > 0.9 * thick)
    centre = mesh.points[pairs.side.table[facet]].mean(axis=1)
    across &= np.linalg.norm((mesh.points[node] - centre)[:, :2], axis=1) < 0.6
    assert not pairs.nodes_and_facets(node[across], facet[across]).any()
