"""Impacts by Poisson's law: the impulses of expansion and compression have the ratio of restitution."""

import json
from importlib.resources import files
from itertools import product
from math import cos, sin

import numpy as np
import pytest

from softway.mechanisms import DistanceStop, Mechanism, MechanismStep, PlaneStop, Rigid, march

SHEET = json.loads(files("softway.apps.verify.data.friction").joinpath("C07.json").read_text(encoding="utf-8"))
CASES = list(zip(product((0.0, 0.5), (0.0, 0.3, 1.3)), SHEET["qoi"][0]["value"], strict=True))


def fallen_rod(speed: float, friction: float, restitution: float) -> MechanismStep:
    """A rod of 1 m and 1 kg whose end hits the floor at 1 m/s, leaning by .7, right after the impact."""
    tip = (-0.5 * cos(0.7), -0.5 * sin(0.7))
    rod = Rigid(mass=1.0, centre=(0.0, 0.0), inertia=1.0 / 12.0, velocity=(speed, -1.0))
    floor = PlaneStop(
        between=("ground", "rod"), point=tip, plane=tip, normal=(0.0, 1.0), friction=friction, restitution=restitution
    )
    mechanism = Mechanism(bodies={"rod": rod}, stops={"floor": floor}, restitution="Poisson")
    return next(iter(march(mechanism, until=1e-3, step=1e-3)))


@pytest.mark.slow
@pytest.mark.parametrize(("given", "expected"), CASES)
def test_a_rod_whose_end_hits_the_floor(given: tuple[float, float], expected: list[float]) -> None:
    """It slides, sticks, or slides back (Routh)."""
    step = fallen_rod(*given, 0.5)
    body = step.bodies["rod"]
    np.testing.assert_allclose([*body.velocity, *body.spin, step.events[0].impulse], expected[:4], atol=1e-13)
    assert step.dissipation > 0.0 and abs(step.energy_error) < 1e-15


@pytest.mark.slow
def test_a_rod_that_touches_and_moves_away_has_no_impact() -> None:
    rod = Rigid(mass=1.0, centre=(0.0, 0.0), inertia=1.0 / 12.0, velocity=(0.3, 1.0), spin=0.2)
    tip = (-0.5 * cos(0.7), -0.5 * sin(0.7))
    floor = PlaneStop(between=("ground", "rod"), point=tip, plane=tip, normal=(0.0, 1.0), friction=0.3)
    mechanism = Mechanism(bodies={"rod": rod}, stops={"floor": floor}, restitution="Poisson")
    for step in march(mechanism, until=0.01, step=1e-3):
        np.testing.assert_allclose(
            [*step.bodies["rod"].velocity, *step.bodies["rod"].spin], [0.3, 1.0, 0.2], rtol=1e-13
        )
        assert not step.events and step.dissipation == 0.0


@pytest.mark.few(20)
@pytest.mark.parametrize("speed", np.linspace(-3.0, 3.0, 13))
@pytest.mark.parametrize("friction", [0.1, 0.4, 0.9, 1.7])
def test_a_single_impact_creates_no_energy(speed: float, friction: float) -> None:
    """Neither without any loss in the normal direction."""
    step = fallen_rod(float(speed), friction, 1.0)
    assert step.dissipation >= -1e-15 and step.events[0].impulse > 0.0


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_several_impacts_at_once(friction: float) -> None:
    """Three balls in a row, the first flies at the others: e = 1 keeps the energy, and each impulse is doubled."""
    bodies = {
        f"b{k}": Rigid(mass=1.0, centre=(float(k), 0.0), inertia=0.1, velocity=(1.0 if k == 0 else 0.0, 0.0))
        for k in range(3)
    }
    stops = {
        f"s{k}": DistanceStop(
            between=(f"b{k}", f"b{k + 1}"), points=((float(k), 0.0), (float(k + 1), 0.0)), distance=1.0,
            restitution=1.0, friction=friction,
        )
        for k in range(2)
    }  # fmt: skip
    mechanism = Mechanism(bodies=bodies, stops=stops, restitution="Poisson")
    step = next(iter(march(mechanism, until=1e-3, step=1e-3)))
    speeds = [float(body.velocity[0]) for body in step.bodies.values()]
    np.testing.assert_allclose(speeds, [-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0], atol=1e-13)
    assert step.dissipation == pytest.approx(0.0, abs=1e-14)
