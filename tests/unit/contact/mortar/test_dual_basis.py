"""Dual shape functions on facets covered completely, in part, and hardly."""

import numpy as np
import pytest

from softway.contact.mortar.dual_basis import dual_basis, warping
from softway.kernels.mortar.dual_basis import DUAL, MEAN
from softway.meshes.element import element


def covered(cell: str, inside: np.ndarray) -> tuple[np.ndarray, float]:
    """Mass (1, b, b) of the part of a reference cell that a parallelogram or triangle of map ``inside`` covers.

    ``inside`` (r + 1, r): origin and edges of the part in the reference coordinates.
    """
    table = element(cell, 4)
    points = inside[0] + table.points @ inside[1:]
    volume = abs(np.linalg.det(inside[1:])) * table.weights
    shapes = SHAPES[cell](points)
    return np.einsum("q,qa,qb->ab", volume, shapes, shapes)[None], float(volume.sum() / table.weights.sum())


SHAPES = {
    "bar2": lambda x: np.stack([1.0 - x[:, 0], x[:, 0]], axis=1),
    "tri3": lambda x: np.stack([1.0 - x[:, 0] - x[:, 1], x[:, 0], x[:, 1]], axis=1),
}
PARTS = {
    "bar2": np.array([[0.2], [0.5]]),
    "tri3": np.array([[0.1, 0.2], [0.6, 0.1], [0.0, 0.5]]),
}


@pytest.mark.parametrize("cell", ["bar2", "tri3"])
def test_the_functions_are_dual_on_the_covered_part(cell: str) -> None:
    mass, fraction = covered(cell, PARTS[cell])
    assert fraction < 1.0
    made = dual_basis(mass, np.array([DUAL]))
    products = made.coefficients @ mass
    assert np.allclose(products, made.own, atol=1e-14)
    assert np.array_equal(made.own[0], np.diag(mass[0].sum(axis=1)))


@pytest.mark.parametrize("fraction", [1.0, 0.5, DUAL, 0.05, 2.0 * MEAN, MEAN, 1e-6])
@pytest.mark.parametrize("cell", ["bar2", "tri3"])
def test_the_functions_add_up_to_one(cell: str, fraction: float) -> None:
    part = np.concatenate(
        [np.full((1, PARTS[cell].shape[1]), 0.3 * (1.0 - fraction)), fraction * np.eye(PARTS[cell].shape[1])]
    )
    mass, _ = covered(cell, part)
    made = dual_basis(mass, np.array([fraction]))
    rounding = 1e-15 * (1.0 if fraction <= MEAN else np.linalg.cond(mass[0]))
    assert np.allclose(made.coefficients.sum(axis=1), 1.0, atol=rounding)
    assert np.allclose(made.own.sum(axis=2), mass.sum(axis=2), rtol=1e-14)
    assert (made.own >= 0.0).all()


def test_hardly_covered_facets_are_weighted_by_their_shape_functions() -> None:
    mass, _ = covered("bar2", np.array([[0.4], [1e-4]]))
    made = dual_basis(mass, np.array([1e-4]))
    assert np.array_equal(made.coefficients[0], np.eye(2))
    assert np.array_equal(made.own, mass)


def test_the_warped_function_is_orthogonal_to_linear_ones() -> None:
    rng = np.random.default_rng(8)
    flat = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    flat = flat + 0.3 * np.concatenate([rng.uniform(-1.0, 1.0, (5, 4, 2)), np.zeros((5, 4, 1))], axis=2)
    turn = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    corners = flat @ turn.T
    nodal = warping(corners)
    assert np.allclose(nodal.sum(axis=1), 0.0, atol=1e-14)
    assert np.allclose(np.einsum("fk,fki->fi", nodal, corners), 0.0, atol=1e-14)


def test_a_four_node_facet_covered_within_one_of_its_triangles() -> None:
    """Two of the functions are the same there; the fit is the linear one, and a linear field comes out exactly."""
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.2, 1.1, 0.0], [0.1, 0.9, 0.0]])
    shapes = np.array([[0.8, 0.1, 0.05, 0.05], [0.2, 0.7, 0.05, 0.05], [0.4, 0.4, 0.1, 0.1]])
    mass = 0.2 / 12.0 * (shapes.T @ shapes + np.outer(shapes.sum(axis=0), shapes.sum(axis=0)))
    made = dual_basis(mass[None], np.array([DUAL]), warping(corners[None]))
    fitted = np.einsum("ab,bi->ai", made.coefficients[0] @ mass, corners) / mass.sum(axis=1)[:, None]
    assert np.allclose(fitted, corners, atol=1e-9)
    assert np.allclose(made.coefficients[0].sum(axis=0), 1.0, atol=1e-9)
