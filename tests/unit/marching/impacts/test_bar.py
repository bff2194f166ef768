"""A bar thrown at a wall, by every contact rule: losses in closed form, momentum, energy and instants."""

from functools import cache

import numpy as np
import pytest

from softway.apps.verify.exact import semidiscrete
from softway.bodies.inertia.mass_matrix import Consistent, Lumped, MassRule
from softway.bodies.setup.loads import Gravity
from softway.contact.impact_rule import Energy, ImpactRule, Impulse, Paper
from softway.laws.bulk import NeoHookean
from softway.marching.state.step_control import StepControl
from softway.model.time_weight import Collocation, EndPeaks, Momentum

RULES = [Energy(), Energy(located=True), Impulse(), Paper(), Paper(approach="extrapolated")]
LOSSLESS, LOSSY = RULES[:2], RULES[2:]


def named(rule: object) -> str:
    return f"{rule}".replace("()", "").replace("(located=False)", "")


rules = pytest.mark.parametrize("rule", RULES, ids=named)
lossless = pytest.mark.parametrize("rule", LOSSLESS, ids=named)
lossy = pytest.mark.parametrize("rule", LOSSY, ids=named)


def throw(shop, rule: ImpactRule, gap: float = 0.1, cells: int = 4, until: float = 3.0, step: float = 0.05, **options):
    solid = shop.bar(cells, **{k: options.pop(k) for k in ("mass", "material", "v") if k in options})
    return shop.move(
        solid, {"wall": shop.plane(1.0 + gap, -1.0)}, timing=rule, tag="right", until=until, step=step, **options
    )


@rules
def test_the_force_changes_the_momentum(shop, rule: ImpactRule) -> None:
    motion = throw(shop, rule)
    assert motion.momentum_error <= 1e-12
    assert motion.last.ledger.momentum[0] == pytest.approx(1.0 - motion.impulse, abs=1e-12)
    assert motion.least_gap >= -1e-15
    assert all(s.ledger.contacts["body.right-wall"].force_n >= -1e-12 for s in motion.steps)


@pytest.mark.few(6)
@lossless
@pytest.mark.parametrize("mass", [Consistent(), Lumped()], ids=["consistent", "lumped"])
@pytest.mark.parametrize("step", [0.04, 0.25, 2.5])
def test_the_energy_rule_keeps_the_energy(shop, rule: ImpactRule, mass: MassRule, step: float) -> None:
    motion = throw(shop, rule, mass=mass, step=step, until=max(3.0, step))
    assert motion.energy_error <= 1e-11
    assert motion.last.ledger.dissipation == 0.0
    assert motion.last.ledger.momentum[0] < -0.5, "it comes back"


@pytest.mark.parametrize("cells", [2, 3, 8])
@pytest.mark.parametrize(("mass", "fraction"), [(Consistent(), 2 / 3), (Lumped(), 1 / 2)], ids=["consistent", "lumped"])
@pytest.mark.parametrize("rule", LOSSY[1:], ids=named)
def test_the_energy_loss_of_the_literal_rule(
    shop, rule: ImpactRule, mass: MassRule, fraction: float, cells: int
) -> None:
    """2 / (3 N) of the kinetic energy with consistent mass, 1 / (2 N) lumped."""
    motion = throw(shop, rule, cells=cells, mass=mass, until=0.2)
    assert motion.last.ledger.dissipation / 0.5 == pytest.approx(fraction / cells, rel=1e-9)


@pytest.mark.parametrize(
    ("mass", "cells", "fraction"), [(Consistent(), 2, 1 / 7), (Lumped(), 2, 1 / 4), (Lumped(), 5, 1 / 10)], ids=str
)
def test_the_energy_loss_of_the_balanced_jump(shop, mass: MassRule, cells: int, fraction: float) -> None:
    motion = throw(shop, Impulse(), cells=cells, mass=mass, until=0.2)
    assert motion.last.ledger.dissipation / 0.5 == pytest.approx(fraction, rel=1e-9)
    (event,) = motion.events
    assert event.impulse * 1.0 / 2.0 == pytest.approx(motion.last.ledger.dissipation, rel=1e-9)


@pytest.mark.slow
@lossy
def test_the_energy_error_vanishes_with_the_slab_length(shop, rule: ImpactRule) -> None:
    coarse, fine = (throw(shop, rule, gap=0.103, step=h, until=2.2).energy_error for h in (0.04, 0.01))
    assert coarse < 1e-2
    assert fine < coarse / 4.0, "first order at least"


