"""Two deformable bodies that meet: a mirror is a wall, and nothing is lost between them."""

import numpy as np
import pytest

import softway as sw
from softway.bodies.internal_force.slab_average import EnergyMomentum, Weighted
from softway.bodies.setup.initial_fields import Uniform
from softway.bodies.setup.placement import Placement, Rotation
from softway.bodies.solid import Solid
from softway.contact.contact import Contact, DualMortar, NodeToSurface
from softway.contact.impact_rule import Energy, ImpactRule, Impulse
from softway.errors import InputError, NumericsError
from softway.marching.march import march
from softway.meshes.generators.shapes import disc
from softway.model.build import build
from softway.model.scene import Scene

RULES = [Energy(), Impulse()]
rules = pytest.mark.parametrize("rule", RULES, ids=lambda r: type(r).__name__)
BOTH = NodeToSurface(nodes="both")


def met(
    a: Solid, b: Solid, tags: tuple[str, str], rule: ImpactRule = RULES[0], method: object = None, until: float = 2.0,
    step: float = 0.05,
) -> list:  # fmt: skip
    contact = Contact(between=(f"a.{tags[0]}", f"b.{tags[1]}"), name="c", timing=rule, method=method)
    return list(march(Scene(bodies={"a": a, "b": b}, contacts=(contact,)), until=until, step=step))


@rules
@pytest.mark.parametrize("cells", [1, 4])
def test_two_equal_bars_meet_as_at_a_wall(shop, rule: ImpactRule, cells: int) -> None:
    v = 0.4
    one, two = shop.bar(cells, v), shop.bar(cells, -v, place=Placement(translation=(1.2,)))
    pair = met(one, two, ("right", "left"), rule)
    alone = shop.move(one, {"wall": shop.plane(1.1, -1.0)}, timing=rule, tag="right", until=2.0)
    for s, t in zip(pair, alone.steps, strict=True):
        u, w = s.after.displacement, t.after.displacement["body"]
        np.testing.assert_allclose(u["a"], w, atol=1e-11)
        np.testing.assert_allclose(u["b"], -w[::-1], atol=1e-11)
        assert s.ledger.contacts["c"].force_n == pytest.approx(t.ledger.contacts["body.right-wall"].force_n, abs=1e-10)
        assert s.ledger.dissipation == pytest.approx(2.0 * t.ledger.dissipation, abs=1e-11)
        assert s.ledger.energy_error == pytest.approx(2.0 * t.ledger.energy_error, abs=1e-11)
    told = [[(e.kind, e.time) for e in steps for e in e.events] for steps in (pair, alone.steps)]
    assert [k for k, _ in told[0]] == [k for k, _ in told[1]] == ["touch"] + ["release"] * (len(told[0]) - 1)
    np.testing.assert_allclose([t for _, t in told[0]], [t for _, t in told[1]], atol=1e-9)


def test_bars_of_different_stiffness_and_mass(shop) -> None:
    """Momentum and energy stay; a bar of the same impedance and half the length stops the other behind it."""
    law = type(shop.bar().material)(E=4.0)
    heavy = shop.bar(6, 0.0, material=law, density=3.0, place=Placement(translation=(1.05,)))
    steps = met(shop.bar(4, 0.3), heavy, ("right", "left"), until=4.0)
    assert max(abs(s.ledger.energy_error) for s in steps) <= 1e-13
    assert max(abs(s.ledger.momentum[0] - 0.3) for s in steps) <= 1e-14
    assert min(s.certificate.min_gap for s in steps) >= -1e-15
    assert {e.kind for s in steps for e in s.events} == {"touch", "release"}


def test_three_bars_in_a_row(shop) -> None:
    """The push goes through: the last leaves with the velocity of the first, but for the waves of the mesh."""
    bodies = {
        name: shop.bar(10, 0.2 if name == "a" else 0.0, place=Placement(translation=(1.02 * k,)))
        for k, name in enumerate("abc")
    }
    contacts = tuple(Contact(between=(f"{x}.right", f"{y}.left"), name=x + y) for x, y in ("ab", "bc"))
    steps = list(march(Scene(bodies=bodies, contacts=contacts), until=6.0, step=0.05))
    assert max(abs(s.ledger.energy_error) for s in steps) <= 1e-13
    ends = {name: float(v.mean()) for name, v in steps[-1].after.velocity.items()}
    assert ends["c"] == pytest.approx(0.2, abs=0.02)
    assert abs(ends["a"]) + abs(ends["b"]) <= 0.02
    both = [s for s in steps if all(c.force_n > 0.0 for c in s.ledger.contacts.values())]
    assert both, "all three are in touch for a while"
    assert all(len(set(s.report.scalars.values())) == 1 for s in both), "one scalar for the group"


