"""When a new factor is ordered, how nodes turn, and which operator is chosen."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.spatial.transform import Rotation

import softway as sw
from softway.bodies.dof_map import NodalDofs
from softway.model.build import build
from softway.model.model import Model
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.equations.slab_matrix import SlabMatrix
from softway.solve.linear.conjugate_gradients import Gradients
from softway.solve.operators import ConjugateGradients, Factored, MatrixFree, Multigrid, choose_operator
from softway.solve.operators.matrix_free import Blocks
from softway.solve.operators.nodal_rotation import nodal_rotation
from softway.solve.operators.operator_memory import OperatorMemory


def after(iterations: Sequence[int], price: float) -> list[bool]:
    """Whether a factor is ordered after each slab."""
    memory, ordered = OperatorMemory(price=price), []
    for count in iterations:
        memory = memory.after(count)
        ordered.append(memory.stale)
    return ordered


def test_a_factor_is_ordered_where_slabs_cost_more_than_on_average_with_the_factor() -> None:
    """Iterations n that grow by one a slab, from 8: n > (8 + ... + n + price) / slabs, and half as many again."""
    taken = list(range(8, 40))
    for price in (10.0, 40.0, 90.0):
        first = after(taken, price).index(True)
        recent = 0.5 * (taken[first] + taken[first - 1])
        assert recent > max((sum(taken[: first + 1]) + price) / (first + 1), 12.0)
        recent = 0.5 * (taken[first - 1] + taken[first - 2])
        assert recent <= max((sum(taken[:first]) + price) / first, 12.0)


def test_steady_slabs_never_ask_for_a_factor() -> None:
    assert not any(after([7, 8] * 50, 10.0))
    assert not any(after([1, 1, 1, *[8] * 50], 10.0)), "slabs of free flight are easier than the rest"


@pytest.fixture
def beam() -> Model:
    solid = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 0.2, 0.2), cells=(5, 1, 1)), material=sw.NeoHookean(E=1.0, nu=0.3), density=1.0
    )
    return build(sw.Scene(bodies={"beam": solid}))


def test_nodes_turn_with_their_body(beam: Model) -> None:
    """A stretch along the axes and then a rotation: R is the rotation, at every node."""
    Q = Rotation.from_rotvec([0.3, -0.4, 1.1]).as_matrix()
    F = Q @ np.diag([1.2, 0.9, 1.0])
    u = beam.points @ (F - np.eye(3)).T + 0.7
    R = nodal_rotation(beam.parts).since(beam.space, np.zeros(beam.shape), u, beam.dofs)
    assert R is not None
    np.testing.assert_allclose(R.toarray(), np.kron(np.eye(len(u)), Q), atol=1e-12)


def test_a_turned_factor_is_the_factor_of_the_turned_body(beam: Model) -> None:
    Q = Rotation.from_rotvec([0.3, -0.4, 1.1]).as_matrix()
    rng = np.random.default_rng(0)
    u = 0.02 * rng.normal(size=beam.shape)
    turned = (beam.points + u) @ Q.T - beam.points
    K0, K1 = (beam.inertia_and_stiffness(x, 0.3).toarray() for x in (u, turned))
    R = nodal_rotation(beam.parts).since(beam.space, u, turned, beam.dofs).toarray()
    np.testing.assert_allclose(R @ K0 @ R.T, K1, atol=1e-13)


def test_supported_nodes_and_small_rotations_do_not_turn(beam: Model) -> None:
    free = beam.free.copy()
    free[0] = False
    Q = Rotation.from_rotvec([0.0, 0.0, 1.0]).as_matrix()
    u = beam.points @ (Q - np.eye(3)).T
    R = nodal_rotation(beam.parts).since(beam.space, np.zeros(beam.shape), u, NodalDofs(free))
    assert R.shape == (beam.free.size - 3, beam.free.size - 3)
    np.testing.assert_allclose((R.T @ R).toarray(), np.eye(R.shape[0]), atol=1e-12)
    free[:, 0] = False
    R = nodal_rotation(beam.parts).since(beam.space, np.zeros(beam.shape), u, NodalDofs(free))
    assert R is None, "nodes that slide along supports keep their directions"
    assert nodal_rotation(beam.parts).since(beam.space, np.zeros(beam.shape), 0.01 * u, NodalDofs(free)) is None


@pytest.fixture
def slab(block: Callable[..., Model]) -> Callable[[float], SlabEquations]:
    """A slab that waves cross a number of cells in, between many cells in space."""

    def make(courant: float, cells: int = 2) -> SlabEquations:
        from softway.contact.slab_motion.trajectory import Trajectory, contact_events
        from softway.solve.constraints.normal_active_set import RowConditions
        from softway.solve.equations.mean_force import WeightedMean
        from softway.solve.equations.slab_contact import FixedContact, InitialContact
        from softway.solve.equations.slab_values import SlabStart

        mesh = sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(cells,) * 3)
        solid = sw.Solid(mesh=mesh, material=sw.NeoHookean(E=1.0, nu=0.0), density=1.0)
        model = build(sw.Scene(bodies={"cube": solid}))
        zero = np.zeros(model.shape)
        none = np.zeros(0, bool)
        path = Trajectory(
            span=courant / cells, start=zero, velocity=zero, massive=model.massive, free=model.free,
            rows=model.rows(zero), events=contact_events(none),
        )  # fmt: skip
        start = SlabStart(displacement=zero, velocity=zero, force=zero, energy=np.zeros(1))
        contact = FixedContact(
            rows=path.rows,
            conditions=RowConditions(target=np.zeros(0), equal=none, unilateral=none),
            initial=InitialContact(rows=path.rows, pressure=np.zeros(0), traction=np.zeros((0, 3))),
        )
        weight = sw.model.EndPeaks()
        return SlabEquations(
            model=model, start=start, weight=weight, path=path, average=WeightedMean(weight), contact=contact
        )

    return make


def test_the_choice_of_the_operator_and_its_reason(slab: Callable[..., SlabEquations]) -> None:
    plenty, little = 1e12, 1e4
    chosen = choose_operator(slab(1.0), plenty)
    assert isinstance(chosen.operator, Factored)
    assert "81 unknowns" in chosen.reason and "serves many slabs" in chosen.reason
    small = choose_operator(slab(1.0), little)
    assert isinstance(small.operator, MatrixFree)
    assert "memory" in small.reason
    long = choose_operator(slab(200.0), little)
    assert isinstance(long.operator, MatrixFree | Multigrid)


def test_products_are_preferred_where_they_cost_less_than_a_solution_with_the_factor(
    slab: Callable[..., SlabEquations], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A factor of so few unknowns is cheap; dearer ones are left out in short slabs of compact bodies."""
    assert isinstance(choose_operator(slab(0.1), 1e12).operator, Factored)
    monkeypatch.setattr("softway.solve.operators.choice.STREAM", 1.0)
    chosen = choose_operator(slab(0.1), 1e12)
    assert isinstance(chosen.operator, ConjugateGradients) and "cost less than a solution" in chosen.reason
    assert isinstance(choose_operator(slab(200.0), 1e12).operator, Factored)


