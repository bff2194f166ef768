"""Marches with contact by elimination: iterations, inner steps and the motion of exact contact."""

from dataclasses import dataclass

import numpy as np
import pytest

import softway as sw
from softway.model.model import Model
from softway.solve.constraints.column_cache import ColumnCache
from softway.solve.elimination.closed_rows import ClosedRows
from softway.solve.equations.slab_matrix import SlabMatrix
from softway.solve.linear import conjugate_gradients
from softway.solve.operators import ConjugateGradients, Factored, MatrixFree

Friction = sw.laws.Frictionless | sw.Coulomb
SMOOTH = sw.laws.Frictionless()
WAVES = 116.02
"""Speed of waves of pressure in the cube [m/s]."""
ENERGY = 12.5
"""Energy at the start [J]."""


def cube(cells: int, tilt: float = 0.1, gap: float = 0.05, friction: Friction = SMOOTH) -> sw.Scene:
    """The peers' cube, thrown at a plane turned by ``tilt`` [rad]: its nodes touch one after the other."""
    solid = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(cells,) * 3),
        material=sw.NeoHookean(E=1e4, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(*((0.0, 0.0) if friction == SMOOTH else (2.0, 0.7)), -5.0)),
    )
    normal = (np.sin(tilt), 0.0, np.cos(tilt))
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, -gap), normal=normal))
    contact = sw.Contact(between=("cube.bottom", "floor"), friction=friction)
    return sw.Scene(bodies={"cube": solid, "floor": floor}, contacts=(contact,))


def blocks(friction: Friction = SMOOTH) -> sw.Scene:
    """A block thrown at another one; no node of one surface meets a node of the other."""
    law = {"density": 1.0, "material": sw.NeoHookean(E=1e4, nu=0.3)}
    upper = sw.meshes.Box(size=(0.8, 0.8, 0.8), cells=(4, 4, 4), origin=(0.1, 0.13, 1.01))
    lower = sw.Solid(mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(5, 5, 5)), **law)
    thrown = sw.Solid(mesh=upper, velocity=sw.bodies.Uniform(value=(1.0, 0.4, -5.0)), **law)
    contact = sw.Contact(between=("b.bottom", "a.top"), friction=friction)
    return sw.Scene(bodies={"a": lower, "b": thrown}, contacts=(contact,))


def plate(cells: int) -> sw.Scene:
    """A plate of one layer whose lower face, almost half of its surface, touches a plane."""
    mesh = sw.meshes.Box(size=(1.0, 1.0, 0.1), cells=(cells, cells, 1))
    solid = sw.Solid(mesh=mesh, material=sw.NeoHookean(E=1e4, nu=0.3), density=1.0)
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0)))
    return sw.Scene(bodies={"plate": solid, "floor": floor}, contacts=(sw.Contact(between=("plate.bottom", "floor")),))


def matrix_of(model: Model) -> SlabMatrix:
    return SlabMatrix(model=model, stiffness_factor=1e-7, viscous_factor=0.0)


@dataclass(frozen=True)
class Run:
    """Iterations of a march, the slabs with contact, and its last step."""

    iterations: int
    touching: int
    last: sw.Step

    def state(self, velocity: bool = False) -> np.ndarray:
        after = self.last.after
        return np.concatenate(list((after.velocity if velocity else after.displacement).values()))


def run(scene: sw.Scene, step: float, slabs: int, operator: Factored | MatrixFree | ConjugateGradients) -> Run:
    iterations, touching = 0, 0
    for last in sw.march(scene, until=slabs * step, step=step, method=sw.FixedPoint(operator=operator)):
        iterations += last.report.iterations
        touching += any(c.count for c in last.ledger.contacts.values())
    return Run(iterations, touching, last)


def assert_alike(ours: Run, exact: Run) -> None:
    """The same motion, in which energy is kept."""
    np.testing.assert_allclose(ours.state(), exact.state(), atol=1e-12, rtol=0.0)
    np.testing.assert_allclose(ours.state(velocity=True), exact.state(velocity=True), atol=1e-9, rtol=0.0)
    assert abs(ours.last.ledger.energy_error) < 1e-11 * ENERGY


