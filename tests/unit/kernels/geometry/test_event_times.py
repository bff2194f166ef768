"""Roots of gaps and reactions inside a slab."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from softway.kernels.geometry.event_times import crossing, fading

number = st.floats(-3.0, 3.0).map(lambda x: round(x, 6))
fraction = st.floats(0.0, 1.0)


def first(gap: float, slope: float, curvature: float) -> float:
    return float(crossing(np.array([gap]), np.array([slope]), np.array([curvature]))[0])


@given(start=st.floats(0.0, 2.0).map(lambda x: round(x, 6)), slope=number, curvature=number)
def test_a_crossing_is_the_first_zero_of_the_gap(start: float, slope: float, curvature: float) -> None:
    tau = first(start, slope, curvature)
    small = 1e-9 * (1.0 + start + abs(slope) + abs(curvature))

    def gap(t: np.ndarray | float) -> np.ndarray | float:
        return start + slope * t + 0.5 * curvature * t**2

    if np.isnan(tau):
        assert gap(1.0) >= -small, "a gap that is negative at the end has closed"
        assert np.min(gap(np.linspace(0.0, 1.0, 201))) >= -small
    else:
        assert 0.0 <= tau <= 1.0
        assert abs(gap(tau)) <= small
        assert np.min(gap(np.linspace(0.0, tau, 201))) >= -small
        assert slope + curvature * tau <= np.sqrt(2.0 * small * (1.0 + abs(curvature))) or tau == 0.0


@given(a=fraction, b=st.floats(1.1, 3.0), bend=st.floats(0.1, 5.0))
def test_the_earlier_of_two_roots_is_taken(a: float, b: float, bend: float) -> None:
    assert first(bend * a * b, -bend * (a + b), 2.0 * bend) == pytest.approx(a, abs=1e-12)


@given(a=fraction, b=st.floats(-3.0, -0.1), bend=st.floats(0.1, 5.0))
def test_a_gap_that_opens_and_closes_again(a: float, b: float, bend: float) -> None:
    assert first(-bend * a * b, bend * (a + b), -2.0 * bend) == pytest.approx(a, abs=1e-12)


@given(gap=st.floats(1e-14, 1e-9), curvature=st.floats(-1.0, 1.0))
def test_a_tiny_gap_keeps_its_digits(gap: float, curvature: float) -> None:
    assert first(gap, -1.0, curvature) == pytest.approx(gap, rel=1e-8)


def test_a_gap_below_zero_by_rounding_closes_at_once() -> None:
    assert first(-1e-17, -1.0, 0.0) == 0.0
    assert first(0.0, -1.0, 5.0) == 0.0


def test_rows_are_independent_and_may_be_none() -> None:
    gaps, slopes, bends = np.array([[1.0, 1.0, 2.0, 0.5], [-2.0, 1.0, -4.0, 0.0], [0.0, 0.0, 0.0, -1.0]])
    tau = crossing(gaps, slopes, bends)
    assert tau == pytest.approx([0.5, np.nan, 0.5, 1.0], nan_ok=True)
    assert crossing(np.zeros(0), np.zeros(0), np.zeros(0)).shape == (0,)


@given(before=st.floats(1e-6, 1e6), after=st.floats(-1e6, -1e-6))
def test_fading_is_the_zero_of_a_line(before: float, after: float) -> None:
    s = float(fading(np.array([before]), np.array([after]))[0])
    assert 0.0 < s < 1.0
    assert before + s * (after - before) == pytest.approx(0.0, abs=1e-12 * (before - after))


def test_what_is_never_positive_fades_at_once() -> None:
    assert fading(np.array([0.0, -1.0, 0.0]), np.array([-1.0, -2.0, 0.0])).tolist() == [0.0, 0.0, 0.0]
