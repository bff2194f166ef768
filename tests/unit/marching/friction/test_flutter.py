"""Flutter of elastic bodies that slide: eigenvalues, growth in marches, and damping that stops it."""

import numpy as np
import pytest

import softway as sw
from softway.marching.friction.flutter import sliding_flutter
from softway.marching.start.initial_state import initial_state
from softway.model.model import Model

WEIGHT = 1.5e-3
SIZE = (1.5, 1.0)


def sliding(mu: float, cells: tuple[int, int] = (6, 4), damping_time: float = 0.0, shaken: float = 0.0) -> sw.Scene:
    """A block of unit moduli that slides for long on a floor; a ``shaken`` one starts out of equilibrium."""
    elastic: sw.LinearElastic | sw.laws.Kelvin = sw.LinearElastic(E=1.0, nu=0.25)
    if damping_time:
        elastic = sw.laws.Kelvin(E=1.0, nu=0.25, shear_viscosity=damping_time / 2.5, bulk_viscosity=damping_time / 1.5)
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=SIZE, cells=cells),
        material=elastic,
        density=1.0,
        velocity=sw.bodies.Uniform(value=(100.0, 0.0)),
    )
    weight = WEIGHT / 1.5
    steady = (weight * mu * (1.0 + shaken), -weight * (1.0 + shaken))
    return sw.Scene(
        bodies={"block": block, "floor": sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))},
        contacts=(sw.Contact(between=("block.bottom", "floor"), name="floor", friction=sw.Coulomb(mu=mu)),),
        loads=(sw.Gravity(acceleration=(0.0, -weight)),),
        start=sw.model.StaticStart(loads=(sw.Gravity(acceleration=steady),)),
    )


def condensed(model: Model, mass: np.ndarray, mu: float, closed: np.ndarray | None = None) -> np.ndarray:
    """Complex frequencies of a sliding block with nodal masses (n, n), its bottom without, condensed: dense algebra.

    Nodes of the bottom that are not ``closed`` (m,) are free; by default all are.
    """
    n, stiffness = model.shape[0], model.tangent(model.displacement).toarray()
    bottom = np.flatnonzero(model.points[:, 1] < 1e-9)
    touch = bottom if closed is None else model.contacts.node[closed]
    opened = np.setdiff1d(bottom, touch)
    inner = np.setdiff1d(np.arange(2 * n), np.r_[2 * bottom, 2 * bottom + 1])
    light = np.r_[2 * touch, 2 * opened, 2 * opened + 1]
    force = stiffness[light]
    force[: len(touch)] += mu * stiffness[2 * touch + 1]
    full = stiffness[np.ix_(inner, inner)] - stiffness[np.ix_(inner, light)] @ np.linalg.solve(
        force[:, light], force[:, inner]
    )
    inertia = np.kron(mass, np.eye(2))[np.ix_(inner, inner)]
    return np.sqrt(np.linalg.eigvals(np.linalg.solve(inertia, full)).astype(complex))


def moved_mass(model: Model) -> np.ndarray:
    """Lumped masses (n, n), those of the bottom moved to the nodes above."""
    x, y = model.points.T
    width, height = (np.where((v < 1e-9) | (v > s - 1e-9), 0.125, 0.25) for v, s in zip((x, y), SIZE, strict=True))
    mass = width * height
    bottom, above = np.flatnonzero(y < 1e-9), np.flatnonzero(np.abs(y - 0.25) < 1e-9)
    mass[above] += mass[bottom[np.argsort(x[bottom])]][np.argsort(np.argsort(x[above]))]
    mass[bottom] = 0.0
    return np.diag(mass)


@pytest.mark.parametrize(
    ("mu", "growth", "frequency"), [(0.1, 0.0071, 2.24), (0.2, 0.0316, 2.24), (0.4, 0.0691, 2.245), (0.7, 0.2, 1.34)]
)
def test_a_block_flutters_as_its_condensed_stiffness_says(mu: float, growth: float, frequency: float) -> None:
    """With lumped masses moved from the contact, and with the masses of the model."""
    model = sw.build(sliding(mu))
    rates = condensed(model, moved_mass(model), mu)
    worst = rates[np.argmin(rates.imag)]
    assert -worst.imag == pytest.approx(growth, rel=0.01) and worst.real == pytest.approx(frequency, rel=0.01)
    state = initial_state(model)
    rates, modes = condensed(model, model.mass.toarray(), mu, state.closed), sliding_flutter(model, state)
    rates = rates[-rates.imag > 1e-4 * np.abs(rates)]
    assert len(modes) == len(rates) > 0
    assert np.array([m.growth for m in modes]) == pytest.approx(-rates.imag[np.argsort(rates.real)], rel=1e-8)
    assert np.array([m.frequency for m in modes]) == pytest.approx(np.sort(rates.real), rel=1e-8)


def test_the_slowest_modes_of_many_unknowns_are_those_of_all() -> None:
    model = sw.build(sliding(0.4, cells=(18, 12)))
    state = initial_state(model)
    rates, modes = condensed(model, model.mass.toarray(), 0.4, state.closed), sliding_flutter(model, state)
    assert len(modes) > 2
    for mode in modes:
        assert np.abs(rates - mode.frequency + 1j * mode.growth).min() < 1e-6


def test_no_friction_and_little_friction_have_no_flutter() -> None:
    for mu in (0.0, 0.02):
        model = sw.build(sliding(mu))
        assert sliding_flutter(model, initial_state(model)) == ()


def noise(scene: sw.Scene, slabs: int, step: float) -> np.ndarray:
    """Greatest deviation (slabs,) of a normal force from its mean over the march, relative to the weight."""
    forces = np.array([s.after.pressure["floor"] for s in sw.march(scene, until=slabs * step, step=step)])
    return np.asarray(np.abs(forces - forces.mean(axis=0)).max(axis=1) / WEIGHT)


@pytest.mark.slow
def test_a_march_grows_as_the_eigenvalues_say() -> None:
    """So flutter belongs to the sliding body, and the time integration adds nothing to it."""
    scene = sliding(0.4, shaken=1e-6)
    model = sw.build(scene)
    told = max(mode.in_slabs(3.0) for mode in sliding_flutter(model, initial_state(model)))
    found = noise(scene, 700, 3.0)
    windows = [found[k : k + 100].max() for k in (400, 600)]
    assert told == pytest.approx(1.0150, abs=1e-4)
    assert (windows[1] / windows[0]) ** (1.0 / 200.0) == pytest.approx(told, abs=2e-3)


@pytest.mark.slow
def test_a_damped_block_does_not_flutter() -> None:
    """By viscosities a little above those of the worst mode."""
    scene = sliding(0.4)
    model = sw.build(scene)
    least = max(mode.damping_time for mode in sliding_flutter(model, initial_state(model)))
    assert least == pytest.approx(0.0243, rel=0.01)
    found = noise(sliding(0.4, damping_time=0.04, shaken=1e-3), 300, 3.0)
    assert found[-50:].max() < 0.1 * found[:50].max()
