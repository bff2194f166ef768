"""Tables of the cells: every one a Lagrange or serendipity element in VTK order with exact quadrature."""

from itertools import product
from math import factorial

import numpy as np
import pytest

from softway.errors import InputError
from softway.meshes.element import CELLS, FACETS, element, exact_degree, permutation, stiffness_degree, tabulate

NAMES = list(FACETS)


@pytest.mark.parametrize("cell", NAMES)
def test_shape_functions_are_one_at_their_node_and_sum_to_one(cell: str) -> None:
    N, dN = tabulate(cell, CELLS[cell].nodes)
    assert np.abs(N - np.eye(len(N))).max() < 1e-13
    table = element(cell)
    assert np.abs(table.N.sum(axis=1) - 1.0).max() < 1e-13
    assert np.abs(table.dN.sum(axis=1)).max() < 1e-13


@pytest.mark.parametrize("cell", NAMES)
def test_full_polynomials_of_the_order_are_reproduced(cell: str) -> None:
    it = CELLS[cell]
    points = np.random.default_rng(0).uniform(0.1, 0.3, (5, it.dim))
    N, dN = tabulate(cell, points)
    for powers in it.powers:
        nodal = np.prod(it.nodes**powers, axis=1)
        assert np.abs(N @ nodal - np.prod(points**powers, axis=1)).max() < 1e-13
        for k, power in enumerate(powers):
            lower = np.array(powers) - np.eye(it.dim, dtype=int)[k]
            wanted = power * np.prod(points ** np.maximum(lower, 0), axis=1)
            assert np.abs(dN[:, :, k] @ nodal - wanted).max() < 1e-12


@pytest.mark.parametrize("cell", NAMES)
@pytest.mark.parametrize("curved", [False, True])
def test_quadrature_integrates_monomials_exactly(cell: str, curved: bool) -> None:
    it, degree = CELLS[cell], exact_degree(cell, curved=curved)
    table = element(cell, degree)
    assert curved or table.weights.min() > 0.0
    for powers in product(range(degree + 1), repeat=it.dim):
        if it.simplex and sum(powers) > degree:
            continue
        if it.simplex:  # Dirichlet's integral
            exact = np.prod([factorial(p) for p in powers]) / factorial(sum(powers) + it.dim)
        else:
            exact = np.prod([1.0 / (p + 1) for p in powers])
        assert abs(table.weights @ np.prod(table.points**powers, axis=1) - exact) < 1e-13


@pytest.mark.parametrize("cell", NAMES)
def test_facets_are_faces_of_the_reference_cell_turned_outward(cell: str) -> None:
    it = CELLS[cell]
    centre = it.nodes.mean(axis=0)
    for facet, local in FACETS[cell]:
        x = it.nodes[list(local)]
        assert len(local) == len(CELLS[facet].nodes)
        if it.dim == 2:
            normal = np.array([x[1, 1] - x[0, 1], x[0, 0] - x[1, 0]])
        elif it.dim == 3:
            normal = np.cross(x[1] - x[0], x[2] - x[0])
        else:
            continue
        assert normal @ (x.mean(axis=0) - centre) > 0.0
        assert np.abs((x - x[0]) @ normal).max() < 1e-14
        if CELLS[facet].order == 2:
            linear = {"bar3": "bar2", "tri6": "tri3", "quad8": "quad4", "quad9": "quad4"}[facet]
            assert np.abs(tabulate(linear, CELLS[facet].nodes)[0] @ x[: CELLS[facet].corners] - x).max() < 1e-14


def test_permutation_is_one_and_degrees_suffice() -> None:
    for cell in NAMES:
        assert sorted(permutation(cell)) == list(range(len(CELLS[cell].nodes)))
        assert stiffness_degree(cell) <= exact_degree(cell)


def test_unknown_cell_is_refused() -> None:
    with pytest.raises(InputError, match="hex21"):
        element("hex21")
