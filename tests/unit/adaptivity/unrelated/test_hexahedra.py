"""Hexahedra: eighths fill the trilinear cells, means are exact for linear fields, flat faces slide."""

import numpy as np
import pytest

from softway.adaptivity.rezoning.flat_surface import sliding
from softway.adaptivity.rezoning.quality import cell_quality
from softway.adaptivity.rezoning.smoothing import distortion, slid_along
from softway.adaptivity.rezoning.volume import volume_of
from softway.adaptivity.unrelated.control_volumes import ControlVolumes, control_volumes
from softway.adaptivity.unrelated.overlap import overlap
from softway.arrays import Array
from softway.bodies.elements.section import Volume
from softway.meshes.element import element
from softway.meshes.generators.shapes import box
from softway.meshes.mesh import Mesh

MESH = box((1.0, 1.0, 1.0), (3, 3, 3), cell="hex8")
SURFACE = MESH.nodes("surface")
INSIDE = np.setdiff1d(np.arange(MESH.n_nodes), SURFACE)


def shaken(seed: int) -> Array:
    """Places of the nodes, those inside moved: cells with warped faces."""
    points = np.array(MESH.points)
    points[INSIDE] += np.random.default_rng(seed).uniform(-0.08, 0.08, (len(INSIDE), 3))
    return points


def volumes(of: ControlVolumes) -> Array:
    x = of.corners
    pieces = np.abs(np.linalg.det(x[:, 1:] - x[:, :1])) / 6.0
    return np.asarray(pieces.reshape(-1, of.pieces).sum(axis=1))


def centres(of: ControlVolumes) -> Array:
    x = of.corners
    size = np.abs(np.linalg.det(x[:, 1:] - x[:, :1]))
    moments = (size[:, None] * x.mean(axis=1)).reshape(-1, of.pieces, 3).sum(axis=1)
    return np.asarray(moments / size.reshape(-1, of.pieces).sum(axis=1)[:, None])


def test_eighths_fill_cells_with_warped_faces() -> None:
    points, cells = shaken(1), MESH.blocks["hex8"]
    found = volumes(control_volumes(MESH.blocks, points, {"hex8": 8})).reshape(-1, 8)
    exact = [volume_of({"hex8": cells[k : k + 1]}, Volume(), points) for k in range(len(cells))]
    assert found.sum(axis=1) == pytest.approx(exact, rel=1e-13)


def test_each_eighth_is_around_its_point() -> None:
    places = element("hex8", 2).points
    cube = box((1.0, 1.0, 1.0), (1, 1, 1), cell="hex8")
    found = control_volumes(cube.blocks, cube.points, {"hex8": 8})
    assert (np.abs(found.centre - places) < 0.25).all()
    assert found.point.tolist() == list(range(8))


def test_means_over_warped_hexahedra_are_exact_for_linear_fields() -> None:
    one, other = (control_volumes(MESH.blocks, shaken(seed), {"hex8": 8}) for seed in (1, 2))
    meets = overlap(one, other)
    assert meets.covered == pytest.approx(volumes(other), rel=1e-12)
    assert float(meets.measure.sum()) == pytest.approx(1.0, rel=1e-13)
    slope = np.array([[1.0], [-2.0], [3.0]])
    inside = np.abs(centres(other) - 0.5).max(axis=1) < 0.2
    assert inside.sum() > 5
    assert meets.means(centres(one) @ slope)[inside] == pytest.approx((centres(other) @ slope)[inside], abs=1e-12)


def test_nodes_slide_on_flat_faces_and_straight_edges() -> None:
    """Nodes that were moved on the faces of a cube, and along its edges, go back; its shape and its tags stay."""
    none = np.zeros(MESH.n_nodes, dtype=bool)
    nodes, ways = sliding(MESH, MESH.points, none)
    assert len(nodes) == len(SURFACE) - 8
    points = np.array(MESH.points)
    wild = np.random.default_rng(3).uniform(-0.1, 0.1, (len(nodes), 3))
    points[nodes] += np.einsum("kij,kj->ki", ways, wild)
    mesh = Mesh(points=points, blocks=MESH.blocks, tags=MESH.tags)
    again = sliding(mesh, points, none)
    assert again[0].tolist() == nodes.tolist()
    found = slid_along(distortion(MESH.blocks, MESH.points), points, INSIDE, *again)
    assert found == pytest.approx(MESH.points, abs=0.01)
    assert cell_quality(MESH.blocks, points).worst[0] < 0.85
    assert cell_quality(MESH.blocks, found).worst[0] > 0.98
    assert volume_of(MESH.blocks, Volume(), found) == pytest.approx(1.0, rel=1e-14)
    for tag, axis in (("left", 0), ("right", 0), ("bottom", 2), ("top", 2)):
        assert (found[MESH.nodes(tag), axis] == MESH.points[MESH.nodes(tag), axis]).all()


def test_nodes_at_the_ends_of_tags_and_those_that_are_kept_stay() -> None:
    mesh = MESH.with_tag("pad", lambda x: (x[:, 2] > 0.999) & (x[:, 0] < 0.4))
    kept = np.zeros(mesh.n_nodes, dtype=bool)
    kept[mesh.nodes("bottom")] = True
    nodes, _ = sliding(mesh, mesh.points, kept)
    end = np.flatnonzero((mesh.points[:, 2] > 0.999) & (abs(mesh.points[:, 0] - 1.0 / 3.0) < 1e-9))
    assert not np.isin(np.concatenate([end, mesh.nodes("bottom")]), nodes).any()
    bulge = 0.01 * (mesh.points[:, 0] == 1.0) * (1.0 - ((mesh.points[:, 1:] - 0.4) ** 2).sum(axis=1))
    bulged = mesh.points + bulge[:, None] * [1.0, 0.0, 0.0]
    nodes, _ = sliding(mesh, bulged, np.zeros_like(kept))
    assert not np.isin(mesh.nodes("right"), nodes).any()
    assert np.isin(mesh.nodes("left"), nodes).any()
