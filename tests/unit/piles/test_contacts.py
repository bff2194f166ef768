"""Contacts of balls: collisions, sliding and rolling against exact solutions, and the conservation laws."""

import numpy as np
import pytest

from softway.piles import Balls, Pile, PileStep, Wall, box, lattice, march

BALL = {"radius": 0.1, "density": 1000.0}
FLOOR = Wall(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0))
DOWN = (0.0, 0.0, -9.81)


def marched(pile: Pile, until: float, step: float, **options: int) -> list[PileStep]:
    """Steps of a march."""
    return list(march(pile, until=until, step=step, **options))


def thrown(restitution: float, friction: float) -> Pile:
    """125 balls that fly and turn at random."""
    random = np.random.default_rng(1)
    places = lattice(count=(5,) * 3, radius=0.05, density=1.0, lowest=(0.1,) * 3, spacing=0.15, jitter=0.02).centres
    velocities, spins = random.normal(size=(2, 125, 3))
    balls = Balls(centres=places, radius=0.05, density=1000.0, velocities=velocities, spins=spins)
    return Pile(balls=balls, restitution=restitution, friction=friction)


@pytest.mark.parametrize("restitution", [1.0, 0.5, 0.0])
@pytest.mark.parametrize("dim", [2, 3])
def test_two_balls_meet_head_on(restitution: float, dim: int) -> None:
    """Velocities after an impact of equal balls, exact: (1 - e)/2 and (1 + e)/2; rounding of 1 m/s."""
    centres, velocities = np.zeros((2, 2, dim))
    centres[1, 0], velocities[0, 0] = 0.5, 1.0
    balls = Balls(centres=centres, velocities=velocities, **BALL)
    last = marched(Pile(balls=balls, restitution=restitution), 1.0, 0.013)[-1]
    assert last.velocities[:, 0] == pytest.approx([0.5 * (1.0 - restitution), 0.5 * (1.0 + restitution)], abs=1e-14)
    assert np.abs(last.velocities[:, 1:]).max() < 1e-14
    lost = 0.25 * balls.mass[0] * (1.0 - restitution**2)
    assert last.dissipation == pytest.approx(lost, abs=1e-13)


