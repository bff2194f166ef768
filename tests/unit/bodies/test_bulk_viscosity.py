"""Bulk viscosity: smoother fronts, a known dissipation, and nothing where nothing is compressed."""

import numpy as np
import pytest

import softway as sw
from softway.errors import InputError


def fronts(solver: object, shock: sw.bodies.BulkViscosity | None) -> tuple[sw.Step, np.ndarray]:
    """A bar of unit stiffness after half a crossing of the wave that a wall sends, and the stress of its cells."""
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=100),
        material=sw.NeoHookean(E=1.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=0.2),
        mass=sw.bodies.Lumped(),
        shock=shock,
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.0001, normal=-1.0))
    scene = sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=(sw.Contact(between=("bar.right", "wall")),))
    *_, last = sw.march(scene, until=0.5, method=solver)
    return last, sw.build(scene).stress("bar", last.after.displacement["bar"])[:, 0, 0]


@pytest.mark.slow
@pytest.mark.parametrize("solver", [sw.FixedPoint(), sw.Explicit()], ids=["implicit", "explicit"])
def test_a_front_oscillates_less_and_the_loss_is_dissipation(solver):
    plain, rough = fronts(solver, None)
    damped, smooth = fronts(solver, sw.bodies.BulkViscosity())
    assert smooth[60:95].std() < 0.1 * rough[60:95].std()
    assert smooth[60:95].mean() == pytest.approx(rough[60:95].mean(), rel=0.01)
    assert plain.ledger.dissipation == 0.0
    assert 0.01 < damped.ledger.dissipation / damped.ledger.energy_kinetic < 0.2
    exact = isinstance(solver, sw.FixedPoint)
    assert abs(damped.ledger.energy_error) < (1e-12 if exact else 5e-3) * 0.02
    assert abs(damped.certificate.momentum_error) < 1e-14


def block(shock: sw.bodies.BulkViscosity) -> sw.Solid:
    return sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(2, 2, 2)),
        material=sw.laws.StVenantKirchhoff(E=1.0, nu=0.3),
        density=2.0,
        shock=shock,
    )


def pressure(gradient: np.ndarray, shock: sw.bodies.BulkViscosity) -> tuple[float, float]:
    """Power of the viscous force in a homogeneous motion of rate ``gradient``, and the speed of waves."""
    model = sw.build(sw.Scene(bodies={"b": block(shock)}))
    x = model.points
    change = 0.01 * x @ gradient.T
    force = model.shock_force(np.zeros_like(x), change, 0.01)
    return float(np.sum(force * change) / 0.01), model.parts[0].shock.speed


def test_the_pressure_is_the_formula():
    rate = np.diag([-0.3, 0.1, 0.05])  # of ln J: -0.15
    power, c = pressure(rate, sw.bodies.BulkViscosity(linear=0.1, quadratic=2.0))
    q = 2.0 * 0.5 * (0.1 * c * 0.15 + 4.0 * 0.5 * 0.15**2)
    assert power == pytest.approx(q * 0.15, rel=1e-12)


def test_shear_and_spin_feel_nothing_and_expansion_the_linear_part_alone():
    spin = np.array([[0.0, -0.3, 0.2], [0.3, 0.0, 0.1], [-0.2, -0.1, 0.0]])
    shear = np.array([[0.0, 0.5, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    for motion in (spin, shear):
        assert abs(pressure(motion, sw.bodies.BulkViscosity())[0]) < 1e-15
    assert pressure(0.1 * np.eye(3), sw.bodies.BulkViscosity(linear=0.0))[0] == 0.0
    assert pressure(0.1 * np.eye(3), sw.bodies.BulkViscosity())[0] > 0.0


def test_negative_numbers_are_refused():
    for name in ("linear", "quadratic"):
        with pytest.raises(InputError, match=f"{name}: -1 is negative"):
            sw.bodies.BulkViscosity(**{name: -1.0})
