"""Blocks that fall on planes in two and three dimensions."""

from dataclasses import replace

import numpy as np
import pytest

from softway.bodies.elements.section import Axisymmetric, PlaneStress
from softway.bodies.inertia.mass_matrix import Consistent, Lumped
from softway.bodies.internal_force.slab_average import AverageField, DiscreteGradient
from softway.bodies.setup.initial_fields import Uniform
from softway.bodies.setup.loads import Gravity, Traction
from softway.bodies.setup.placement import Placement
from softway.bodies.solid import Fixed
from softway.contact.contact import Contact
from softway.contact.impact_rule import Energy, ImpactRule, Impulse, Paper
from softway.marching.march import march
from softway.model.build import build
from softway.model.scene import Scene

RULES = [Energy(), Impulse(), Paper()]
rules = pytest.mark.parametrize("rule", RULES, ids=lambda r: type(r).__name__)


def passed(motion, rule: ImpactRule, momentum: float = 1e-11) -> None:
    """The audit of a fall; what Paper and Impulse leave open falls with the slab."""
    assert motion.energy_error <= (1e-11 if isinstance(rule, Energy) else 2e-2)
    assert motion.momentum_error <= momentum
    assert motion.least_gap >= -1e-15
    assert any(e.kind == "touch" for e in motion.events)
    assert not any(s.report.rejections for s in motion.steps)
    dissipated = [s.ledger.dissipation for s in motion.steps]
    assert (np.diff([0.0, *dissipated]) >= -1e-15).all()


@pytest.mark.few(5)
@rules
@pytest.mark.parametrize("angle", [0.0, 0.2, np.pi / 4], ids=["flat", "tilted", "corner"])
def test_a_block_on_the_floor(shop, rule: ImpactRule, angle: float) -> None:
    motion = shop.move(shop.block(angle=angle), shop.floor, timing=rule, tag="surface", until=2.5)
    passed(motion, rule)
    assert motion.last.ledger.momentum[1] > 0.0, "it comes back"


@pytest.mark.few(4)
@rules
@pytest.mark.parametrize("cell", ["tri3", "quad8", "quad9", "tri6"])
def test_other_cells(shop, rule: ImpactRule, cell: str) -> None:
    """The literal rule needs nodes of positive mass: row sums at corners are zero in a consistent tri6, and negative
    in a quad8.
    """
    mass = Lumped() if isinstance(rule, Paper) else Consistent()
    solid = shop.block(angle=0.2, cell=cell, cells=2, mass=mass)
    passed(shop.move(solid, shop.floor, timing=rule, until=1.5), rule)


@rules
def test_lumped_mass(shop, rule: ImpactRule) -> None:
    passed(shop.move(shop.block(angle=0.2, mass=Lumped()), shop.floor, timing=rule, tag="surface"), rule)


@rules
def test_plane_stress(shop, rule: ImpactRule) -> None:
    passed(shop.move(shop.block(section=PlaneStress(thickness=0.1)), shop.floor, timing=rule, until=1.5), rule)


@rules
def test_a_cylinder_around_the_axis(shop, rule: ImpactRule) -> None:
    """Radial momentum is not a momentum: only the axial one is balanced."""
    solid = shop.block(section=Axisymmetric(), supports=(Fixed(on="left", components="x"),))
    motion = shop.move(solid, shop.floor, timing=rule, until=1.5)
    passed(motion, rule, momentum=np.inf)
    change = motion.last.ledger.momentum[1] + 0.1 * np.pi
    assert change == pytest.approx(motion.impulse, rel=1e-11)


@pytest.mark.few(5)
@rules
@pytest.mark.parametrize("cell", ["hex8", "hex20", "tet4"])
def test_a_cube_in_space(shop, rule: ImpactRule, cell: str) -> None:
    mass = Lumped() if isinstance(rule, Paper) and cell == "hex20" else Consistent()
    solid = shop.cube((0.02, 0.0, -0.1), cell=cell, angle=0.3, mass=mass)
    motion = shop.move(solid, shop.ground, timing=rule, until=1.2)
    passed(motion, rule)
    sideways = motion.last.ledger.momentum[:2] - [0.02, 0.0]
    assert np.abs(sideways).max() <= 1e-13, "without friction"


