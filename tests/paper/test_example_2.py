"""Second example of the paper: the bar held at one end, its other end struck, with and without a stop (Fig. 6)."""

from functools import cache

import numpy as np
import pytest

import softway as sw
from softway.apps.verify.exact import semidiscrete as discrete
from softway.apps.verify.scenes import bars

pytestmark = pytest.mark.slow

UNTIL, STEP, COARSE, SPEED = 10.0, 0.02, 0.04, 0.01
RULES = {
    "impulse": sw.contact.Impulse(),
    "literal": sw.contact.Paper(approach="extrapolated"),
    "kept": sw.contact.Paper(),
}


@cache
def marched(
    rule: str, gap: float = bars.OUT_OF_REACH, weight: sw.model.EndPeaks | sw.model.Collocation = sw.model.EndPeaks()
) -> bars.Record:
    """The example in small strain."""
    return bars.struck(2, RULES[rule], gap=gap, until=UNTIL, step=STEP, weight=weight)


@cache
def solved(rule: str, gap: float = np.inf) -> discrete.Motion:
    """The same mesh exact in time."""
    mesh, start = discrete.bar(2, fixed=True), np.array([0.0, 1.0])
    return discrete.solve(mesh, np.zeros(2), start, gap=gap, until=UNTIL, rule=rule)


def table(motion: discrete.Motion, march: bars.Record) -> np.ndarray:
    """Displacement of both nodes at the ends of the slabs."""
    return np.array([motion.at(t)[0] for t in march.times])


def test_without_the_stop() -> None:
    """Two oscillators: within 0.02 up to t = 10 with the end peaks, 2e-4 with the fourth-order weight, at h = 0.02."""
    default, better = marched("impulse"), marched("impulse", weight=bars.FOURTH)
    exact = table(solved("impulse"), default)
    assert np.abs(default.displacement[:, 1:] - exact).max() <= 0.02
    assert np.abs(better.displacement[:, 1:] - exact).max() <= 2e-4
    assert default.events == ()
    assert np.ptp(default.energy) <= 1e-12


@pytest.mark.parametrize(("rule", "gap"), [("impulse", 0.1), ("impulse", 0.2), ("literal", 0.2), ("literal", 0.3)])
def test_with_the_stop(rule: str, gap: float) -> None:
    march, motion = marched(rule, gap), solved(rule, gap)
    assert march.kinds == [e.kind for e in motion.events]
    assert np.abs(march.displacement[:, 1:] - table(motion, march)).max() <= 50.0 * STEP**2
    assert march.displacement[:, -1].max() <= gap + 1e-12
    assert march.gap.min() >= -1e-12


def test_the_literal_stop_creates_energy_where_the_neighbour_moves_against_the_node() -> None:
    """With the stop at 0.3 the rule itself, exact in time, gives 1.5 % of the initial energy at the first touch."""
    march, motion = marched("literal", 0.3), solved("literal", 0.3)
    touch, mass = motion.events[0], motion.mesh.mass
    gained = 0.5 * (touch.after @ mass @ touch.after - touch.before @ mass @ touch.before)
    assert gained / (0.5 * mass[1, 1]) == pytest.approx(0.0151, rel=1e-2)
    slab = int(march.first("touch") / STEP)
    assert march.energy[slab] - march.energy[slab - 1] == pytest.approx(gained, rel=0.2), "an instant 1.4e-3 late"


@pytest.mark.parametrize("gap", [0.2, 0.3])
def test_the_instant_predicted_with_the_velocity_kept(gap: float) -> None:
    """The touch is of second order too; what it misses of the slope may swallow a slow touch later on."""
    march, motion = marched("kept", gap), solved("literal", gap)
    assert march.first("touch") == pytest.approx(motion.events[0].time, abs=6.0 * STEP**2)
    assert march.displacement[:, -1].max() <= gap + 1e-12
    assert march.energy[-1] <= 1.0 / 12.0


@cache
def coarse(rule: str, gap: float) -> bars.Record:
    """The example in small strain with the step of the comparisons."""
    return bars.struck(2, RULES[rule], gap=gap, until=UNTIL, step=COARSE)


def difference(rule: str, gap: float, material: sw.NeoHookean | sw.laws.StVenantKirchhoff) -> float:
    """Greatest difference of the curves at v/c = 0.01, relative to the largest displacement."""
    small = coarse(rule, gap)
    large = bars.struck(
        2,
        RULES[rule],
        gap=gap * SPEED,
        until=UNTIL,
        step=COARSE,
        velocity=sw.bodies.OnTag(tag="right", value=SPEED),
        material=material,
    )
    assert large.kinds == small.kinds
    return float(np.abs(large.displacement / SPEED - small.displacement).max() / np.abs(small.displacement).max())


@pytest.mark.few(2)
@pytest.mark.parametrize(
    ("rule", "gap"),
    [
        ("impulse", bars.OUT_OF_REACH),
        ("impulse", 0.1),
        ("impulse", 0.2),
        ("literal", 0.2),
        ("kept", 0.2),
    ],
)
def test_in_large_deformation_the_curves_are_the_same(rule: str, gap: float) -> None:
    """Neo-Hookean bar at v/c = 0.01."""
    assert difference(rule, gap, sw.NeoHookean(E=1.0, nu=0.0)) <= 0.01


@pytest.mark.parametrize(("gap", "most"), [(0.2, 0.008), (bars.OUT_OF_REACH, 0.015)])
def test_st_venant_kirchhoff_where_the_stop_keeps_the_strain_small(gap: float, most: float) -> None:
    """Within 1 % behind a stop at 0.2; the free bar is stretched to 0.8 %, and its phase drifts by 1.3 %."""
    assert difference("impulse", gap, sw.laws.StVenantKirchhoff(E=1.0, nu=0.0)) <= most


def test_the_energy_rule_with_the_hat_spread_over_the_mesh() -> None:
    """A node without inertia cannot be struck; the hat of the example on twenty elements can.

    The motion sits in the last elements, where the inertia is kept as near to its place as can be.
    """
    march = bars.struck(20, sw.contact.Energy(spread=1), gap=0.2, velocity=bars.HAT, until=5.0)
    located = bars.struck(20, sw.contact.Energy(located=True, spread=1), gap=0.2, velocity=bars.HAT, until=5.0)
    for m in (march, located):
        assert np.abs(m.error).max() <= 1e-12 * m.energy[0]
        assert m.gap.min() >= -1e-12
        starts = [start for start, _ in m.contacts(apart=0.5)]
        assert starts == pytest.approx([0.2764, 4.1838], abs=0.02)
    assert np.abs(march.displacement - located.displacement).max() <= 5e-3
