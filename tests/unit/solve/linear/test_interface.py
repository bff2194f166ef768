"""Conformance of the direct solvers."""

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given
from hypothesis import strategies as st

from softway.bodies.elements.section import PlaneStrain
from softway.bodies.inertia.mass_matrix import Consistent, Lumped, MassRule
from softway.bodies.internal_force.elastic.elastic_force import elastic_force
from softway.bodies.solid import Fixed, Solid
from softway.errors import NoConvergence
from softway.laws.bulk import LinearElastic
from softway.meshes.generators.shapes import rectangle
from softway.model.build import build
from softway.model.scene import Scene
from softway.solve.linear.backends.superlu import SuperLU
from softway.solve.linear.interface import LinearSolver
from softway.solve.linear.mass_solver import mass_solver

SOLVERS = [SuperLU()]
solvers = pytest.mark.parametrize("solver", SOLVERS, ids=lambda s: type(s).__name__)


@solvers
@given(size=st.integers(1, 25), columns=st.integers(1, 4), seed=st.integers(0, 10**6))
def test_a_factor_solves_one_and_several_right_hand_sides(
    solver: LinearSolver, size: int, columns: int, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    sparse = sp.random_array((size, size), density=0.2, rng=rng)
    matrix = sp.csc_array(sparse @ sparse.T + sp.eye_array(size))
    factor = solver.factor(matrix)
    several = rng.normal(size=(size, columns))
    for b in (several, several[:, 0]):
        x = factor.solve(b)
        assert x.shape == b.shape
        np.testing.assert_allclose(matrix @ x, b, atol=1e-10)


@solvers
def test_a_factor_does_not_change_its_arguments(solver: LinearSolver) -> None:
    matrix, b = sp.csc_array(np.array([[2.0, 1.0], [1.0, 3.0]])), np.array([1.0, 2.0])
    factor = solver.factor(matrix)
    first = factor.solve(b)
    matrix.data[:] = 0.0
    np.testing.assert_array_equal(factor.solve(b), first)
    assert b.tolist() == [1.0, 2.0]


@solvers
def test_the_operator_of_a_stiff_body(solver: LinearSolver) -> None:
    body = elastic_force(rectangle((1.0, 1.0), (6, 6)), LinearElastic(E=210e9, nu=0.3), PlaneStrain())
    stiffness = body.tangent(np.zeros((49, 2)))
    matrix = sp.csc_array(stiffness + 1e3 * sp.eye_array(98))
    x = np.random.default_rng(0).normal(size=98)
    found = solver.factor(matrix).solve(matrix @ x)
    assert np.abs(matrix @ (found - x)).max() <= 1e-12 * np.abs(stiffness).max()


@solvers
def test_a_singular_matrix_is_a_failure_of_the_slab(solver: LinearSolver) -> None:
    with pytest.raises(NoConvergence, match="factor"):
        solver.factor(sp.csc_array(np.array([[1.0, 0.0], [0.0, 0.0]])))


@solvers
@pytest.mark.parametrize("odd", [np.nan, np.inf, -np.inf])
def test_a_matrix_with_an_entry_that_is_no_number_is_a_failure_of_the_slab(solver: LinearSolver, odd: float) -> None:
    """As in an inverted cell: one entry is enough."""
    matrix = sp.csc_array(np.array([[2.0, 1.0], [1.0, 2.0]]))
    matrix.data[1] = matrix.data[2] = odd
    with pytest.raises(NoConvergence, match="2 unknowns cannot be factored"):
        solver.factor(matrix)


@pytest.mark.parametrize("mass", [Consistent(), Lumped()], ids=["consistent", "lumped"])
def test_accelerations_of_nodes_on_rollers(mass: MassRule) -> None:
    """Supports of one component couple other nodes than those of the other: ``M a = f`` holds on all free ones."""
    solid = Solid(
        mesh=rectangle((1.0, 1.0), (3, 3)), material=LinearElastic(E=1.0), density=1.0, mass=mass,
        supports=(Fixed(on="left", components="x"), Fixed(on="bottom", components="y")),
    )  # fmt: skip
    model = build(Scene(bodies={"body": solid}))
    force = np.random.default_rng(0).normal(size=model.shape)
    acceleration = mass_solver(model).acceleration(force)
    np.testing.assert_allclose((model.mass @ acceleration)[model.free], force[model.free], atol=1e-13)
    assert not acceleration[~model.free].any()
