"""Smooth laws of motion: values at the points, rates, continuity, no overshoot, and the motion of tools by them."""

from collections.abc import Callable

import numpy as np
import pytest

from softway.bodies.prescribed_motion import Sliding, Swinging, carried_tool
from softway.bodies.setup.motion_laws import (
    Haversine,
    MotionLaw,
    RatePolyline,
    Sine,
    SmoothSteps,
    Spline,
    value_and_rate,
)
from softway.errors import InputError

TIMES, VALUES = (-0.5, 0.1, 1.0, 1.2, 2.0), (1.0, -0.5, -0.5, 2.0, 2.5)
LAWS = [
    Spline(times=TIMES, points=VALUES),
    Spline(times=TIMES, points=VALUES, monotone=True),
    SmoothSteps(times=TIMES, points=VALUES),
    Sine(amplitude=-0.7, frequency=1.3, phase=0.4),
    Haversine(height=2.0, duration=0.8, start=0.3),
    RatePolyline(times=(-1.0, 0.1, 1.0, 1.2, 2.0), rates=VALUES),
]
laws = pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)


def value(law: MotionLaw, times: np.ndarray) -> np.ndarray:
    return np.array([value_and_rate(law.pieces, float(t))[0] for t in times])


def rate(law: MotionLaw, times: np.ndarray) -> np.ndarray:
    return np.array([value_and_rate(law.pieces, float(t))[1] for t in times])


@laws
def test_the_value_is_the_integral_of_the_rate(law: MotionLaw) -> None:
    """By Gauss points between the instants: exact for polynomials, and to rounding for sines."""
    edges = np.unique([*TIMES, 0.3, 1.1, -1.0, 3.0, *np.linspace(-1.0, 3.0, 33)])
    points, weights = np.polynomial.legendre.leggauss(8)
    for a, b in zip(edges[:-1], edges[1:], strict=True):
        at = 0.5 * (a + b) + 0.5 * (b - a) * points
        change = value(law, np.array([a, b]))
        assert change[1] - change[0] == pytest.approx(0.5 * (b - a) * weights @ rate(law, at), abs=1e-14)


@laws
def test_the_greatest_rate_is_reached_and_not_passed(law: MotionLaw) -> None:
    found = np.abs(rate(law, np.linspace(-1.0, 3.0, 40001))).max()
    assert found <= law.greatest_rate * (1.0 + 1e-14)
    assert found == pytest.approx(law.greatest_rate, rel=1e-6)


@pytest.mark.parametrize("law", LAWS[:3], ids=lambda law: type(law).__name__)
def test_the_points_are_met_and_the_law_rests_outside(law: MotionLaw) -> None:
    np.testing.assert_allclose(value(law, np.array(TIMES)), VALUES, atol=1e-15)
    assert value(law, np.array([-7.0, 9.0])).tolist() == [VALUES[0], VALUES[-1]]
    assert rate(law, np.array([-7.0, TIMES[0], TIMES[-1], 9.0])) == pytest.approx(np.zeros(4), abs=1e-14)


@pytest.mark.parametrize(("law", "smooth"), [(LAWS[0], 2), (LAWS[1], 1), (LAWS[2], 2)], ids=["spline", "tame", "steps"])
def test_continuity_at_the_inner_points(law: MotionLaw, smooth: int) -> None:
    """Velocities of all, and accelerations of the spline and the smooth steps, from the coefficients of the pieces."""
    for before, after in zip(law.pieces[1:-2], law.pieces[2:-1], strict=True):
        ends = np.polynomial.Polynomial(before[1:7]), np.polynomial.Polynomial(after[1:7])
        for order in range(smooth + 1):
            left, right = (p.deriv(order) if order else p for p in ends)
            assert left(after[0] - before[0]) == pytest.approx(right(0.0), abs=1e-12)


def test_only_a_monotone_spline_does_not_overshoot() -> None:
    t = np.linspace(0.1, 1.0, 101)
    assert np.ptp(value(LAWS[0], t)) > 0.1, "the points are level there"
    assert np.ptp(value(LAWS[1], t)) < 1e-15
    for a, b in zip(TIMES[:-1], TIMES[1:], strict=True):
        step = np.diff(value(LAWS[1], np.linspace(a, b, 201)))
        assert (step >= -1e-15).all() or (step <= 1e-15).all()


def test_tools_move_by_the_change_since_the_start() -> None:
    law = LAWS[0]
    start = value(law, np.zeros(1))[0]
    for t in (-1.0, 0.0, 0.4, 1.1, 5.0):
        travel = value(law, np.array([t]))[0] - start
        shift = Sliding(direction=(3.0, 4.0), travel=law).at(t).shift
        np.testing.assert_allclose(shift, travel * np.array([0.6, 0.8]), atol=1e-15)
        pose = Swinging(point=(1.0, 2.0, 0.5), axis=(0.0, 0.0, 2.0), angle=law).at(t)
        placed = pose.place(np.array([2.0, 2.0, 3.0]))
        np.testing.assert_allclose(placed, [1.0 + np.cos(travel), 2.0 + np.sin(travel), 3.0], atol=1e-14)
    carried = carried_tool(Sliding(direction=(1.0,), travel=law), 0.2, 0.9, np.zeros((2, 1)))
    np.testing.assert_allclose(carried, np.diff(value(law, np.array([0.2, 0.9])))[0], atol=1e-15)


@pytest.mark.parametrize(
    ("make", "where"),
    [
        (lambda: Spline(times=(0.0,), points=(0.0,)), "points"),
        (lambda: Spline(times=(0.0, 1.0), points=(0.0,)), "points"),
        (lambda: SmoothSteps(times=(0.0, 1.0), points=(0.0, np.inf)), "points"),
        (lambda: SmoothSteps(times=(0.0, 0.0), points=(0.0, 1.0)), "times"),
        (lambda: RatePolyline(times=(0.1, 1.0), rates=(0.0, 1.0)), "times"),
        (lambda: RatePolyline(times=(0.0, 1.0), rates=(0.0,)), "rates"),
        (lambda: Haversine(height=np.nan, duration=1.0), "height"),
        (lambda: Haversine(height=1.0, duration=0.0), "duration"),
        (lambda: Sine(amplitude=np.inf, frequency=1.0), "amplitude"),
        (lambda: Sliding(direction=(0.0, 0.0), travel=LAWS[0]), "direction"),
        (lambda: Swinging(point=(0.0,), angle=LAWS[0]), "point"),
        (lambda: Swinging(point=(0.0, 0.0), axis=(0.0, 0.0, 1.0), angle=LAWS[0]), "axis"),
    ],
)
def test_what_is_no_law_is_refused(make: Callable[[], object], where: str) -> None:
    with pytest.raises(InputError) as error:
        make()
    assert error.value.where == where
