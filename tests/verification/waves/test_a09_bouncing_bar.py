"""A09: an elastic bar dropped on a floor: ten bounces, and the energy over six periods."""

import numpy as np
import pytest

import results
from softway.apps.verify.cases.waves.a09_bouncing_bar import BAR, ENERGY, dropped
from softway.apps.verify.exact import bar as waves
from softway.apps.verify.scenes import bars

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def march() -> bars.Record:
    """The march of the case, 100 elements with the automatic step, for half as long: five bounces."""
    return dropped(100, None, 13.2)


@pytest.mark.minutes
def test_case() -> None:
    """Ten bounces with 100 elements and the automatic step; the case allows 200 for the last five."""
    assert results.missed("A09") == set()


def test_up_to_the_fifth_bounce_the_instants_are_closer(march: bars.Record) -> None:
    starts = np.array([start for start, _ in march.contacts(apart=1.0)])
    assert np.abs(starts[:5] - [1.0 + 8.0 * k / 3.0 for k in range(5)]).max() <= 0.0125


def test_every_contact_lasts_a_round_trip(march: bars.Record) -> None:
    lengths = np.array([end - start for start, end in march.contacts(apart=1.0)[:5]])
    assert len(lengths) == 5
    assert np.abs(lengths - 2.0 / 3.0).max() <= 0.05


def test_the_force_of_the_first_contact_grows_linearly(march: bars.Record) -> None:
    for s in (0.1, 0.2, 1.0 / 3.0, 0.5, 0.6):
        assert march.mean_force(1.0 + s - 0.02, 1.0 + s + 0.02) == pytest.approx(300.0 + 300.0 * s, rel=0.01)


def test_the_lower_end_falls_as_the_exact_bar(march: bars.Record) -> None:
    exact = waves.solve(BAR, 13.0)
    error = march.displacement[:, 0] + exact.tip(march.times)
    early = march.times <= 11.0
    assert np.abs(error[early]).max() <= 0.25
    assert np.sqrt(np.mean(error[early] ** 2)) <= 0.08


def test_energy_and_penetration(march: bars.Record) -> None:
    assert np.abs(march.error).max() <= 1e-12 * ENERGY
    assert march.gap.min() >= -1e-12 * BAR.length
    assert march.power.max() <= 1e-12 * ENERGY


@pytest.mark.minutes
def test_six_periods_of_fifty_elements() -> None:
    """Twelve bounces: the energy stays, nothing penetrates, the contact force does no work.

    The step is that of an element transit, which disperses more than the automatic one: the bounces come early, the
    tenth by 0.8 s, while the energy stays.
    """
    march = dropped(50, 1.0, 32.0)
    assert len(march.contacts(apart=1.0)) >= 12
    assert np.abs(march.error).max() <= 1e-9 * ENERGY
    assert march.gap.min() >= -1e-12 * BAR.length
    assert march.power.max() <= 1e-12 * ENERGY
    balance = march.momentum + 100.0 * march.times[1:] - np.cumsum(march.force * np.diff(march.times))
    assert np.abs(balance).max() <= 1e-8 * 100.0
