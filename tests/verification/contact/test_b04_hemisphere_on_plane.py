"""B04: a hemisphere on a rigid plane, its flat face moved by the approach; Hertz's contact on a circle.

A ball is not a half-space: at the approach of the case, where a/R = 0.1, the force of the continuum is 5.7 percent
above Hertz's. The series of exact_ball.py says so independently; the difference falls like a/R.
"""

import numpy as np
import pytest

import results
from softway.apps.verify.cases.contact.b04_hemisphere_on_plane import APPROACH, SERIES, ball, hertz, pressed
from softway.apps.verify.scenes.pressing import Footprint


@pytest.fixture(scope="module")
def series() -> list[Footprint]:
    """Three approaches, ten elements across a."""
    return [pressed(approach) for approach in SERIES]


def test_case():
    """A ball is not a half-space, and the force of the case is that of one."""
    assert results.missed("B04") == {"F"}


def test_the_force_is_that_of_a_ball(series):
    width, exact = ball()
    assert series[-1].force.sum() == pytest.approx(exact.force, rel=3e-3)
    assert series[-1].fitted == pytest.approx((exact.peak, width), rel=5e-3)
    assert exact.force / hertz().force == pytest.approx(1.0566, abs=5e-4)


def test_the_force_tends_to_that_of_hertz(series):
    """The case allows 3 percent, which a ball keeps up to a/R = 0.05."""
    excess = [contact.force.sum() / hertz(a).force - 1.0 for contact, a in zip(series, SERIES, strict=True)]
    assert 0.0 < excess[0] < 0.03
    assert excess[1] / excess[0] == pytest.approx(2.0**0.5, rel=0.05)
    assert excess[2] / excess[1] == pytest.approx(2.0**0.5, rel=0.05)


def test_the_peak_of_the_pressure(series):
    """The case allows 5 percent; the pressure that belongs to the force of the plane is Hertz's to half a percent."""
    peak, width = series[-1].fitted
    assert peak == pytest.approx(hertz().peak, rel=0.02)
    force = series[-1].force.sum()
    same = hertz((force / hertz().stiffness) ** (2.0 / 3.0))
    assert (peak, width) == pytest.approx((same.peak, same.half_width), rel=0.005)


def test_the_pressure_is_that_of_hertz_at_every_node(series):
    contact = series[-1]
    peak, width = contact.fitted
    missed = contact.pressure / peak - np.sqrt(np.maximum(1.0 - (contact.place / width) ** 2, 0.0))
    inner = (contact.place > 0.0) & (contact.place < 0.85 * width)
    assert np.abs(missed[inner]).max() < 0.01
    assert np.abs(missed).max() < 0.08


def test_the_exponent(series):
    """3/2 in the limit; the case allows 0.03."""
    slope = np.polyfit(np.log(SERIES), np.log([c.force.sum() for c in series]), 1)[0]
    assert slope == pytest.approx(1.5, abs=0.03)


@pytest.mark.slow
def test_the_force_converges_with_the_mesh():
    """At second order to the force of quadratic cells."""
    fine = pressed(APPROACH, 10, "quad9").force.sum()
    missed = [pressed(APPROACH, across).force.sum() / fine - 1.0 for across in (5, 10, 20)]
    assert missed[0] > 2.5 * missed[1] > 5.0 * missed[2] > 0.0
