"""An elastic bar with heat is thrown at a wall: energy, entropy and iterations, for weak and strong coupling."""

from functools import cache

import numpy as np
import pytest

import softway as sw

THETA, SPEED = 300.0, 0.1


def bar(delta: float, **given: object) -> sw.Solid:
    """A bar with the coupling ``delta = E alpha^2 theta / c``, with E = rho = 1 and c theta = 1."""
    law = sw.heat.Conduction(conductivity=0.01 / THETA, capacity=1.0 / THETA)
    heat = sw.bodies.Thermal(law=law, temperature=THETA, expansion=float(np.sqrt(delta)) / THETA)
    return sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=20), material=sw.laws.Hencky(E=1.0, nu=0.0), density=1.0,
        velocity=sw.bodies.Uniform(value=SPEED), thermal=heat,
    )  # fmt: skip


def scene(delta: float) -> sw.Scene:
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.01, normal=-1.0))
    return sw.Scene(bodies={"bar": bar(delta), "wall": wall}, contacts=(sw.Contact(between=("bar.right", "wall")),))


@cache
def thrown(delta: float) -> tuple[sw.Step, ...]:
    return tuple(sw.march(scene(delta), until=3.0, step=0.04, method=sw.FixedPoint(tolerance=1e-13)))


@pytest.mark.slow
@pytest.mark.parametrize("delta", [0.01, 0.05, 0.2, 0.5])
def test_energy_is_kept_and_entropy_never_falls(delta: float) -> None:
    steps = thrown(delta)
    assert any(e.kind == "release" for s in steps for e in s.events) and steps[-1].ledger.momentum[0] < 0.0
    whole = [s.ledger.energy_kinetic + s.ledger.energy_strain + s.ledger.heat.content for s in steps]
    kinetic = steps[0].ledger.energy_kinetic
    assert np.ptp(whole) < 1e-11 * kinetic
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-13 * kinetic
    assert min(s.ledger.heat.produced for s in steps) > -1e-12 / THETA
    assert steps[-1].ledger.heat.entropy > 1e-5 * kinetic / THETA
    assert max(s.ledger.energy_kinetic for s in steps) < (1.0 + 1e-12) * kinetic
    assert steps[-1].ledger.heat.brought == 0.0


@pytest.mark.slow
def test_weak_coupling_takes_as_many_iterations_as_none() -> None:
    counts = [sum(s.report.iterations for s in thrown(delta)) for delta in (0.0, 0.01)]
    assert counts[1] < 1.2 * counts[0]


def test_a_march_goes_on_with_the_same_bits() -> None:
    steps = list(sw.march(scene(0.05), until=1.0, step=0.04))
    again = list(sw.march(scene(0.05), until=1.0, step=0.04, state=steps[11].march_state))
    assert len(again) == len(steps) - 12
    mine, same = (found[-1] for found in (steps, again))
    for name in ("displacement", "velocity"):
        np.testing.assert_array_equal(getattr(same.after, name)["bar"], getattr(mine.after, name)["bar"])
    np.testing.assert_array_equal(same.after.fields["temperature"]["bar"], mine.after.fields["temperature"]["bar"])
    assert same.ledger.heat == mine.ledger.heat