def test_balls_of_unequal_mass_exchange_momentum() -> None:
    """An elastic impact of the masses 1 and 8: (m - M)/(m + M) and 2 m/(m + M); rounding of 1 m/s."""
    balls = Balls(
        centres=[[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]],
        velocities=[[1.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        radius=[0.1, 0.2],
        density=1000.0,
    )
    last = marched(Pile(balls=balls, restitution=1.0), 1.0, 0.01)[-1]
    assert last.velocities[:, 0] == pytest.approx([-7.0 / 9.0, 2.0 / 9.0], abs=1e-14)


@pytest.mark.parametrize("step", [0.01, 0.001])
def test_a_sliding_ball_begins_to_roll(step: float) -> None:
    """Rolling velocity of a ball that slid at v0: 5/7 v0, and the energy 2/7 of its own is lost; rounding of 1 m/s."""
    balls = Balls(centres=[[0.0, 0.0, 0.1]], velocities=[[1.0, 0.0, 0.0]], **BALL)
    steps = marched(Pile(balls=balls, walls=(FLOOR,), gravity=DOWN, friction=0.2), 1.0, step)
    assert steps[-1].velocities[0] == pytest.approx([5.0 / 7.0, 0.0, 0.0], abs=1e-13)
    assert steps[-1].spins[0] == pytest.approx([0.0, 50.0 / 7.0, 0.0], abs=1e-12)
    assert steps[-1].dissipation == pytest.approx(balls.mass[0] / 7.0, abs=1e-13)
    slides = 2.0 / 7.0 / (0.2 * 9.81)
    gone = slides - 0.5 * 0.2 * 9.81 * slides**2 + 5.0 / 7.0 * (1.0 - slides)
    assert abs(steps[-1].centres[0, 0] - gone) < 0.2 * 9.81 * step**2
    assert max(one.unfinished for one in steps) == 0


def test_a_disc_rolls_at_two_thirds() -> None:
    """Rolling velocity of a disc that slid at v0: 2/3 v0; rounding of 1 m/s."""
    disc = Balls(centres=[[0.0, 0.1]], velocities=[[1.0, 0.0]], **BALL)
    floor = Wall(point=(0.0, 0.0), normal=(0.0, 1.0))
    last = marched(Pile(balls=disc, walls=(floor,), gravity=(0.0, -9.81), friction=0.2), 1.0, 0.01)[-1]
    assert last.velocities[0] == pytest.approx([2.0 / 3.0, 0.0], abs=1e-13)
    assert last.spins[0, 0] == pytest.approx(-20.0 / 3.0, abs=1e-12)


def test_a_ball_rolls_down_a_groove() -> None:
    """A ball in a groove of a right angle rolls about the line between its places of contact, at an arm of r/sqrt(2).

    Its acceleration is g sin(a) / (1 + 2/5 r^2/arm^2), constant, so that the slabs are exact; the tolerance of the
    sweeps is 2e-9 m/s.
    """
    side, slope = 0.5**0.5, np.deg2rad(30.0)
    walls = tuple(Wall(point=(0.0, 0.0, 0.0), normal=(0.0, y, side)) for y in (side, -side))
    gravity = (9.81 * np.sin(slope), 0.0, -9.81 * np.cos(slope))
    ball = Balls(centres=[[0.0, 0.0, 0.1 * 2.0**0.5]], **BALL)
    last = marched(Pile(balls=ball, walls=walls, gravity=gravity, friction=0.4), 0.5, 0.01)[-1]
    assert last.velocities[0, 0] == pytest.approx(0.5 * gravity[0] / 1.8, abs=1e-8)
    assert last.spins[0, 1] == pytest.approx(last.velocities[0, 0] / (0.1 * side), abs=1e-7)


def test_elastic_gas_keeps_its_energy() -> None:
    """A thousand slabs with thousands of elastic impacts; rounding of the energy in each of them."""
    given = thrown(1.0, 0.0).balls
    pile = Pile(balls=given, walls=box(lower=(0.0,) * 3, upper=(0.8,) * 3), restitution=1.0)
    steps = marched(pile, 2.0, 0.002, every=100)
    energies = np.array([one.energy_kinetic for one in steps])
    assert sum(one.touches for one in steps) > 3000
    assert np.abs(energies / energies[0] - 1.0).max() < 1e-11
    assert max(abs(one.energy_error) for one in steps) < 1e-12 * energies[0]


@pytest.mark.parametrize(("restitution", "friction"), [(1.0, 0.0), (0.7, 0.3)])
def test_free_balls_keep_momentum_and_spin(restitution: float, friction: float) -> None:
    """Momentum and angular momentum, in parts of m v and m v L of all balls."""
    pile = thrown(restitution, friction)
    first, *_, last = marched(pile, 1.0, 0.002, every=50)
    scale = float(pile.balls.mass.sum()) * np.abs(first.velocities).max()
    assert (last.dissipation > 1.0) == (friction > 0.0)
    assert np.abs(last.momentum - first.momentum).max() < 1e-13 * scale
    assert np.abs(last.spin - first.spin).max() < 1e-12 * scale
    assert abs(last.energy_error) < 1e-12 * first.energy_kinetic


def test_a_fast_ball_does_not_pass_through_another() -> None:
    """Slabs in which a ball would move too far are divided."""
    balls = Balls(centres=[[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]], velocities=[[200.0, 0.0, 0.0], [0.0, 0.0, 0.0]], **BALL)
    steps = marched(Pile(balls=balls), 0.1, 0.01)
    last = steps[-1]
    assert steps[1].slabs == 40  # 200 m/s for .01 s, in parts of half the radius
    assert last.velocities[:, 0] == pytest.approx([100.0, 100.0], rel=1e-13)


def test_rotations_follow_the_spins() -> None:
    """Cayley's map: a turn of 2 atan(h w / 2) each slab."""
    ball = Balls(centres=[[0.0, 0.0, 0.0]], spins=[[0.0, 0.0, 3.0]], **BALL)
    last = marched(Pile(balls=ball), 1.0, 0.01)[-1]
    angle = 200.0 * np.arctan(0.015)
    assert last.rotations[0, :, 0] == pytest.approx([np.cos(angle), np.sin(angle), 0.0], abs=1e-13)
