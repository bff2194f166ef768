"""The penalty Newton: what springs keep, and what they give away."""

import numpy as np
import pytest

import softway as sw
from softway.marching.start.initial_state import initial_state
from softway.marching.state.model_state import split_states
from softway.model.build import build
from softway.studies.race import Penalty
from softway.studies.race.penalised import penalised
from softway.studies.race.springs import springs


def bar(cells: int = 8, gap: float = 0.1) -> sw.Scene:
    """An elastic bar, E = rho = length = speed = 1, on its way to a wall."""
    solid = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=cells),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=1.0),
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.0 + gap, normal=-1.0))
    return sw.Scene(bodies={"bar": solid, "wall": wall}, contacts=(sw.Contact(between=("bar.right", "wall")),))


def block(speed: tuple[float, float] = (0.0, -0.3), **more) -> sw.Scene:
    """A soft square above a floor."""
    solid = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(4, 4)),
        material=sw.NeoHookean(E=1.0, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=speed),
        **more,
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.02), normal=(0.0, 1.0)))
    return sw.Scene(bodies={"block": solid, "floor": floor}, contacts=(sw.Contact(between=("block.bottom", "floor")),))


def course(scene: sw.Scene, until: float, step: float, method: Penalty | None = None):
    """Start and slabs."""
    model = build(scene)
    state = split_states(model, initial_state(model))
    rules, first, steps = penalised(scene, state, until, step, method or Penalty(), sw.StepControl(least=1e-2))
    return rules, first, list(steps)


def test_the_penetration_falls_like_one_over_the_stiffness():
    """Whatever the springs, their impulse stops the bar and throws it back: the depth in the mean is that over k."""
    depths = []
    for k in (20.0, 80.0):
        rules, first, steps = course(bar(cells=4), 3.5, 0.04, Penalty(stiffness=k, mean="ends"))
        depths.append(0.04 * sum(max(-s.gap, 0.0) for s in steps))
        momentum = float((rules.model.mass @ (first.velocity - steps[-1].velocity)).sum())
        assert 1.8 < momentum <= 2.1
        assert depths[-1] * float(rules.springs[0]) == pytest.approx(momentum, rel=1e-10)
    assert depths[0] / depths[1] == pytest.approx(4.0, rel=0.1)


def test_secant_springs_keep_the_energy_of_a_linear_body():
    _, first, steps = course(bar(), 3.0, 0.05, Penalty(stiffness=1e3, mean="secant"))
    assert min(s.gap for s in steps) < 0.0
    assert max(abs(s.energy - first.energy) for s in steps) < 1e-12 * first.energy


def test_stiff_springs_at_the_ends_of_slabs_gain_energy_and_at_the_last_end_lose_it():
    _, first, steps = course(bar(), 3.0, 0.05, Penalty(stiffness=1e3, mean="ends"))
    assert max(s.energy for s in steps) > 1.01 * first.energy
    _, first, steps = course(bar(), 3.0, 0.05, Penalty(stiffness=1e3, mean="last"))
    energies = np.array([first.energy, *(s.energy for s in steps)])
    assert energies[-1] < 0.99 * first.energy and (np.diff(energies) < 1e-12).all()


@pytest.mark.parametrize("mean", ["last", "ends"])
def test_the_change_of_momentum_is_the_impulse_of_the_springs(mean):
    """Whether each slab takes the force at its end or the mean of both, the sum is the same from free to free."""
    rules, first, steps = course(bar(cells=4), 3.0, 0.05, Penalty(stiffness=1.0, mean=mean))
    impulse = 0.05 * sum(float(s.pressure.sum()) for s in steps)
    momentum = [float((rules.model.mass @ s.velocity).sum()) for s in (first, steps[-1])]
    assert first.pressure.sum() == steps[-1].pressure.sum() == 0.0
    assert momentum[1] < -0.5 and impulse == pytest.approx(momentum[0] - momentum[1], rel=1e-10)


def test_without_contact_it_is_the_trapezoidal_rule():
    scene = sw.Scene(bodies={"bar": sw.Solid(
        mesh=sw.meshes.Rectangle(size=(2.0, 1.0), cells=(4, 2)), material=sw.LinearElastic(E=1.0, nu=0.3), density=1.0,
        velocity=sw.bodies.Affine(gradient=((0.1, 0.0), (0.2, 0.0))), supports=(sw.Fixed(on="left"),),
    )})  # fmt: skip
    rules, _, steps = course(scene, 2.0, 0.1)
    last = list(sw.march(scene, until=2.0, step=0.1))[-1]
    found = rules.model.split(steps[-1].displacement)["bar"]
    np.testing.assert_allclose(found, last.after.displacement["bar"], atol=1e-10)
    assert steps[-1].energy == pytest.approx(last.ledger.energy_kinetic + last.ledger.energy_strain, rel=1e-10)


def test_a_soft_block_bounces_with_quadratic_convergence():
    _, first, steps = course(block(), 3.0, 0.03, Penalty(mean="secant"))
    assert max(s.iterations for s in steps) <= 8 and steps[-1].gap > 0.0
    assert max(abs(s.energy - first.energy) for s in steps) < 1e-2 * first.energy


def test_works_of_loads_and_driven_supports_are_counted():
    """A bar is pulled at one end and pushed by its weight at all nodes."""
    solid = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=4),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        velocity=sw.bodies.OnTag(tag="left", value=0.2),
        supports=(sw.Driven(on="left", velocity=(0.2, 0.2), times=(0.0, 9.0)),),
    )
    scene = sw.Scene(bodies={"bar": solid}, loads=(sw.Gravity(acceleration=-0.3),))
    _, first, steps = course(scene, 2.0, 0.05)
    assert abs(steps[-1].work) > 0.01
    assert max(abs(s.energy - first.energy - s.work) for s in steps) < 1e-12


def test_a_driven_support_moves_by_the_integral_of_its_table():
    """Three slabs of a velocity that rises and falls again: half of a metre, and its work is booked."""
    solid = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=4),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        supports=(sw.Driven(on="left", velocity=(0.0, 1.0, 0.0), times=(0.0, 0.5, 1.0)),),
    )
    _, first, steps = course(sw.Scene(bodies={"bar": solid}), 1.0, 1.0 / 3.0)
    assert len(steps) == 3 and steps[-1].displacement[0, 0] == pytest.approx(0.5, abs=1e-15)
    assert max(abs(s.energy - first.energy - s.work) for s in steps) < 1e-14


def test_the_stiffness_of_springs_follows_the_area():
    model = build(block())
    found = springs(model, 2.0)
    lame = 0.3 / (1.3 * 0.4) + 1.0 / 1.3
    assert found.sum() == pytest.approx(2.0 * lame * 1.0 / 0.25)
    assert sorted(found)[:2] == pytest.approx([0.5 * found.max()] * 2)


def test_wrong_numbers_are_refused():
    with pytest.raises(sw.InputError, match="stiffness"):
        Penalty(stiffness=0.0)


def test_a_limit_too_small_ends_with_the_reason():
    with pytest.raises(sw.NumericsError, match="no time step was accepted.*1 iterations"):
        course(block(), 3.0, 0.03, Penalty(limit=1))