@rules
def test_an_oblique_floor_is_the_floor_turned(shop, rule: ImpactRule) -> None:
    solid = shop.block((0.03, -0.1), angle=0.2)
    level = shop.move(solid, shop.floor, timing=rule)
    turn = np.array([[np.cos(0.7), -np.sin(0.7)], [np.sin(0.7), np.cos(0.7)]])
    mesh = level.model.parts[0].mesh
    turned = replace(
        solid, mesh=replace(mesh, points=mesh.points @ turn.T), place=Placement(),
        velocity=Uniform(value=tuple(turn @ [0.03, -0.1])),
    )  # fmt: skip
    slope = shop.move(turned, {"floor": shop.plane((0.0, 0.0), tuple(turn @ [0.0, 1.0]))}, timing=rule)
    for name in ("displacement", "velocity"):
        a, b = getattr(level.last.after, name)["body"], getattr(slope.last.after, name)["body"]
        np.testing.assert_allclose(b @ turn, a, atol=1e-9)
    assert [e.node for e in slope.events] == [e.node for e in level.events]
    np.testing.assert_allclose([e.time for e in slope.events], [e.time for e in level.events], atol=1e-9)


@pytest.mark.parametrize("axis", [0, 1, 2], ids="xyz")
def test_an_oblique_floor_in_space(shop, axis: int) -> None:
    """The cube seen along another axis: coordinates permuted."""
    order = np.roll([0, 1, 2], axis)
    solid = shop.cube((0.02, 0.01, -0.1), cells=(2, 2, 2), angle=0.3)
    level = shop.move(solid, shop.ground, until=0.8)
    mesh = level.model.parts[0].mesh
    other = replace(
        solid, mesh=replace(mesh, points=mesh.points[:, order]), place=Placement(),
        velocity=Uniform(value=tuple(np.array([0.02, 0.01, -0.1])[order])),
    )  # fmt: skip
    normal = tuple(np.array([0.0, 0.0, 1.0])[order])
    turned = shop.move(other, {"floor": shop.plane((0.0, 0.0, 0.0), normal)}, until=0.8)
    a, b = level.last.after.velocity["body"], turned.last.after.velocity["body"]
    np.testing.assert_allclose(b, a[:, order], atol=1e-10)


def test_the_located_rule_in_the_plane(shop) -> None:
    for tag, angle in (("bottom", 0.0), ("surface", 0.3)):
        solid = shop.block((0.02, -0.1), material=shop.linear, angle=angle)
        motion = shop.move(solid, shop.floor, timing=Energy(located=True), tag=tag)
        passed(motion, Energy())
        plain = shop.move(solid, shop.floor, tag=tag)
        force = [np.array([s.ledger.contacts[f"body.{tag}-floor"].force_n for s in m.steps]) for m in (motion, plain)]
        assert np.abs(force[0] - force[1]).max() <= 0.1 * np.abs(force[0]).max()
        opened = [e.kind for e in motion.events]
        assert opened.count("touch") - opened.count("release") == motion.last.ledger.contacts[f"body.{tag}-floor"].count


@pytest.mark.parametrize("force", [AverageField(), DiscreteGradient()], ids=lambda f: type(f).__name__)
def test_chord_averages_with_contact(shop, force: object) -> None:
    motion = shop.move(shop.block(angle=0.2, force=force), shop.floor, tag="surface")
    assert motion.energy_error <= 1e-11
    assert motion.least_gap >= -1e-15


@pytest.mark.parametrize("force", [AverageField(), DiscreteGradient()], ids=lambda f: type(f).__name__)
def test_chord_averages_with_contact_keep_momentum(shop, force: object) -> None:
    motion = shop.move(shop.block(angle=0.2, force=force), shop.floor, tag="surface")
    assert motion.momentum_error <= 1e-11
    assert abs(motion.last.ledger.momentum[0]) <= 1e-13


