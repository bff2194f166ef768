"""Bodies that touch nothing."""

from math import cos, sin

import numpy as np
import pytest

from softway.bodies.internal_force.slab_average import (
    AverageField,
    DiscreteGradient,
    EnergyMomentum,
    SlabForce,
    Weighted,
)
from softway.bodies.setup.initial_fields import Affine, Profile, Uniform
from softway.bodies.setup.loads import Gravity
from softway.bodies.solid import Fixed, Solid, Tool
from softway.laws.bulk import LinearElastic, NeoHookean
from softway.marching.march import march
from softway.marching.state.step_control import StepControl
from softway.meshes.generators.recipes import Ring
from softway.meshes.generators.shapes import interval, rectangle
from softway.model.scene import Scene
from softway.model.time_weight import Collocation, EndPeaks, Momentum, TimeWeight, amplification
from softway.obstacles import HalfSpace

WEIGHTS = [EndPeaks(), EndPeaks(theta=0.8), EndPeaks(theta=1.0), Momentum(), Collocation(), Collocation(at=(0.8,))]
weights = pytest.mark.parametrize("weight", WEIGHTS, ids=str)


@weights
def test_free_fall_is_exact(shop, weight: TimeWeight) -> None:
    solid = shop.block((0.3, 0.2), material=shop.linear)
    fall = shop.move(solid, loads=(Gravity(acceleration=(0.0, -0.5)),), until=2.0, step=0.1, weight=weight)
    for s in fall.steps:
        t = s.slab.end
        moved = [0.3 * t, 0.2 * t - 0.25 * t**2]
        np.testing.assert_allclose(s.after.displacement["body"], np.tile(moved, (16, 1)), atol=1e-12)
        np.testing.assert_allclose(s.after.velocity["body"], np.tile([0.3, 0.2 - 0.5 * t], (16, 1)), atol=1e-12)
    assert fall.energy_error <= 1e-12
    assert fall.last.ledger.work_external == pytest.approx(-0.5 * (0.2 * 2.0 - 0.25 * 4.0), rel=1e-12)


@weights
def test_an_oscillator_follows_the_amplification_matrix(shop, weight: TimeWeight) -> None:
    """One bar cell held on the left: omega^2 = 3 E / (rho L^2)."""
    h, omega = 0.2, np.sqrt(3.0)
    solid = shop.bar(1, 0.0, velocity=Profile(at=(0.0, 1.0), values=(0.0, 0.1)), supports=(Fixed(on="left"),))
    swing = shop.move(solid, until=4.0, step=h, weight=weight)
    state = np.array([0.0, h * 0.1])
    for s in swing.steps:
        state = amplification(weight, omega * h) @ state
        assert s.after.displacement["body"][1, 0] == pytest.approx(state[0], abs=1e-11)
        assert s.after.velocity["body"][1, 0] == pytest.approx(state[1] / h, abs=1e-11)


def test_waves_are_exact_at_the_nodes(shop) -> None:
    """Consistent mass, constant weight, h = dx / c: a hat runs along the bar without dispersion."""
    cells, hat = 20, Profile(at=(0.2, 0.4, 0.6), values=(0.0, 0.1, 0.0))
    ends = (Fixed(on="left"), Fixed(on="right"))
    solid = shop.bar(cells, displacement=hat, velocity=Uniform(), supports=ends)
    run = shop.move(solid, until=0.15, step=1.0 / cells, weight=Momentum())
    x = solid.mesh.points[:, 0]

    def start(x: np.ndarray) -> np.ndarray:
        return np.interp(x, hat.at, hat.values)

    for s in run.steps:
        expected = 0.5 * (start(x - s.slab.end) + start(x + s.slab.end))
        np.testing.assert_allclose(s.after.displacement["body"][:, 0], expected, atol=1e-12)


@weights
@pytest.mark.parametrize("dim", [2, 3])
def test_a_vibrating_free_body_keeps_its_momentum(shop, weight: TimeWeight, dim: int) -> None:
    rng = np.random.default_rng(0)
    flow = Affine(value=(0.1, -0.2, 0.05)[:dim], gradient=tuple(map(tuple, 0.1 * rng.normal(size=(dim, dim)))))
    make = shop.block if dim == 2 else shop.cube
    solid = make((0.0,) * dim, velocity=flow)
    fly = shop.move(solid, until=1.0, step=0.1, weight=weight)
    first = (fly.model.mass @ fly.model.velocity).sum(axis=0)
    for s in fly.steps:
        np.testing.assert_allclose(s.ledger.momentum[:dim], first, atol=1e-14)
    assert not fly.last.ledger.momentum[dim:].any()
    assert fly.momentum_error <= 1e-12


FORCES: list[SlabForce] = [Weighted(), AverageField(), AverageField(points=5), DiscreteGradient(), EnergyMomentum()]


def spin(shop, force: SlabForce, step: float, **options: object):
    mesh = rectangle((1.0, 1.0), (2, 2), origin=(-0.5, -0.5))
    turning = Affine(gradient=((0.0, -0.5), (0.5, 0.0)))
    return shop.move(shop.block(mesh=mesh, height=-0.5, velocity=turning, force=force), until=4.0, step=step, **options)


def angular(motion) -> np.ndarray:
    x = motion.model.parts[0].mesh.points
    found = []
    for s in motion.steps:
        at, p = x + s.after.displacement["body"], motion.model.mass @ s.after.velocity["body"]
        found.append(float(np.sum(at[:, 0] * p[:, 1] - at[:, 1] * p[:, 0])))
    return np.array(found)