@pytest.mark.parametrize("method", [BOTH, DualMortar()], ids=["nodes", "mortar"])
def test_a_block_and_its_mirror_image_meet_as_on_a_floor(shop, method: object) -> None:
    top = shop.block((0.02, -0.1), force=EnergyMomentum())
    low = shop.block((0.02, 0.1), height=-1.02, force=EnergyMomentum())
    pair = met(low, top, ("top", "bottom"), method=method, until=1.5)
    alone = shop.move(top, shop.floor, until=1.5)
    np.testing.assert_allclose(pair[-1].after.displacement["b"], alone.last.after.displacement["body"], atol=1e-9)
    force = [s.ledger.contacts["c"].force_n for s in pair]
    np.testing.assert_allclose(force, [s.ledger.contacts["body.bottom-floor"].force_n for s in alone.steps], atol=1e-9)


@pytest.mark.few(4)
@pytest.mark.parametrize("method", [BOTH, DualMortar()], ids=["nodes", "mortar"])
@pytest.mark.parametrize("cell", ["quad4", "quad8", "hex8", "hex20"])
def test_bodies_that_meet_off_centre_keep_energy_momentum_and_spin(shop, cell: str, method: object) -> None:
    """They set each other turning."""
    dim, few = 2 if cell.startswith("quad") else 3, 2 if cell == "hex20" else 3
    if dim == 2:
        low, top = shop.block((0.0, 0.0), cell=cell, height=0.0), shop.block((-0.05, -0.1), cell=cell, cells=4)
    else:
        low, top = (shop.cube(v, cells=(few,) * 3, cell=cell) for v in ((0.0, 0.0, 0.0), (-0.05, 0.03, -0.1)))
    a, b = (
        Solid(
            mesh=s.mesh, material=s.material, density=1.0, velocity=s.velocity, force=EnergyMomentum(),
            place=Placement(translation=t),
        )
        for s, t in ((low, (0.0,) * dim), (top, (0.3, 0.2, 1.05)[3 - dim :] if dim == 3 else (0.3, 1.05)))
    )  # fmt: skip
    steps = met(a, b, ("top", "bottom"), method=method, until=1.0 if dim == 3 else 2.0)
    first = steps[0].ledger
    assert max(abs(s.ledger.energy_error) for s in steps) <= 1e-14
    assert max(np.abs(s.ledger.momentum - first.momentum).max() for s in steps) <= 1e-14
    assert max(np.abs(s.ledger.spin - first.spin).max() for s in steps) <= 1e-14
    assert min(s.certificate.min_gap for s in steps) >= -1e-14
    assert max(s.ledger.contacts["c"].force_n for s in steps) > 0.01
    turning = steps[-1].after.velocity["a"]
    assert np.abs(turning - turning.mean(axis=0)).max() > 0.01


def test_nodes_with_inertia_keep_the_momentum(shop) -> None:
    turned = Placement(rotations=(Rotation(angle=0.3),), translation=(0.5, 1.25))
    low = shop.block((0.0, 0.0), height=0.0)
    top = shop.block((-0.05, -0.2), place=turned)
    steps = met(low, top, ("top", "bottom"), Impulse(), NodeToSurface(), until=1.5)
    assert max(np.abs(s.ledger.momentum - [-0.05, -0.2, 0.0]).max() for s in steps) <= 1e-14
    assert min(s.certificate.min_gap for s in steps) >= -1e-15
    assert any(e.kind == "touch" for s in steps for e in s.events)


def test_bodies_that_overlap_at_the_start_are_named(shop) -> None:
    top = shop.block((0.0, 0.0), velocity=Uniform(), height=0.9)
    with pytest.raises(InputError) as error:
        met(shop.block(height=0.0), top, ("top", "bottom"), method=BOTH)
    assert error.value.where == "contacts[0].between"
    assert "0.1 m inside" in error.value.problem
    assert "'a'" in error.value.problem
    assert "'b'" in error.value.problem


