"""Control volumes of quadratic hexahedra and of several types of cells: they fill the mesh, means are exact."""

import numpy as np
import pytest

from softway.adaptivity.rezoning.volume import volume_of
from softway.adaptivity.unrelated.control_volumes import ControlVolumes, control_volumes
from softway.adaptivity.unrelated.overlap import overlap
from softway.arrays import Array
from softway.bodies.elements.section import PlaneStrain, Volume
from softway.errors import InputError
from softway.meshes.cells import CELLS
from softway.meshes.element import element
from softway.meshes.generators.shapes import box, rectangle
from softway.meshes.mesh import Mesh

QUADRATIC = box((1.0, 1.0, 1.0), (2, 2, 2), cell="hex20")
POINTS = {"hex20": 27}


def shaken(seed: int) -> Array:
    """Places of the nodes, corners inside and on the faces moved in their planes, middles in the middles of edges."""
    corners = box((1.0, 1.0, 1.0), (2, 2, 2), cell="hex8")
    points = np.array(corners.points)
    shift = np.random.default_rng(seed).uniform(-0.1, 0.1, points.shape)
    points += np.where((points > 0.0) & (points < 1.0), shift, 0.0)
    out, cells = np.array(QUADRATIC.points), QUADRATIC.blocks["hex20"]
    out[cells[:, :8]] = points[corners.blocks["hex8"]]
    for k, (one, other) in enumerate(CELLS["hex20"].edges):
        out[cells[:, 8 + k]] = 0.5 * (out[cells[:, one]] + out[cells[:, other]])
    return out


def sizes(of: ControlVolumes) -> Array:
    x = of.corners
    return np.asarray((np.abs(np.linalg.det(x[:, 1:] - x[:, :1])) / 6.0).reshape(-1, of.pieces).sum(axis=1))


def test_boxes_fill_cells_with_warped_faces() -> None:
    points, cells = shaken(1), QUADRATIC.blocks["hex20"]
    found = sizes(control_volumes(QUADRATIC.blocks, points, POINTS)).reshape(-1, 27).sum(axis=1)
    exact = [volume_of({"hex20": cells[k : k + 1]}, Volume(), points) for k in range(len(cells))]
    assert found == pytest.approx(exact, rel=1e-13)


def test_each_box_is_around_its_point() -> None:
    cube = box((1.0, 1.0, 1.0), (1, 1, 1), cell="hex20")
    found = control_volumes(cube.blocks, cube.points, POINTS)
    assert found.centre == pytest.approx(element("hex20").points, abs=0.03)
    assert sizes(found) == pytest.approx(element("hex20").weights, rel=1e-13)


def test_warped_hexahedra_overlap_without_gaps_and_pass_linear_fields() -> None:
    one, other = (control_volumes(QUADRATIC.blocks, shaken(seed), POINTS) for seed in (1, 2))
    found = overlap(one, other)
    assert found.covered == pytest.approx(sizes(other), rel=1e-11)
    constant = found.means(np.ones((len(one.whole), 1)))
    assert constant == pytest.approx(1.0, abs=1e-13)


def test_several_types_of_cells_in_the_plane() -> None:
    plain = rectangle((1.0, 1.0), (4, 4))
    cells = plain.blocks["quad4"]
    halves = np.concatenate([cells[:8][:, [0, 1, 2]], cells[:8][:, [0, 2, 3]]])
    mixed = Mesh(points=plain.points, blocks={"quad4": cells[8:], "tri3": halves})
    old = control_volumes(mixed.blocks, mixed.points, {"quad4": 4, "tri3": 3})
    new = control_volumes(plain.blocks, plain.points, {"quad4": 4})
    found = overlap(old, new)
    assert found.covered == pytest.approx(1.0 / 64.0, rel=1e-12)
    assert found.covered.sum() == pytest.approx(volume_of(mixed.blocks, PlaneStrain(), mixed.points), rel=1e-13)
    assert len(old.point) == 8 * 4 + 16 * 3
    back = overlap(new, old)
    values = np.repeat([[1.0], [3.0]], 32, axis=0)
    assert back.measure @ values[back.pairs[:, 1], 0] == pytest.approx(2.0, rel=1e-13)


def test_several_types_of_cells_in_space_are_refused() -> None:
    with pytest.raises(InputError, match="hex27"):
        control_volumes(box((1.0,) * 3, (1,) * 3, cell="hex27").blocks, np.zeros((27, 3)), {"hex27": 27})