@pytest.mark.parametrize("force", FORCES, ids=str)
def test_a_spinning_body_keeps_its_energy(shop, force: SlabForce) -> None:
    motion = spin(shop, force, 0.1)
    assert motion.energy_error <= 1e-12
    turned = motion.last.after.displacement["body"]
    assert np.abs(turned).max() > 1.0, "it has turned by more than a right angle"


def test_angular_momentum_is_kept_where_the_force_is_made_for_it_and_of_second_order_otherwise(shop) -> None:
    for force in (DiscreteGradient(), EnergyMomentum()):
        np.testing.assert_allclose(angular(spin(shop, force, 0.1)), 0.25 / 3, atol=1e-13)
    even = StepControl(scalar=1.0)
    for force in (Weighted(), AverageField()):
        drift = [np.abs(angular(spin(shop, force, h, control=even)) - 0.25 / 3).max() for h in (0.2, 0.1)]
        assert 1.7 <= np.log2(drift[0] / drift[1]) <= 2.5


@pytest.mark.parametrize("force", [AverageField(), DiscreteGradient()], ids=str)
def test_chord_averages_need_no_scalar(shop, force: SlabForce) -> None:
    """Their work is the change of the stored energy, up to the quadrature along the chord."""
    motion = spin(shop, force, 0.1)
    assert max(abs(s.report.scalars["body"]) for s in motion.steps) <= 1e-5


@pytest.mark.parametrize("force", FORCES, ids=str)
def test_a_vibrating_body_with_nodes_without_inertia_keeps_its_momentum(shop, force: SlabForce) -> None:
    """Its candidates of contact are far from the floor, and pass on what an average along the chord gives them.

    Ten slabs, each with an error of momentum of the order of the tolerance of 1e-11.
    """
    flow = Affine(value=(0.1, -0.2), gradient=((0.3, 0.2), (-0.1, -0.2)))
    motion = shop.move(shop.block(velocity=flow, force=force, height=9.0), shop.floor, until=1.0, step=0.1)
    assert not motion.model.massive.all() and not any(s.report.rejections for s in motion.steps)
    start = motion.steps[0].ledger.momentum
    assert max(np.abs(s.ledger.momentum - start).max() for s in motion.steps) < 1e-10 * np.abs(start).max()


@pytest.mark.parametrize(("weight", "order"), [(EndPeaks(), 2), (Momentum(), 2), (Collocation(), 2)], ids=str)
def test_order_in_time_of_a_nonlinear_body(shop, weight: TimeWeight, order: int) -> None:
    flow = Affine(gradient=((0.3, 0.1), (0.0, -0.2)))
    ends = [
        shop.move(shop.block(velocity=flow, cells=2), until=0.8, step=h, weight=weight).last.after.velocity["body"]
        for h in (0.1, 0.05, 0.025, 0.0125)
    ]
    errors = [np.abs(a - b).max() for a, b in zip(ends, ends[1:], strict=False)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.35)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(order, abs=0.25)


def test_a_bar_in_space_vibrates_as_the_bar_along_a_line(shop) -> None:
    """Bar elements placed obliquely in the plane, LinearElastic: the axial motion of the 1D bar."""
    direction = np.array([cos(0.7), sin(0.7)])
    line = shop.bar(4, velocity=Profile(at=(0.0, 1.0), values=(0.0, 0.1)))
    mesh = interval(1.0, 4, direction=tuple(direction), dim=2)
    s = np.linspace(0.0, 1.0, 5)[:, None]
    oblique = shop.bar(4, mesh=mesh, velocity=0.1 * s * direction)
    one, two = (shop.move(solid, until=1.0, step=0.1).last.after.velocity["body"] for solid in (line, oblique))
    np.testing.assert_allclose(two @ direction, one[:, 0], atol=1e-12)


def test_bodies_do_not_feel_each_other(shop) -> None:
    flow = Affine(gradient=((0.3, 0.1), (0.0, -0.2)))
    a, b = shop.block(velocity=flow), shop.block(velocity=flow, cell="tri3", material=LinearElastic(E=4.0))
    both = list(march(Scene(bodies={"a": a, "b": b}), until=1.0, step=0.1))[-1]
    for name, solid in (("a", a), ("b", b)):
        alone = shop.move(solid, until=1.0, step=0.1).last
        np.testing.assert_allclose(both.after.velocity[name], alone.after.velocity["body"], atol=1e-11)
    assert both.report.scalars.keys() == {"a", "b"}


def test_a_body_that_flies_unstrained_has_no_scalar(shop) -> None:
    """Its forces are rounding errors, and a scalar that closed their work would be by chance, in every iterate.

    Relative to the kinetic energy, their work in one slab is of the order eps E / (rho v^2); in many, a random walk.
    """
    ring = Solid(
        mesh=Ring(inner=0.026, outer=0.03, cells=(2, 12)),
        material=NeoHookean(E=1e8, nu=0.4),
        density=1100.0,
        velocity=Uniform(value=(3.0, -1.0)),
        force=EnergyMomentum(),
    )
    far = Tool(shape=HalfSpace(point=(1.0, 0.0), normal=(-1.0, 0.0)))
    flight = shop.move(ring, {"wall": far}, tag="outer", until=4e-3, step=1e-4)
    assert len(flight.steps) == 40
    assert all(s.report.scalars["body"] == 0.0 for s in flight.steps)
    rounding = np.finfo(float).eps * 1e8 / (1100.0 * (3.0**2 + 1.0**2))
    assert abs(flight.last.ledger.energy_error) < np.sqrt(40) * rounding * flight.last.ledger.energy_kinetic
    assert max(s.report.iterations for s in flight.steps) <= 2