def test_a_linear_body_of_many_unknowns_has_a_factor_in_double_precision() -> None:
    """One solution then solves a slab; large deformations take several, by a factor in single precision."""
    mesh = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(32, 32))
    for law, kind in ((sw.LinearElastic(E=1.0, nu=0.3), np.float64), (sw.NeoHookean(E=1.0, nu=0.3), np.float32)):
        model = build(sw.Scene(bodies={"b": sw.Solid(mesh=mesh, material=law, density=1.0)}))
        matrix = SlabMatrix(model=model, stiffness_factor=0.01, viscous_factor=0.0)
        assert Factored().make(matrix, model.displacement, None).kind is kind


@pytest.mark.parametrize("tolerance", [1e-2, 1e-6])
def test_gradients_end_at_their_tolerance(tolerance: float) -> None:
    """The residual, relative to the right side, in the norm of the preconditioner."""
    rng = np.random.default_rng(2)
    root = rng.normal(size=(60, 80))
    matrix, b = root @ root.T, rng.normal(size=60)
    jacobi = Blocks(sp.csr_array(np.diag(1.0 / np.diag(matrix))))
    left = b - matrix @ Gradients(lambda x: matrix @ x, jacobi, tolerance, 500).solve(b)
    assert left @ jacobi.solve(left) <= tolerance**2 * (b @ jacobi.solve(b))


def test_gradients_end_before_a_direction_of_negative_curvature() -> None:
    """At the start, or after the steps that decrease the energy ``x A x / 2 - b x``."""
    matrix = np.diag([1.0, -1.0])
    gradients = Gradients(lambda x: matrix @ x, Blocks(sp.csr_array(np.eye(2))), 1e-12, 500)
    assert gradients.solve(np.array([1.0, 2.0])).tolist() == [0.0, 0.0]
    assert gradients.solve(np.array([1.0, 0.5])) == pytest.approx(5.0 / 3.0 * np.array([1.0, 0.5]), rel=1e-12)


def test_multigrid_is_chosen_for_long_slabs_without_memory(slab: Callable[..., SlabEquations]) -> None:
    pytest.importorskip("pyamg")
    assert isinstance(choose_operator(slab(200.0), 1e4).operator, Multigrid)


@pytest.mark.parametrize(
    ("make", "where"),
    [
        (lambda: MatrixFree(tolerance=0.0), "tolerance"),
        (lambda: replace(MatrixFree(), limit=0), "limit"),
        (lambda: Multigrid(tolerance=2.0), "tolerance"),
        (lambda: Multigrid(limit=0), "limit"),
    ],
)
def test_impossible_values_are_refused(make: Callable[[], object], where: str) -> None:
    with pytest.raises(sw.InputError, match=where):
        make()