@rules
@pytest.mark.parametrize("gap", [0.12, 0.137])
def test_the_instant_of_the_touch_is_exact_in_free_flight(shop, rule: ImpactRule, gap: float) -> None:
    touch = throw(shop, rule, gap=gap, until=0.3).events[0]
    assert (touch.kind, touch.node, touch.contact) == ("touch", 4, "body.right-wall")
    # the located rule cuts the chord between the ends of the slab, which the wave from the wall has bent
    assert touch.time == pytest.approx(gap, abs=1e-4 if rule == Energy(located=True) else 1e-9)
    assert touch.position == pytest.approx([1.0 + gap], abs=1e-12)
    assert touch.velocity_before == pytest.approx(-1.0, abs=1e-9)
    assert touch.velocity_after == 0.0


def fallen(shop, approach: str, step: float = 0.1, **options: object):
    """A bar that falls from rest, 0.103 above the floor, under unit gravity."""
    loads = (Gravity(acceleration=-1.0),)
    return shop.move(
        shop.bar(4, 0.0), {"floor": shop.plane(-0.103, 1.0)}, timing=Paper(approach=approach), tag="left", loads=loads,
        until=0.8, step=step, **options,
    )  # fmt: skip


def test_an_extrapolated_approach_is_exact_in_free_fall_and_a_kept_one_is_not(shop) -> None:
    exact = np.sqrt(2 * 0.103)
    assert fallen(shop, "extrapolated").events[0].time == pytest.approx(exact, abs=1e-12)
    assert fallen(shop, "extrapolated").events[0].velocity_before == pytest.approx(-exact, abs=1e-12)
    late = [fallen(shop, "kept", h).events[0].time - exact for h in (0.1, 0.02)]
    assert 1e-4 < late[0] < 1e-2
    assert abs(late[1]) < late[0]


def test_the_slope_of_the_approach_is_part_of_the_state(shop) -> None:
    whole = fallen(shop, "extrapolated")
    rest = fallen(shop, "extrapolated", state=whole.steps[3].after)
    assert whole.steps[4].events, "the touch is in the first slab after"
    assert shop.distance(whole, rest) <= 1e-12
    assert rest.events[0].time == pytest.approx(whole.events[0].time, abs=1e-14)


@pytest.fixture(scope="module")
def at_a_boundary(shop):
    """A touch at the boundary of two slabs, computed once for each rule."""
    return cache(lambda rule: throw(shop, rule, gap=0.1, until=0.5))


@rules
@pytest.mark.parametrize("missed", [1e-16, -1e-16, 1e-12, -1e-9, 1e-9])
def test_a_touch_at_the_boundary_of_a_slab(shop, at_a_boundary, rule: ImpactRule, missed: float) -> None:
    """Whichever slab it falls into, the motion is that of the exact boundary."""
    reference = at_a_boundary(rule)
    motion = throw(shop, rule, gap=0.1 + missed, until=0.5)
    assert shop.distance(motion, reference) <= 1e-5 if rule in LOSSLESS else 1e-6
    assert motion.momentum_error <= 1e-12
    assert motion.least_gap >= -1e-15
    assert not any(s.report.rejections for s in motion.steps)


@rules
def test_a_bar_that_starts_on_the_wall(shop, rule: ImpactRule) -> None:
    touching, later = throw(shop, rule, gap=0.0, until=1.5), throw(shop, rule, gap=0.1, until=1.6)
    assert touching.events[0].time == pytest.approx(0.0, abs=1e-12)
    a, b = touching.last.after.velocity["body"], later.last.after.velocity["body"]
    np.testing.assert_allclose(a, b, atol=1e-9)


@rules
def test_a_bar_leaves_again(shop, rule: ImpactRule) -> None:
    """The continuum leaves after 2 L / c = 2."""
    motion = throw(shop, rule, cells=10, until=2.6, step=0.05)
    assert [e.kind for e in motion.events][0] == "touch"
    assert [e.kind for e in motion.events][-1] == "release"
    assert motion.events[-1].time == pytest.approx(2.1, abs=0.2)
    assert motion.last.ledger.contacts["body.right-wall"].count == 0
    assert motion.last.ledger.contacts["body.right-wall"].min_gap > 0.1