@rules
def test_two_bodies_each_with_its_own_contact(shop, rule: ImpactRule) -> None:
    solids = {"a": shop.block(), "b": shop.block(material=shop.linear, cell="tri3", angle=0.1)}
    tools = {"f": shop.plane((0.0, 0.0), (0.0, 1.0)), "g": shop.plane((0.0, -0.01), (0.5, 1.0))}
    pairs = (("a", "f"), ("b", "g"))
    contacts = tuple(Contact(between=(f"{s}.surface", t), timing=rule) for s, t in pairs)
    both = list(march(Scene(bodies={**solids, **tools}, contacts=contacts), until=2.0, step=0.05))
    for (solid, tool), contact in zip(pairs, contacts, strict=True):
        scene = Scene(bodies={solid: solids[solid], tool: tools[tool]}, contacts=(contact,))
        alone = list(march(scene, until=2.0, step=0.05))
        np.testing.assert_allclose(both[-1].after.velocity[solid], alone[-1].after.velocity[solid], atol=1e-10)
        forces = [[s.ledger.contacts[contact.label].force_n for s in steps] for steps in (both, alone)]
        np.testing.assert_allclose(*forces, atol=1e-10)
        nodes = [[e.node for s in steps for e in s.events if e.contact == contact.label] for steps in (both, alone)]
        assert nodes[0] == nodes[1]


@rules
def test_loads_on_contact_nodes(shop, rule: ImpactRule) -> None:
    loads = (
        Traction(on="body.bottom", value=(0.0, -0.02)),
        Traction(on="body.left", value=(0.01, 0.0)),
        Gravity(acceleration=(0.0, -0.02)),
    )
    motion = shop.move(shop.block((0.0, 0.0)), shop.floor, timing=rule, loads=loads, until=3.0)
    passed(motion, rule)
    assert motion.last.ledger.momentum[0] == pytest.approx(0.01 * 3.0, rel=1e-11)


@rules
def test_gravity_has_the_weight_of_the_body(shop, rule: ImpactRule) -> None:
    motion = shop.move(shop.block(height=5.0), shop.floor, timing=rule, loads=(Gravity(acceleration=(0.0, -2.0)),))
    assert motion.model.load.sum(axis=0) == pytest.approx([0.0, -2.0], abs=1e-14)
    np.testing.assert_allclose(motion.last.after.displacement["body"], [[0.0, -0.2 - 4.0]] * 16, atol=1e-11)


def test_a_node_that_touches_and_lets_go_in_one_slab(shop) -> None:
    walls = {**shop.floor, "wall": shop.plane((0.0, 0.0), (1.0, 1.0))}
    solid = shop.block((-0.1, -0.1), cells=4)
    motion = shop.move(solid, walls, timing=Impulse(), tag="surface", until=0.8, step=0.025)
    both = [s for s in motion.steps for e in s.events if e.kind == "release" and any(
        o.kind == "touch" and (o.node, o.contact) == (e.node, e.contact) for o in s.events
    )]  # fmt: skip
    assert both
    assert motion.momentum_error <= 1e-11
    assert motion.least_gap >= -1e-15


def test_a_second_touch_in_the_slab_of_the_first(shop) -> None:
    """The jump is not felt twice by a node whose touch it brings about."""
    walls = {**shop.floor, "wall": shop.plane((0.0, 0.0), (1.0, 1.0))}
    errors = []
    for h in (0.025, 0.0125):
        motion = shop.move(shop.block((-0.1, -0.1), cells=4), walls, timing=Impulse(), tag="surface", until=0.3, step=h)
        errors.append(motion.energy_error)
    assert max(errors) <= 2e-3


def test_the_state_of_a_fall_is_finite_and_cannot_be_written(shop) -> None:
    motion = shop.move(shop.block(), shop.floor, until=0.2)
    state = motion.last.after
    with pytest.raises(ValueError, match="read-only"):
        state.velocity["body"][0, 0] = 1.0
    for field in (state.displacement, state.velocity, state.acceleration, state.pressure):
        assert all(np.isfinite(a).all() for a in field.values())
    assert build(motion.model.scene).contacts.labels == tuple(state.closed)