@pytest.mark.parametrize("cells", [4, 6])
def test_curved_surfaces_that_are_apart_start_without_force(shop, cells: int) -> None:
    """What stands for the facets overlaps by 30 and 10 times the distance of the nodes; they meet as these do."""
    low, v, height = shop.block(velocity=Uniform(), height=0.0), 0.01, 1e-4
    place = Placement(rotations=(Rotation(angle=0.2),), translation=(0.5, 0.0), bottom=1.0 + height)
    ball = shop.block((0.0, -v), mesh=disc(0.5, cells, cell="tri6"), place=place)
    steps = met(low, ball, ("top", "surface"), until=0.04, step=0.004)
    begun = steps[0].before
    assert all(np.abs(u).max() == 0.0 for u in begun.displacement.values())
    assert begun.pressure["c"].max() == 0.0
    energy = 0.5 * np.pi * 0.25 * v**2
    assert max(abs(s.ledger.energy_error) for s in steps) <= 1e-12 * energy
    assert max(s.ledger.energy_kinetic + s.ledger.energy_strain for s in steps) <= energy
    assert sum(c.force_n for s in steps for c in s.ledger.contacts.values()) > 0.0


def test_surfaces_that_overlap_slightly_are_pressed_apart(shop) -> None:
    """Faces of four nodes may differ from flat ones by more: no error, but no overlap that stays either."""
    low, top = (shop.cube((0.0, 0.0, 0.0), height=z) for z in (0.0, 0.998))
    begun = met(low, top, ("top", "bottom"), until=0.05)[0].before
    up, down = low.mesh.nodes("top"), top.mesh.nodes("bottom")
    parted = begun.displacement["b"][down, 2].mean() - begun.displacement["a"][up, 2].mean()
    assert parted == pytest.approx(0.002, rel=0.05)
    assert begun.pressure["c"].max() > 0.0


@pytest.mark.parametrize("method", [DualMortar(), NodeToSurface()], ids=lambda m: type(m).__name__)
def test_a_stop_of_a_mortar_contact_names_the_other_method(shop, method: object) -> None:
    low, top = shop.block(velocity=Uniform(), height=0.0), shop.block((0.1, -0.2), height=1.01)
    scene = Scene(bodies={"a": low, "b": top}, contacts=(Contact(between=("a.top", "b.bottom"), method=method),))
    with pytest.raises(NumericsError) as stopped:
        list(march(scene, until=1.0, step=0.1, method=sw.FixedPoint(limit=1)))
    assert ("NodeToSurface" in stopped.value.remedy) == isinstance(method, DualMortar)


def test_without_contact_they_pass_through_each_other(shop) -> None:
    low, top = shop.block((0.0, 0.1), height=0.0, force=Weighted()), shop.block((0.0, -0.1), height=0.5)
    model = build(Scene(bodies={"a": low, "b": top}))
    last = list(march(model, until=1.0, step=0.25))[-1]
    np.testing.assert_allclose(last.after.velocity["a"], [[0.0, 0.1]] * 16, atol=1e-15)


@pytest.mark.few(2)
@pytest.mark.parametrize("between", [("upper", "lower"), ("upper.bottom", "lower.top")])
@pytest.mark.parametrize("depth", [0.005, 0.05])
def test_free_blocks_that_overlap_are_moved_apart_and_stay(between: tuple[str, str], depth: float) -> None:
    """Nothing holds them: they end up without strain, just touching, however deep they were; a little tilted, since
    the upper one is not over the middle.
    """
    blocks = {
        name: sw.Solid(
            mesh=sw.meshes.Rectangle(size=(width, 1.0), cells=(cells, cells)),
            material=sw.NeoHookean(E=1.0, nu=0.3),
            density=1.0,
            place=sw.bodies.Placement(translation=(0.0, height)),
        )
        for name, width, cells, height in (("upper", 0.8, 4, 1.0 - depth), ("lower", 1.0, 5, 0.0))
    }
    contacts = (sw.Contact(between=between, start="fit"),)
    steps = list(sw.march(sw.Scene(bodies=blocks, contacts=contacts), until=1.0, step=0.05))
    for s in steps:
        assert s.ledger.energy_strain + s.ledger.energy_kinetic <= 1e-24
        assert abs(s.certificate.min_gap) <= 1e-14
    moved = [steps[-1].after.displacement[name][:, 1].mean() for name in blocks]
    assert moved[0] - moved[1] == pytest.approx(depth, rel=0.02)