@pytest.mark.parametrize("rule", [*LOSSLESS, Impulse(), Paper()], ids=named)
def test_a_slab_longer_than_the_contact(shop, rule: ImpactRule) -> None:
    motion = throw(shop, rule, step=2.6, until=2.6, control=StepControl(approach=100.0))
    assert len(motion.steps) == 1
    assert motion.momentum_error <= 1e-11
    assert motion.least_gap >= -1e-15
    if rule in LOSSLESS:
        assert motion.energy_error <= 1e-11


@pytest.mark.slow
def test_the_balanced_jump_converges_to_the_motion_of_the_mesh(shop) -> None:
    """Second order through touch and release, towards the bar of four cells integrated exactly."""
    exact = semidiscrete.solve(semidiscrete.bar(4), np.zeros(5), np.ones(5), gap=0.103, until=2.4)
    errors = []
    for h in (0.02, 0.01, 0.005):
        motion = throw(shop, Impulse(), gap=0.103, step=h, until=2.4)
        errors.append(abs(motion.last.ledger.momentum[0] - exact.mean_velocity(2.4)))
        release = motion.events[-1].time
    assert release == pytest.approx(exact.times("release")[0], abs=1e-3)
    assert errors[2] < 1e-4
    assert np.log2(errors[0] / errors[2]) / 2.0 == pytest.approx(2.0, abs=0.3)


@pytest.mark.slow
@pytest.mark.few(6)
@lossy
@pytest.mark.parametrize("weight", [Momentum(), Collocation(), EndPeaks(theta=0.7), EndPeaks(theta=1.0)], ids=str)
def test_every_weight_goes_with_the_rules_of_nodes_with_inertia(shop, rule: ImpactRule, weight: object) -> None:
    motion = throw(shop, rule, weight=weight, until=2.5)
    assert motion.momentum_error <= 1e-12
    assert motion.least_gap >= -1e-15
    assert motion.last.ledger.momentum[0] < -0.5


@lossless
def test_two_walls_and_many_bounces(shop, rule: ImpactRule) -> None:
    walls = {"left": shop.plane(-0.05, 1.0), "right": shop.plane(1.05, -1.0)}
    motion = shop.move(
        shop.bar(4, 0.2), walls, timing=rule, tag={"left": "left", "right": "right"}, until=10.0, step=0.1
    )
    assert motion.energy_error <= 1e-11
    assert motion.least_gap >= -1e-15
    assert motion.momentum_error <= 1e-11
    assert len(motion.events) >= 6


@rules
def test_contact_nodes_do_no_work(shop, rule: ImpactRule) -> None:
    """The complementarity of force and velocity, eq. (3.9), summed over the run."""
    motion = throw(shop, rule)
    power = max(c.power_residual for s in motion.steps for c in s.ledger.contacts.values())
    assert power <= 1e-15


@pytest.mark.parametrize("rule", [Energy(), Impulse(), Paper()], ids=named)
def test_large_deformation(shop, rule: ImpactRule) -> None:
    motion = throw(shop, rule, material=NeoHookean(E=1.0, nu=0.3), v=0.3)
    assert motion.momentum_error <= 1e-11
    assert motion.least_gap >= -1e-15
    assert motion.energy_error <= (1e-12 if rule == Energy() else 0.02)


@pytest.mark.parametrize("cells", [20, 40])
def test_the_force_on_the_wall_is_the_impedance_times_the_speed(shop, cells: int) -> None:
    """rho c v A = 1 from 0.1 to 2.1; mean over the middle of the contact."""
    motion = throw(shop, Energy(), cells=cells, step=0.5 / cells, until=2.0)
    force = [s.ledger.contacts["body.right-wall"].force_n for s in motion.steps if 0.5 < s.slab.end < 1.9]
    assert np.mean(force) == pytest.approx(1.0, abs=0.01)


def test_the_split_of_figure_4_goes_over_into_the_product_form(shop) -> None:
    """Same loss, balanced momentum, and a difference that falls with the slab in first order."""
    apart = []
    for h in (0.04, 0.02, 0.01):
        split, product = (throw(shop, Paper(split=s), gap=0.11, step=h, until=1.0) for s in ("triangle", "product"))
        assert split.momentum_error <= 1e-12
        assert split.least_gap >= -1e-15
        assert split.last.ledger.dissipation == pytest.approx(0.5 * 2 / 3 / 4, rel=1e-2)
        apart.append(shop.distance(split, product))
    assert apart[0] > 1e-4
    assert apart[2] < apart[1] < apart[0]
    assert apart[2] < 0.5 * apart[0]
