"""Marches with contact by elimination: iterations, inner steps and the motion of exact contact."""

from dataclasses import dataclass

import numpy as np
import pytest

import softway as sw
from softway.solve.linear import conjugate_gradients
from softway.solve.operators import ConjugateGradients, Factored, MatrixFree

WAVES = 116.02
"""Speed of waves of pressure in the cube [m/s]."""
ENERGY = 12.5
"""Energy at the start [J]."""


def cube(cells: int, tilt: float = 0.1, gap: float = 0.05, friction: sw.Coulomb | None = None) -> sw.Scene:
    """The peers' cube, thrown at a plane turned by ``tilt`` [rad]: its nodes touch one after the other."""
    solid = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(cells,) * 3),
        material=sw.NeoHookean(E=1e4, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0 if friction is None else 2.0, 0.0 if friction is None else 0.7, -5.0)),
    )
    normal = (np.sin(tilt), 0.0, np.cos(tilt))
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, -gap), normal=normal))
    contact = sw.Contact(between=("cube.bottom", "floor"), friction=friction)
    return sw.Scene(bodies={"cube": solid, "floor": floor}, contacts=(contact,))


def blocks(friction: sw.Coulomb | None = None) -> sw.Scene:
    """A block thrown at another one; no node of one surface meets a node of the other."""
    law = {"density": 1.0, "material": sw.NeoHookean(E=1e4, nu=0.3)}
    upper = sw.meshes.Box(size=(0.8, 0.8, 0.8), cells=(4, 4, 4), origin=(0.1, 0.13, 1.01))
    lower = sw.Solid(mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(5, 5, 5)), **law)
    thrown = sw.Solid(mesh=upper, velocity=sw.bodies.Uniform(value=(1.0, 0.4, -5.0)), **law)
    contact = sw.Contact(between=("b.bottom", "a.top"), friction=friction)
    return sw.Scene(bodies={"a": lower, "b": thrown}, contacts=(contact,))


@dataclass(frozen=True)
class Run:
    """Iterations of a march, the slabs with contact, its last step, and the greatest of its columns stored."""

    iterations: int
    touching: int
    last: sw.Step
    columns: int

    def state(self, velocity: bool = False) -> np.ndarray:
        after = self.last.after
        return np.concatenate(list((after.velocity if velocity else after.displacement).values()))


def run(scene: sw.Scene, step: float, slabs: int, operator: Factored | MatrixFree | ConjugateGradients) -> Run:
    iterations, touching, columns = 0, 0, 0
    for last in sw.march(scene, until=slabs * step, step=step, method=sw.FixedPoint(operator=operator)):
        iterations += last.report.iterations
        touching += any(c.count for c in last.ledger.contacts.values())
        frozen = last.march_state.memory.frozen if last.march_state.memory is not None else None
        columns = max(columns, 0 if frozen is None else frozen.table.count + frozen.solutions.count)
    return Run(iterations, touching, last, columns)


def assert_alike(ours: Run, exact: Run) -> None:
    """The same motion; energy and momentum are kept."""
    np.testing.assert_allclose(ours.state(), exact.state(), atol=1e-12, rtol=0.0)
    np.testing.assert_allclose(ours.state(velocity=True), exact.state(velocity=True), atol=1e-9, rtol=0.0)
    assert abs(ours.last.ledger.energy_error) < 1e-11 * ENERGY


@pytest.mark.parametrize(("step", "slabs", "most"), [(5e-4, 100, 770), (2e-3, 25, 270)])
def test_oblique_impact_takes_the_iterations_of_exact_columns(step: float, slabs: int, most: int) -> None:
    """Nodal blocks alone took 1,211 and 325 iterations."""
    exact, ours = (run(cube(9), step, slabs, o) for o in (Factored(), MatrixFree()))
    assert ours.iterations <= most and ours.touching >= slabs // 2
    assert_alike(ours, exact)


def test_exact_inner_solutions_give_the_iterations_of_exact_columns() -> None:
    exact, ours = (run(cube(9), 2e-3, 25, o) for o in (Factored(), ConjugateGradients(tolerance=1e-6)))
    assert ours.iterations == pytest.approx(exact.iterations, rel=0.01)


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


@pytest.mark.parametrize("friction", [None, sw.Coulomb(mu=0.3)], ids=["smooth", "rough"])
def test_two_bodies_move_as_with_exact_columns(friction: sw.Coulomb | None) -> None:
    exact, ours = (run(blocks(friction), 1e-3, 20, o) for o in (Factored(), ConjugateGradients()))
    assert ours.touching >= 10
    assert_alike(ours, exact)
    assert ours.last.ledger.dissipation == pytest.approx(exact.last.ledger.dissipation, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("mu", [0.3, 2.0], ids=["slips", "sticks"])
def test_friction_moves_as_with_exact_columns(mu: float) -> None:
    scene = cube(5, tilt=0.05, gap=0.02, friction=sw.Coulomb(mu=mu))
    exact, ours = (run(scene, 1e-3, 25, o) for o in (Factored(), MatrixFree()))
    assert ours.touching >= 15
    assert_alike(ours, exact)
    assert ours.last.ledger.dissipation == pytest.approx(exact.last.ledger.dissipation, rel=1e-9)


def test_no_columns_are_stored() -> None:
    """Also where rows open: neither those of the compliance nor solutions for contact directions."""
    scene = cube(5)
    assert run(scene, 5e-4, 80, Factored()).columns > 30
    found = run(scene, 5e-4, 80, ConjugateGradients())
    assert found.touching < 60 and found.last.ledger.contacts and found.columns == 0
