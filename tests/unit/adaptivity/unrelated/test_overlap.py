"""Means over unrelated meshes: totals stay exactly, linear fields too, and a bump keeps its peak."""

import numpy as np
import pytest
from scipy.spatial import Delaunay

from softway.adaptivity.unrelated.control_volumes import ControlVolumes, control_volumes
from softway.adaptivity.unrelated.overlap import overlap
from softway.arrays import Array
from softway.meshes.generators.shapes import rectangle


def irregular(n: int, seed: int) -> ControlVolumes:
    """2 n^2 irregular triangles of the unit square."""
    side = np.linspace(0.0, 1.0, n + 1)
    x = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    inner = ((x > 0.0) & (x < 1.0)).all(axis=1)
    x[inner] += 0.25 / n * (2.0 * np.random.default_rng(seed).random((inner.sum(), 2)) - 1.0)
    cells = x[Delaunay(x).simplices]
    cells = cells[areas(cells) > 1e-12]
    return ControlVolumes(corners=cells, point=np.arange(len(cells)))


def areas(cells: Array) -> Array:
    return np.asarray(0.5 * np.linalg.det(cells[:, 1:] - cells[:, :1]))


def test_a_bump_after_twenty_transfers() -> None:
    one, other = irregular(30, 1), irregular(30, 2)
    there, back = overlap(one, other), overlap(other, one)
    start = np.exp(-((one.centre - 0.5) ** 2).sum(axis=1) / (2.0 * (2.0 / 30.0) ** 2))[:, None]
    values, size = start, areas(one.corners)
    for _ in range(10):
        values = back.means(there.means(values))
    assert len(one.corners) == 1800
    assert values.max() > 0.9 * start.max()
    assert values.min() > -1e-15
    assert float((size @ (values - start))[0]) == pytest.approx(0.0, abs=1e-13 * float((size @ start)[0]))
    error = np.sqrt((size @ (values - start) ** 2)[0] / (size @ start**2)[0])
    assert error < 0.06  # .22 with constant means in the cells


def test_linear_fields_pass_exactly_inside() -> None:
    one, other = irregular(8, 3), irregular(8, 4)
    fields = one.centre @ np.array([[1.0, -2.0], [3.0, 0.5]])
    found = overlap(one, other).means(fields)
    inside = (abs(other.corners - 0.5).max(axis=(1, 2))) < 0.2  # gradients at the boundary are limited
    assert inside.sum() > 5
    wanted = other.centre @ np.array([[1.0, -2.0], [3.0, 0.5]])
    assert found[inside] == pytest.approx(wanted[inside], abs=1e-12)


@pytest.mark.parametrize(("cell", "points"), [("quad4", 4), ("quad4", 9), ("tri3", 1), ("tri6", 3), ("tri6", 6)])
def test_control_volumes_fill_the_cells(cell: str, points: int) -> None:
    mesh = rectangle((1.0, 2.0), (2, 2), cell=cell)
    found = control_volumes(mesh.blocks, mesh.points, {cell: points})
    own = np.repeat(np.arange(len(found.corners))[:, None], 2, axis=1)
    meets = overlap(found, found)
    assert float(meets.measure[(meets.pairs == own[meets.pairs[:, 0]]).all(axis=1)].sum()) == pytest.approx(
        2.0, abs=1e-14
    )
    assert len(found.point) == mesh.n_cells * points
