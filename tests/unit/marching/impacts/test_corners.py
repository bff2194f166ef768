"""Nodes that face several obstacles, and nodes that are supported as well."""

import numpy as np
import pytest

from softway.bodies.solid import Fixed
from softway.contact.contact import Contact
from softway.contact.impact_rule import Energy, ImpactRule, Impulse, Paper
from softway.marching.march import march
from softway.model.build import build
from softway.model.scene import Scene

RULES = [Energy(), Energy(located=True), Impulse(), Paper()]
INTO = (-0.1, -0.1)


def name(rule: ImpactRule) -> str:
    return "located" if rule == Energy(located=True) else type(rule).__name__


rules = pytest.mark.parametrize("rule", RULES, ids=name)


def slide_into_corner(shop, rule: ImpactRule, normal: tuple[float, float], until: float = 1.2):
    walls = {**shop.floor, "wall": shop.plane((0.0, 0.0), normal)}
    solid = shop.block(INTO, material=shop.linear)
    return shop.move(solid, walls, timing=rule, tag="surface", until=until)


@rules
@pytest.mark.parametrize("normal", [(1.0, 0.0), (1.0, 1.0), (2.0, 1.0)], ids=["square", "oblique", "steep"])
def test_a_corner_keeps_both_gaps(shop, rule: ImpactRule, normal: tuple[float, float]) -> None:
    motion = slide_into_corner(shop, rule, normal)
    assert motion.least_gap >= -1e-15
    assert all(c.count > 0 for s in motion.steps[10:11] for c in s.ledger.contacts.values())
    assert not any(s.report.rejections for s in motion.steps)
    if isinstance(rule, Energy):
        assert motion.energy_error <= 1e-12


@rules
def test_the_forces_in_an_oblique_corner_balance_momentum(shop, rule: ImpactRule) -> None:
    assert slide_into_corner(shop, rule, (2.0, 1.0)).momentum_error <= 1e-11


@rules
def test_the_forces_in_a_square_corner_balance_momentum(shop, rule: ImpactRule) -> None:
    assert slide_into_corner(shop, rule, (1.0, 0.0)).momentum_error <= 1e-11


@rules
def test_three_obstacles_around_one_node(shop, rule: ImpactRule) -> None:
    walls = {
        "floor": shop.plane((0.0, 0.0), (0.0, 1.0)),
        "wall": shop.plane((0.0, 0.0), (1.0, 0.0)),
        "slope": shop.plane((0.0, 0.0), (1.0, 1.0)),
    }
    motion = shop.move(shop.block(INTO, material=shop.linear), walls, timing=rule, tag="surface", until=1.2)
    assert motion.least_gap >= -1e-15


def landing_twice(shop, rule: ImpactRule):
    """One floor, declared in two contacts that share the nodes of the bottom."""
    bodies = {"body": shop.block(material=shop.linear), **shop.floor}
    contacts = tuple(Contact(between=(f"body.{tag}", "floor"), timing=rule) for tag in ("bottom", "surface"))
    return list(march(build(Scene(bodies=bodies, contacts=contacts)), until=1.0, step=0.05))


@rules
def test_a_node_in_two_contacts_with_one_obstacle(shop, rule: ImpactRule) -> None:
    once = shop.move(shop.block(material=shop.linear), shop.floor, timing=rule, tag="surface", until=1.0)
    twice = landing_twice(shop, rule)
    np.testing.assert_allclose(twice[-1].after.displacement["body"], once.last.after.displacement["body"], atol=1e-10)


def test_two_contacts_share_the_force_of_a_node(shop) -> None:
    once = shop.move(shop.block(material=shop.linear), shop.floor, tag="surface", until=1.0)
    for a, b in zip(once.steps, landing_twice(shop, Energy()), strict=True):
        total = sum(c.force_n for c in b.ledger.contacts.values())
        assert total == pytest.approx(a.ledger.contacts["body.surface-floor"].force_n, abs=1e-10)


def on_a_slope(shop, rule: ImpactRule):
    """The bottom may slide along y only, and meets an oblique plane."""
    rail = (Fixed(on="bottom", components="x"),)
    solid = shop.block((0.0, -0.1), cells=4, height=0.0, material=shop.linear, supports=rail)
    return shop.move(solid, {"slope": shop.plane((0.0, -0.02), (1.0, 2.0))}, timing=rule, until=2.3)


@rules
def test_supported_contact_nodes_stay_on_their_supports(shop, rule: ImpactRule) -> None:
    motion = on_a_slope(shop, rule)
    held = ~motion.model.free
    for s in motion.steps:
        assert not s.after.displacement["body"][held].any()
        assert not s.after.velocity["body"][held].any()
    assert motion.least_gap >= -1e-15
    if isinstance(rule, Energy):
        assert motion.energy_error <= 1e-12


@rules
def test_supports_and_contacts_of_one_node_balance_momentum(shop, rule: ImpactRule) -> None:
    assert on_a_slope(shop, rule).momentum_error <= 1e-11


@rules
def test_a_candidate_that_cannot_move_is_no_contact(shop, rule: ImpactRule) -> None:
    """A column clamped on the floor, all of whose surface may touch."""
    solid = shop.block((0.0, 0.05), height=0.0, material=shop.linear, supports=(Fixed(on="bottom"),))
    motion = shop.move(solid, shop.floor, timing=rule, tag="surface", until=1.0)
    alone = shop.move(solid, until=1.0)
    assert motion.impulse == 0.0
    assert not motion.events
    if not isinstance(rule, Energy):
        np.testing.assert_allclose(motion.last.after.velocity["body"], alone.last.after.velocity["body"], atol=2e-3)


@rules
def test_a_supported_candidate_inside_the_obstacle_by_rounding(shop, rule: ImpactRule) -> None:
    walls = {"wall": shop.plane(2e-15, 1.0), "right": shop.plane(1.05, -1.0)}
    solid = shop.bar(supports=(Fixed(on="left"),))
    motion = shop.move(solid, walls, timing=rule, tag={"wall": "left", "right": "right"}, until=0.5)
    assert motion.momentum_error <= 1e-11


@rules
def test_a_bar_between_two_walls_at_once(shop, rule: ImpactRule) -> None:
    """One node between two obstacles that leave it no room: it is held, as if supported."""
    walls = {"before": shop.plane(1.0, -1.0), "behind": shop.plane(1.0, 1.0)}
    motion = shop.move(shop.bar(v=0.1), walls, timing=rule, tag="right", until=2.0)
    assert np.abs(motion.last.after.displacement["body"][-1]).max() <= 1e-15
    assert motion.momentum_error <= 1e-11
