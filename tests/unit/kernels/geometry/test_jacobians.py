"""Geometry of cells."""

import numpy as np
import pytest

from softway.kernels.geometry.jacobians import cell_geometry
from softway.meshes.cells import CELLS
from softway.meshes.element import element


@pytest.mark.parametrize("cell", ["tri3", "tri6", "quad4", "quad8", "quad9", "tet4", "tet10", "hex8", "hex20", "hex27"])
def test_gradients_of_an_affine_field_are_constant(cell: str) -> None:
    table = element(cell)
    dim = table.dN.shape[-1]
    rng = np.random.default_rng(4)
    stretch = np.eye(dim) + 0.1 * rng.standard_normal((dim, dim))
    reference = CELLS[cell].nodes
    corners = (reference @ stretch.T + 0.5)[None]
    gradients, measures, directions = cell_geometry(corners, table.dN, table.weights)
    field = corners[0] @ np.arange(1.0, dim + 1.0)
    assert np.allclose(np.einsum("eqar,a->eqr", gradients, field), np.arange(1.0, dim + 1.0), atol=1e-12)
    assert measures.sum() == pytest.approx(table.weights.sum() * np.linalg.det(stretch), rel=1e-13)
    assert np.array_equal(directions[0, 0], np.eye(dim))


def test_bar_in_space_has_its_length_and_tangent() -> None:
    table = element("bar3")
    corners = np.array([[[0.0, 0.0, 0.0], [1.0, 2.0, 2.0], [0.5, 1.0, 1.0]]])
    gradients, measures, directions = cell_geometry(corners, table.dN, table.weights)
    assert measures.sum() == pytest.approx(3.0, rel=1e-14)
    assert np.allclose(directions, np.array([1.0, 2.0, 2.0]) / 3.0, atol=1e-14)
    along = np.array([0.0, 3.0, 1.5])
    assert np.allclose(np.einsum("eqar,a->eqr", gradients, along), 1.0, atol=1e-13)
