"""Ten boxes, one on the other, that were pushed or shaken: afterwards they neither creep nor sink."""

from itertools import product
from typing import Any

import numpy as np
import pytest

from softway.mechanisms import Mechanism, Motor, PlaneStop, RatePolyline, Rigid, Slider, march

pytestmark = pytest.mark.slow
MINUTES = pytest.mark.minutes

WIDE, HIGH, BOXES = 0.1, 0.05, 10


def stacked(below: str, pushes: np.ndarray) -> dict[str, Any]:
    """Boxes with velocities across, on two corners each: of the four rows of a face three are independent."""
    bodies: dict[str, Rigid] = {}
    stops: dict[str, PlaneStop] = {}
    for k, push in enumerate(pushes.tolist()):
        level = HIGH * (2 * k + 1)
        inertia = (WIDE**2 + HIGH**2) / 3.0
        bodies[f"b{k}"] = Rigid(mass=1.0, centre=(0.0, level), inertia=inertia, velocity=(push, 0.0))
        for side in (-1.0, 1.0):
            foot = (WIDE * side, level - HIGH)
            stops[f"s{k}{side}"] = PlaneStop(
                between=(below, f"b{k}"), point=foot, plane=(0.0, level - HIGH), normal=(0.0, 1.0), friction=0.5
            )
        below = f"b{k}"
    return {"bodies": bodies, "stops": stops, "gravity": (0.0, -9.81)}


def shaking(rng: np.random.Generator, most: float) -> RatePolyline:
    """Rates of a motor that change at random for a second, and end at rest."""
    rates = rng.uniform(-most, most, 41)
    rates[[0, -1]] = 0.0
    rates[1:-1] -= rates[1:-1].mean()
    return RatePolyline(times=tuple(np.linspace(0.0, 1.0, 41).tolist()), rates=tuple(rates.tolist()))


def on_shaken_table(seed: int, boxes: int) -> Mechanism:
    """A table that motors move across and upright."""
    rng, parts = np.random.default_rng(seed), stacked("table", np.zeros(boxes))
    moving = {name: Rigid(mass=1.0, centre=(0.0, 0.0), inertia=1.0) for name in ("carriage", "table")}
    joints = {
        "rail": Slider(between=("ground", "carriage"), at=(0.0, 0.0), axis=(1.0, 0.0)),
        "lift": Slider(between=("carriage", "table"), at=(0.0, 0.0), axis=(0.0, 1.0)),
    }
    motors = {
        "across": Motor(joint="rail", motion=shaking(rng, 0.15)),
        "upright": Motor(joint="lift", motion=shaking(rng, 0.2)),
    }
    return Mechanism(**{**parts, "bodies": moving | parts["bodies"]}, joints=joints, motors=motors)


def stays(mechanism: Mechanism, until: float, step: float, rest: float) -> None:
    """After the boxes have slid they are at rest, for a time at least, to 1e-12 m, at the heights where they began."""
    steps = list(march(mechanism, until=until, step=step))
    names = [name for name in mechanism.bodies if name.startswith("b")]
    places = np.array([[s.bodies[name].centre for name in names] for s in steps])
    speeds = np.array([max(np.abs(s.bodies[name].velocity).max() for name in names) for s in steps])
    first = int(np.flatnonzero(speeds > 1e-12)[-1]) + 1
    assert first < len(steps) and until - steps[first].time >= rest
    assert np.abs(places[-1, :, 0] - places[0, :, 0]).max() > 1e-3, "they have slid"
    assert np.abs(places[first:] - places[first]).max() <= 1e-12
    table = steps[-1].bodies["table"].centre[1] if "table" in mechanism.bodies else 0.0
    assert np.abs(places[-1, :, 1] - places[0, :, 1] - table).max() <= 1e-12
    assert max(abs(s.energy_error) for s in steps) <= 1e-12 * len(names) * 9.81 * len(names) * HIGH


@pytest.mark.parametrize(
    ("seed", "step", "until", "rest"),
    [
        pytest.param(2, 2e-3, 4.0, 1.0, marks=MINUTES),
        pytest.param(2, 1e-3, 3.0, 0.5, marks=MINUTES),
        (1, 5e-3, 12.5, 10.0),
        pytest.param(2, 5e-3, 12.5, 10.0, marks=MINUTES),
        pytest.param(1, 2e-3, 12.5, 10.0, marks=MINUTES),
    ],
)
def test_ten_boxes_that_were_pushed_do_not_creep_or_sink(seed: int, step: float, until: float, rest: float) -> None:
    pushes = np.random.default_rng(seed).normal(0.0, 0.3, BOXES)
    stays(Mechanism(**stacked("ground", pushes)), until, step, rest)


@pytest.mark.parametrize(
    ("boxes", "seed", "step", "until", "rest"),
    [
        (4, 2, 5e-3, 8.0, 2.0),
        pytest.param(BOXES, 2, 5e-3, 8.0, 2.0, marks=MINUTES),
        *(pytest.param(BOXES, *them, 16.0, 10.0, marks=MINUTES) for them in product((1, 2), (5e-3, 2e-3))),
    ],
)
def test_boxes_that_were_shaken_do_not_creep_or_sink(
    boxes: int, seed: int, step: float, until: float, rest: float
) -> None:
    stays(on_shaken_table(seed, boxes), until, step, rest)
