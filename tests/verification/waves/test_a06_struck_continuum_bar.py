"""A06: the struck bar as a continuum, with and without a stop."""

import numpy as np
import pytest

import results
import softway as sw
from softway.apps.verify.cases.waves.a06_struck_continuum_bar import HAT, STOPPED, departure, stopped
from softway.apps.verify.exact import bar as waves
from softway.apps.verify.scenes import bars

pytestmark = pytest.mark.slow

FREE = waves.Bar(velocity=HAT, far="fixed")


def test_case() -> None:
    assert results.missed("A06") == set()


def test_the_force_vanishes_before_the_tip_leaves() -> None:
    """From 0.5 to 1.5 the exact tip rests at the stop without force; the march opens by 1e-4 and stays there."""
    march, exact = stopped(100, 2.0), waves.solve(STOPPED, 2.0)
    assert max(exact.force(t) for t in np.linspace(0.501, 1.499, 50)) == 0.0
    assert march.kinds == ["touch", "release"]
    assert march.first("release") == pytest.approx(0.5, abs=0.01)
    resting = (march.times > 0.51) & (march.times < 1.49)
    gap = 0.2 - march.displacement[resting, -1]
    assert np.all(gap >= 0.0)
    assert gap.max() <= 2e-4


def test_the_force_is_that_of_the_exact_bar() -> None:
    march, exact = stopped(200, 10.0), waves.solve(STOPPED, 10.5)
    force = np.array([exact.force(t) for t in march.middles])
    jumps = np.concatenate([[t.start, t.release] for t in exact.touches])
    smooth = np.abs(march.middles[:, None] - jumps).min(axis=1) > 0.02
    assert np.sqrt(np.mean((march.force - force)[smooth] ** 2)) <= 0.03


def test_three_contacts_and_the_energy() -> None:
    """In the first one the tip may open by some 1e-5 and close again while it rests without force."""
    march, exact = stopped(200, 10.0), waves.solve(STOPPED, 10.5)
    contacts = march.contacts(apart=1.0)
    assert [start for start, _ in contacts] == pytest.approx([t.start for t in exact.touches], abs=2e-3)
    assert [end for _, end in contacts][1:] == pytest.approx([t.release for t in exact.touches][1:], abs=5e-3)
    assert np.abs(march.error).max() <= 1e-12 * march.energy[0]
    assert march.energy[0] == pytest.approx(1.0 / 12.0, abs=1e-4)
    assert march.gap.min() >= -1e-12


def test_without_the_stop() -> None:
    march = bars.struck(100, sw.contact.Energy(), velocity=bars.HAT, until=4.0)
    exact = waves.solve(FREE, 4.5)
    assert march.events == ()
    assert march.norm(march.displacement[:, -1] - exact.tip(march.times)) <= 0.01


@pytest.mark.parametrize("rule", [sw.contact.Impulse(), sw.contact.Paper()], ids=str)
def test_rules_with_inertia_reach_the_same_continuum(rule: sw.contact.Impulse | sw.contact.Paper) -> None:
    """They lose energy at the touch, 2/(3N) and less of that of the tip's speed."""
    march = bars.struck(100, rule, gap=0.2, velocity=bars.HAT, until=4.0)
    exact = waves.solve(STOPPED, 4.5)
    assert march.first("touch") == pytest.approx(exact.touches[0].start, abs=2e-3)
    assert departure(march, 0.2) == pytest.approx(1.5, abs=0.02)
    assert march.norm(march.displacement[:, -1] - exact.tip(march.times)) <= 0.01
    assert 0.0 < march.dissipation[-1] <= 1e-2 * march.energy[0] + 2e-3
