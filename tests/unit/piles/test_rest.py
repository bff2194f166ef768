"""Piles come to rest and stay, without overlap; the order of the balls and repeated runs."""

import numpy as np
import pytest

from softway.piles import Balls, Pile, PileStep, Wall, box, lattice, march

HEAP = lattice(count=(6, 6), radius=0.05, density=1000.0, lowest=(0.06, 0.06), jitter=0.008)
BOX = box(lower=(0.0, 0.0), upper=(0.7, None))


def heap(balls: Balls = HEAP, restitution: float = 0.0) -> Pile:
    """36 discs that fall into a box."""
    return Pile(balls=balls, walls=BOX, gravity=(0.0, -9.81), friction=0.3, restitution=restitution)


def gaps(step: PileStep, radius: float) -> np.ndarray:
    """Gaps of all pairs."""
    first, second = np.triu_indices(len(step.centres), 1)
    return np.asarray(np.linalg.norm(step.centres[first] - step.centres[second], axis=1) - 2.0 * radius)


@pytest.mark.few(2)
@pytest.mark.parametrize("restitution", [0.0, 0.5])
@pytest.mark.parametrize("seed", [0, 1])
def test_discs_come_to_rest_and_stay(restitution: float, seed: int) -> None:
    """36 discs in a hopper, where none can roll: the drift in the last second.

    The energy grows by no more than forces do through the overlap that is left, in parts of that at the start.
    """
    balls = lattice(count=(6, 6), radius=0.05, density=1000.0, lowest=(0.06, 0.45), jitter=0.008, seed=seed)
    sides = tuple(Wall(point=(0.35, 0.0), normal=(x, 1.0)) for x in (1.0, -1.0))
    pile = Pile(balls=balls, walls=sides, gravity=(0.0, -9.81), friction=0.3, restitution=restitution)
    steps = list(march(pile, until=3.0, step=1e-3, every=100))
    assert np.abs(steps[-1].centres - steps[-11].centres).max() < 1e-10
    assert steps[-1].energy_kinetic < 1e-16
    assert max(one.overlap for one in steps) <= 1e-10 * 0.05
    assert min(float(gaps(one, 0.05).min()) for one in steps) > -2e-10 * 0.05
    assert min(float((one.centres[:, 1] - np.abs(one.centres[:, 0] - 0.35)).min()) for one in steps) > 0.07
    scale = steps[0].energy_potential
    assert max(abs(one.energy_error) for one in steps) < 1e-13 * scale
    assert np.diff([one.dissipation for one in steps]).min() > -1e-8 * scale


def test_balls_in_a_narrow_box_come_to_rest() -> None:
    """A pyramid of four layers between walls; its centres in exact layers are the pile at rest."""
    layers = [
        ((2 * i + k + 1) * 0.05, (2 * j + k + 1) * 0.05, 0.05 + k * 0.05 * 2.0**0.5)
        for k in range(4)
        for i in range(4 - k)
        for j in range(4 - k)
    ]
    exact = np.array(layers)
    start = exact * (1.0 + 1e-7) + [0.0, 0.0, 1e-3]
    side = 0.4 * (1.0 + 1e-7)
    pile = Pile(
        balls=Balls(centres=start, radius=0.05, density=2500.0),
        walls=box(lower=(0.0, 0.0, 0.0), upper=(side, side, None)),
        gravity=(0.0, 0.0, -9.81),
        friction=0.3,
    )
    steps = list(march(pile, until=2.0, step=1e-3, every=100, sweeps=200))
    assert np.abs(steps[-1].centres - steps[-11].centres).max() < 1e-10
    assert np.abs(steps[-1].centres - exact).max() < 1e-5
    assert max(one.overlap for one in steps) <= 1e-10 * 0.05


def test_same_input_same_bits() -> None:
    first, second = (list(march(heap(), until=0.5, step=1e-3, every=500))[-1] for _ in range(2))
    assert (first.centres == second.centres).all()  # as given
    assert (first.velocities == second.velocities).all()  # as given


def test_the_order_of_the_balls_does_not_matter() -> None:
    """Until errors grow by impacts: the tolerance of the sweeps is 2e-9 m/s here."""
    order = np.random.default_rng(3).permutation(HEAP.count)
    mixed = Balls(centres=np.asarray(HEAP.centres)[order], radius=0.05, density=1000.0)
    one, other = (list(march(heap(b), until=0.15, step=1e-3, sweeps=2000))[-1] for b in (HEAP, mixed))
    assert np.abs(one.centres[order] - other.centres).max() < 1e-7


def test_sweeps_that_end_too_early_are_told() -> None:
    """Overlaps stay within their tolerance, and the friction that misses its law is told."""
    few, many = (list(march(heap(), until=0.5, step=1e-3, every=500, sweeps=k))[-1] for k in (1, 2000))
    assert few.unfinished > 100 > many.unfinished
    assert few.slip_error > 1e3 * 2.0 * 1e-10 * 0.05 / 1e-3
    assert max(few.overlap, many.overlap) <= 1e-10 * 0.05


@pytest.mark.parametrize("sweeps", [1, 5])
@pytest.mark.parametrize("friction", [0.1, 1.5])
def test_energy_never_grows_however_early_the_sweeps_end(sweeps: int, friction: float) -> None:
    """In a single slab by no more than forces do through the overlap that is left, in parts of that at the start."""
    balls = lattice(count=(3, 3, 3), radius=0.05, density=1000.0, lowest=(0.06,) * 3, jitter=0.005)
    walls = box(lower=(0.0, 0.0, 0.0), upper=(0.4, 0.4, None))
    pile = Pile(balls=balls, walls=walls, gravity=(0.0, 0.0, -1.0), friction=friction)
    steps = list(march(pile, until=4.0, step=0.02, sweeps=sweeps))
    energies = np.array([one.energy_kinetic + one.energy_potential for one in steps])
    assert sum(one.unfinished for one in steps) > 100
    assert np.diff(energies).max() < 1e-9 * energies[0]
