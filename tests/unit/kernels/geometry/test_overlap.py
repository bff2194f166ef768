"""Overlaps of polygons and tetrahedra: two meshes of a box fill each other, with their first moments."""

import numpy as np
import pytest
from scipy.spatial import Delaunay

from softway.arrays import Array, IntArray
from softway.kernels.geometry.overlap import polygon_overlaps, tetrahedron_overlaps


def simplices(d: int, count: int, seed: int) -> Array:
    """Simplices (k, d + 1, d) of a positive measure that fill the unit box."""
    inner = np.random.default_rng(seed).random((count, d))
    corners = np.array(np.meshgrid(*[[0.0, 1.0]] * d)).reshape(d, -1).T
    points = np.concatenate([inner, corners])
    x = points[Delaunay(points).simplices]
    size = np.linalg.det(x[:, 1:] - x[:, :1])
    x[size < 0.0] = x[size < 0.0][:, [1, 0, *range(2, d + 1)]]
    return x[abs(size) > 1e-12]


def every_pair(one: Array, other: Array) -> IntArray:
    return np.array([(i, j) for i in range(len(one)) for j in range(len(other))])


@pytest.mark.parametrize("d", [2, 3])
def test_parts_fill_the_cells_of_both_meshes(d: int) -> None:
    one, other = simplices(d, 12, 1), simplices(d, 9, 2)
    pairs = every_pair(one, other)
    found = polygon_overlaps(one, other, pairs, False) if d == 2 else tetrahedron_overlaps(one, other, pairs)
    for side, cells in enumerate((one, other)):
        size = np.linalg.det(cells[:, 1:] - cells[:, :1]) / (2.0 if d == 2 else 6.0)
        sums = [np.bincount(pairs[:, side], column) for column in found.T]
        assert sums[0] == pytest.approx(size, abs=1e-15)
        assert pytest.approx(size[:, None] * cells.mean(axis=1), abs=1e-15) == np.array(sums[1:]).T


def test_bodies_of_revolution() -> None:
    one, other = simplices(2, 12, 3), simplices(2, 9, 4)
    found = polygon_overlaps(one, other, every_pair(one, other), True).sum(axis=0)
    assert found == pytest.approx([1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0], abs=1e-14)


def test_concave_polygons_are_sums_with_a_sign() -> None:
    arrow = np.array([[[0.0, 0.0], [1.0, 1.0], [0.0, 0.4], [-1.0, 1.0]]])
    box = np.array([[[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]]])
    assert polygon_overlaps(arrow, box, np.array([[0, 0]]), False)[0, 0] == pytest.approx(0.4, abs=1e-15)