@pytest.mark.parametrize(
    ("step", "slabs", "most"), [pytest.param(5e-4, 100, 770, marks=pytest.mark.slow), (2e-3, 25, 270)]
)
def test_oblique_impact_takes_the_iterations_of_exact_columns(step: float, slabs: int, most: int) -> None:
    """Nodal blocks alone took 1,211 and 325 iterations."""
    exact, ours = (run(cube(9), step, slabs, o) for o in (Factored(), MatrixFree()))
    assert ours.iterations <= most and ours.touching >= slabs // 2
    assert_alike(ours, exact)
    along = np.array([[np.cos(0.1), 0.0, -np.sin(0.1)], [0.0, 1.0, 0.0]])
    np.testing.assert_allclose(along @ ours.last.ledger.momentum, along @ [0.0, 0.0, -5.0], atol=1e-11)


@pytest.mark.slow
def test_exact_inner_solutions_give_the_iterations_of_exact_columns() -> None:
    exact, ours = (run(cube(9), 2e-3, 25, o) for o in (Factored(), ConjugateGradients(tolerance=1e-6)))
    assert ours.iterations == pytest.approx(exact.iterations, rel=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("courant", [1.16, 4.64])
def test_inner_steps_do_not_grow_with_the_mesh(courant: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """They depend on the cells that a wave crosses in a slab, not on the number of cells."""
    counted: list[int] = []
    descend = conjugate_gradients.Gradients.descend

    def noted(self, *args):
        found = descend(self, *args)
        counted.append(found.steps)
        return found

    monkeypatch.setattr(conjugate_gradients.Gradients, "descend", noted)
    means = []
    for cells in (9, 12, 16):
        counted.clear()
        step = courant / (WAVES * cells)
        found = run(cube(cells), step, int(0.012 / step) + 5, ConjugateGradients())
        assert found.touching >= 4
        means.append(np.mean([steps for steps in counted if steps]))
    assert max(means) <= 1.15 * min(means)


@pytest.mark.parametrize("friction", [SMOOTH, sw.Coulomb(mu=0.3)], ids=["smooth", "rough"])
def test_two_bodies_move_as_with_exact_columns(friction: Friction) -> None:
    exact, ours = (run(blocks(friction), 1e-3, 20, o) for o in (Factored(), ConjugateGradients()))
    assert ours.touching >= 10
    assert_alike(ours, exact)
    np.testing.assert_allclose(ours.last.ledger.momentum, 0.8**3 * np.array([1.0, 0.4, -5.0]), atol=1e-11)
    assert ours.last.ledger.dissipation == pytest.approx(exact.last.ledger.dissipation, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("mu", [0.3, 2.0], ids=["slips", "sticks"])
def test_friction_moves_as_with_exact_columns(mu: float) -> None:
    scene = cube(5, tilt=0.05, gap=0.02, friction=sw.Coulomb(mu=mu))
    exact, ours = (run(scene, 1e-3, 25, o) for o in (Factored(), MatrixFree()))
    assert ours.touching >= 15
    assert_alike(ours, exact)
    assert ours.last.ledger.dissipation == pytest.approx(exact.last.ledger.dissipation, rel=1e-9)


def test_no_columns_are_stored(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where rows open: neither those of the compliance nor solutions for contact directions."""
    stored: list[int] = []
    monkeypatch.setattr(ColumnCache, "reserve", lambda cache, more: stored.append(more))
    run(cube(5), 5e-4, 35, Factored())
    assert sum(stored) > 30
    stored.clear()
    method = sw.FixedPoint(operator=ConjugateGradients())
    steps = sw.march(cube(5), until=0.04, step=5e-4, method=method)
    counts = [step.ledger.contacts[name].count for step in steps for name in step.ledger.contacts]
    assert max(counts) == 36 and counts[-1] < 30 and not stored


def test_memory_of_contact_grows_with_the_surface_alone() -> None:
    """Entries stored for c closed rows of a plate: a few for each row, whatever their number."""
    for cells in (8, 16):
        model = sw.build(plate(cells))
        operator = ConjugateGradients().make(matrix_of(model), np.zeros(model.shape), None)
        rows = model.rows(np.zeros(model.shape))
        closed = ClosedRows.of(rows.matrix(model.dofs), operator.local)
        c, d = (cells + 1) ** 2, 3
        assert closed.matrix.shape[0] == c
        arrays = (closed.matrix, closed.lifted, closed.compliance, closed.pulled, closed.transposed)
        assert max(a.nnz for a in arrays) <= d * c and closed.factor is None
