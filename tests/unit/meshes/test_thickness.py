"""Thickness of a body in layers of quadrilaterals and hexahedra."""

import numpy as np
import pytest

from softway.meshes.generators.graded import ring
from softway.meshes.generators.shapes import box, rectangle
from softway.meshes.mesh import Mesh
from softway.meshes.thickness import MOST, layers


@pytest.mark.parametrize("count", [1, 2, 5])
def test_rectangle_is_counted_through_both_directions(count: int) -> None:
    found = layers(rectangle((4.0, 0.5), (8, count)), "quad4")
    along = found.thickness > 1.0
    assert along.sum() == 2 * count and (found.count[along] == 8).all() and (found.thickness[along] == 4.0).all()
    assert (~along).sum() == 16 and (found.count[~along] == count).all()
    assert found.thickness[~along] == pytest.approx(0.5)


def test_layers_end_at_the_opposite_facets() -> None:
    mesh = box((3.0, 2.0, 1.0), (3, 2, 4))
    found = layers(mesh, "hex8")
    assert len(found.count) == 2 * (3 * 2 + 3 * 4 + 2 * 4)
    apart = mesh.points[found.facets].mean(axis=1) - mesh.points[found.ends].mean(axis=1)
    assert sorted(set(zip(found.count.tolist(), np.abs(apart).max(axis=1).round(9).tolist(), strict=True))) == [
        (2, 2.0),
        (3, 3.0),
        (4, 1.0),
    ]


def test_ring_is_as_thick_as_its_wall() -> None:
    found = layers(ring(1.0, 1.2, cells=(3, 24), angle=2.0 * np.pi), "quad4")
    assert (found.count == 3).all() and len(found.count) == 48
    assert found.thickness == pytest.approx(0.2 * np.cos(np.pi / 24), rel=1e-2)


def test_more_layers_than_counted_and_other_cells_end_the_count() -> None:
    assert len(layers(rectangle((1.0, 1.0), (MOST + 1, MOST + 1)), "quad4").count) == 0
    points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [2.0, 0.5]])
    mixed = Mesh(points=points, blocks={"quad4": np.array([[0, 1, 2, 3]]), "tri3": np.array([[1, 4, 2]])})
    assert layers(mixed, "quad4").facets.tolist() == [[0, 1], [2, 3]]
