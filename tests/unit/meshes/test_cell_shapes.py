"""Shapes of cells: exact bounds of their maps, and a dense sampling as the reference."""

from itertools import product

import numpy as np
import pytest

from softway.arrays import Array
from softway.kernels.geometry.jacobians import determinants
from softway.meshes.cell_shapes import ROUNDING, cell_shapes
from softway.meshes.cells import CELLS
from softway.meshes.element import tabulate

FILLING = [name for name, cell in CELLS.items() if cell.dim > 1]
CURVED = [name for name in FILLING if CELLS[name].order > 1]


def shape(cell: str, x: Array) -> float:
    """Shape of one cell with nodes at x (a, d)."""
    return float(cell_shapes(cell).of(np.arange(len(x))[None], x, np.zeros_like(x))[0])


def least_determinant(cell: str, x: Array) -> float:
    """Least determinant of the map on 13 points an edge."""
    it = CELLS[cell]
    steps = [p for p in product(range(13), repeat=it.dim) if not it.simplex or sum(p) <= 12]
    _, slopes = tabulate(cell, np.array(steps) / 12.0)
    return float(determinants(np.einsum("ad,qar->qrd", x, slopes)).min())


@pytest.mark.parametrize("cell", FILLING)
def test_it_is_that_of_the_reference_cell_turned_and_scaled(cell: str) -> None:
    """One for squares and cubes; right-angled simplices against equilateral ones: the root of 2/3 and of 1/2."""
    it = CELLS[cell]
    best = {2: np.sqrt(2.0 / 3.0), 3: np.sqrt(0.5)}[it.dim] if it.simplex else 1.0
    turn, _ = np.linalg.qr(np.arange(it.dim**2).reshape(it.dim, it.dim) + np.eye(it.dim))
    turn[:, 0] *= np.sign(np.linalg.det(turn))
    assert shape(cell, 3e-4 * it.nodes @ turn + 5.0) == pytest.approx(best, rel=1e-9)


@pytest.mark.parametrize("cell", CURVED)
def test_a_middle_node_may_go_to_the_quarter_of_its_edge(cell: str) -> None:
    """There the map is singular at the corner, as in the cells of Barsoum for the tip of a crack."""
    x = np.array(CELLS[cell].nodes)
    (middle,) = np.flatnonzero((x[:, 0] == 0.5) & (x[:, 1:] == 0.0).all(axis=1))
    for share, good in ((0.26, True), (0.24, False)):
        x[middle, 0] = share
        assert (shape(cell, x) > ROUNDING) == good == (least_determinant(cell, x) > 0.0)


@pytest.mark.parametrize("cell", FILLING)
def test_folded_cells_are_those_of_a_dense_sampling(cell: str) -> None:
    """Random cells: none is called folded that is not, and those are missed whose fold lies between the points, which
    have a determinant of -.1 at most (one cell of ``tri6`` and one of ``hex20``).
    """
    draws, nodes = np.random.default_rng(5), CELLS[cell].nodes
    folded = good = 0
    for _ in range(150):
        x = nodes + draws.uniform(0.05, 0.9) * draws.uniform(-1.0, 1.0, nodes.shape)
        least, found = least_determinant(cell, x), shape(cell, x)
        folded, good = folded + (least < 0.0), good + (least > 0.0)
        if found <= ROUNDING:
            assert least <= 1e-12
        else:
            assert least > -0.15
    assert folded > 5 and good > 5


def test_a_hexahedron_with_good_corners_may_be_folded_between_them() -> None:
    """Two parallelograms of area 1 and 1/2, with sides turned by 150 degrees against each other to both sides: in the
    middle between their corners the sides have the turned order, and the determinant is -cos(75)^2 sin(60).
    """
    nodes, x = CELLS["hex8"].nodes, np.array(CELLS["hex8"].nodes)
    for at, (one, two) in ((0.0, (0.0, 90.0)), (1.0, (150.0, -60.0))):
        sides = np.radians([one, two])
        mine = nodes[:, 0] == at
        x[mine, 1:] = nodes[mine, 1:] @ np.stack([np.cos(sides), np.sin(sides)], axis=1)
    points = np.vstack([nodes, [[0.5, 0.0, 0.0]]])
    *corners, middle = determinants(np.einsum("ad,qar->qrd", x, tabulate("hex8", points)[1]))
    np.testing.assert_allclose(corners, np.where(nodes[:, 0] == 0.0, 1.0, 0.5), rtol=1e-12)
    assert middle == pytest.approx(-(np.cos(np.radians(75.0)) ** 2) * np.sqrt(0.75))
    assert shape("hex8", x) < 0.0


def test_a_corner_that_lies_flat_on_a_tool_is_good() -> None:
    """Up to rounding, as where a flank folds onto a plane tool; a concave corner is folded."""
    x = np.array([[0.0, 0.0], [1.0, 0.0], [0.5, 0.5], [0.0, 1.0]])
    for beyond, good in ((1e-15, True), (0.0, True), (-1e-15, True), (-1e-3, False)):
        x[2] = 0.5 + beyond
        assert (shape("quad4", x) > ROUNDING) == good
    assert shape("quad4", 0.0 * x) == 0.0
