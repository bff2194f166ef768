"""Bodies that meet themselves, and many bodies in one contact."""

import numpy as np
import pytest

import softway as sw
from softway.arrays import Array
from softway.bodies.setup.initial_fields import Uniform
from softway.bodies.setup.placement import Placement
from softway.contact.contact import Contact, NodeToSurface
from softway.laws.friction.coulomb import Coulomb
from softway.marching.march import march
from softway.meshes.generators.shapes import disc, rectangle
from softway.model.build import build


def crossings(x: Array, segments: Array) -> int:
    """Number of pairs of segments (s, 2) without a common node that cross properly, at positions x (n, 2)."""

    def side(a: Array, b: Array, c: Array) -> Array:
        one, two = b - a, c - a
        return one[..., 0] * two[..., 1] - one[..., 1] * two[..., 0]

    i, j = np.triu_indices(len(segments), 1)
    apart = (segments[i][:, :, None] != segments[j][:, None, :]).all(axis=(1, 2))
    a, b, c, d = (x[segments[k][apart, end]] for k in (i, j) for end in (0, 1))
    least = 1e-12 * np.ptp(x)
    one, two = (side(a, b, c), side(a, b, d)), (side(c, d, a), side(c, d, b))
    lengths = np.linalg.norm(b - a, axis=1), np.linalg.norm(d - c, axis=1)
    proper = [
        (np.minimum(*s) < -least * n) & (np.maximum(*s) > least * n) for s, n in zip((one, two), lengths, strict=True)
    ]
    return int((proper[0] & proper[1]).sum())


def ring() -> sw.Solid:
    """Open ring of rubber, two cells thick, whose ends fly towards each other."""
    straight = rectangle((2.0, 0.06), (30, 2), origin=(-1.0, 0.27))
    angle, radius = 2.6 * straight.points[:, 0], straight.points[:, 1]
    x = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    towards = np.column_stack([np.zeros(len(x)), -3.0 * np.sin(0.5 * angle) ** 3])
    mesh = sw.Mesh(points=x, blocks={k: c[:, ::-1] for k, c in straight.blocks.items()}, tags=straight.tags)
    return sw.Solid(mesh=mesh, material=sw.NeoHookean(E=1e6, nu=0.4), density=1000.0, velocity=towards)


def closed(contacts: tuple[Contact, ...]) -> tuple[list, list[int]]:
    """March of the ring, and the crossings of its boundary after each slab."""
    solid = ring()
    steps = list(march(sw.Scene(bodies={"s": solid}, contacts=contacts), until=0.12, step=5e-4))
    segments = np.concatenate([f[:, :2] for f in solid.mesh.boundary().values()])
    return steps, [crossings(solid.mesh.points + s.after.displacement["s"], segments) for s in steps[::4]]


@pytest.mark.slow
def test_the_ends_of_a_ring_meet_and_part_without_crossing() -> None:
    assert max(closed(())[1]) >= 2, "without contact they move through each other"
    steps, cross = closed((Contact(between=("s", "s")),))
    assert max(cross) == 0
    touching = [bool(s.after.closed["s-s"].any()) for s in steps]
    assert any(touching)
    assert not touching[-1]
    start = steps[0].ledger.energy_kinetic
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-11 * start
    assert min(c.min_gap for s in steps for c in s.ledger.contacts.values()) > -1e-12
    momentum = np.array([s.ledger.momentum for s in steps])
    np.testing.assert_allclose(momentum - momentum[0], 0.0, atol=1e-10)


def overlap(x: Array, nodes: Array, facets: Array) -> float:
    """Greatest depth of nodes (k,) behind the segments (s, 2) that they are next to, at positions x (n, 2)."""
    a, b = x[facets[:, 0]], x[facets[:, 1]]
    along = (b - a) / np.linalg.norm(b - a, axis=1)[:, None]
    outward = np.column_stack([along[:, 1], -along[:, 0]])
    offset = x[nodes][:, None] - a
    depth, place = -np.sum(offset * outward, axis=2), np.sum(offset * along, axis=2)
    beside = (place > 0.0) & (place < np.linalg.norm(b - a, axis=1)) & (depth < 0.02)
    return float(np.where(beside, depth, 0.0).max())


@pytest.mark.slow
def test_two_surfaces_of_a_body_meet_by_mortar() -> None:
    """The flat ends of the ring, under contact of the whole ring with itself: means are closed, nodes nearly."""
    ends = Contact(between=("s.left", "s.right"), method=sw.contact.DualMortar())
    steps, _ = closed((Contact(between=("s", "s")), ends))
    mesh = ring().mesh
    segments = np.concatenate([f[:, :2] for f in mesh.boundary().values()])
    sides = [(mesh.nodes(tag), segments[np.isin(segments, mesh.nodes(tag)).all(axis=1)]) for tag in ("left", "right")]
    places = [mesh.points + s.after.displacement["s"] for s in steps]
    deepest = max(overlap(x, sides[k][0], sides[1 - k][1]) for x in places for k in (0, 1))
    assert deepest < 0.01 * 0.03
    touching = [bool(s.after.closed["s.left-s.right"].any()) for s in steps]
    assert any(touching)
    assert not touching[-1]
    start = steps[0].ledger.energy_kinetic
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-11 * start
    assert not any(s.report.rejections for s in steps)
    momentum = np.array([s.ledger.momentum for s in steps])
    np.testing.assert_allclose(momentum - momentum[0], 0.0, atol=1e-10)


def test_mortar_needs_two_surfaces_that_are_apart() -> None:
    for between in (("s.left", "s.top"), ("s", "s")):
        contact = Contact(between=between, method=sw.contact.DualMortar())
        with pytest.raises(sw.InputError, match=r"contacts\[0\].method"):
            build(sw.Scene(bodies={"s": ring()}, contacts=(contact,)))


def crushed(contacts: tuple[Contact, ...]) -> tuple[list, int]:
    """March of a rubber strip, 2 x 50 cells, that is crushed to a third, and the greatest number of its crossings."""
    plain = rectangle((0.04, 1.0), (2, 50), origin=(-0.02, 0.0))
    x = np.array(plain.points)
    x[:, 0] += 0.01 * np.sin(np.pi * x[:, 1]) + 0.004 * np.sin(3.0 * np.pi * x[:, 1])
    mesh = sw.Mesh(points=x, blocks=plain.blocks, tags=plain.tags)
    held = (
        sw.Fixed(on="bottom"),
        sw.Driven(on="top", components="y", velocity=-5.0),
        sw.Fixed(on="top", components="x"),
    )
    solid = sw.Solid(mesh=mesh, material=sw.NeoHookean(E=1e6, nu=0.4), density=1000.0, supports=held)
    steps = list(sw.march(sw.Scene(bodies={"s": solid}, contacts=contacts), until=0.1334, step=2.3e-4))
    segments = np.concatenate([f[:, :2] for f in mesh.boundary().values()])
    return steps, max(crossings(x + s.after.displacement["s"], segments) for s in steps[::8])


@pytest.mark.minutes
def test_the_folds_of_a_crushed_strip_touch_and_do_not_cross() -> None:
    """Self-contact takes at most 1.3 times the iterations of a slab without, in which the folds cross."""
    (plain, through), (steps, cross) = crushed(()), crushed((Contact(between=("s", "s"), name="self"),))
    assert through > 0 and cross == 0
    assert sum(s.ledger.contacts["self"].count > 0 for s in steps) > 10
    energy = max(s.ledger.energy_kinetic + s.ledger.energy_strain for s in steps)
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-11 * energy
    assert not any(s.report.rejections for s in steps)
    mine, others = (np.mean([s.report.iterations for s in run]) for run in (steps, plain))
    assert mine < 1.3 * others


def discs(contacts: tuple[Contact, ...]) -> list:
    """Three rubber discs: one flies into two that touch neither each other nor the first."""
    places, speeds = ((-0.25, 0.02), (0.0, 0.115), (0.0, -0.115)), ((3.0, 0.0), (0.0, 0.0), (0.0, 0.0))
    bodies = {
        name: sw.Solid(
            mesh=disc(0.1, 4),
            material=sw.NeoHookean(E=1e6, nu=0.3),
            density=1000.0,
            place=Placement(translation=place),
            velocity=Uniform(value=speed),
        )
        for name, place, speed in zip("abc", places, speeds, strict=True)
    }
    return list(march(sw.Scene(bodies=bodies, contacts=contacts), until=0.06, step=5e-4))


@pytest.mark.slow
def test_a_list_of_bodies_moves_as_its_pairs() -> None:
    both = NodeToSurface(nodes="both")
    pairs = tuple(Contact(between=p, method=both) for p in (("a", "b"), ("a", "c"), ("b", "c")))
    one, two = discs((Contact(between="all"),)), discs(pairs)
    assert max(s.ledger.contacts["all"].force_n for s in one) > 0.0
    for name in "abc":
        v, w = (run[-1].after.velocity[name].mean(axis=0) for run in (one, two))
        assert v == pytest.approx(w, abs=1e-6)
    start = one[0].ledger
    assert max(abs(s.ledger.energy_error) for s in one) < 1e-12 * start.energy_kinetic
    momenta = np.array([s.ledger.momentum for s in one])
    np.testing.assert_allclose(momenta - momenta[0], 0.0, atol=1e-12 * np.abs(momenta[0]).max())


def test_friction_of_two_sided_rows_is_that_of_the_surface() -> None:
    """A block that is pressed and slides: friction takes mu times the impulse of the normal forces."""
    soft, mu = sw.NeoHookean(E=1e7, nu=0.3), 0.2
    sliding = Uniform(value=(2.0, 0.0))
    top = sw.Solid(mesh=rectangle((1.0, 0.5), (5, 3)), material=soft, density=1000.0, velocity=sliding)
    below = rectangle((3.0, 0.4), (12, 3), origin=(-1.0, -0.4))
    base = sw.Solid(mesh=below, material=soft, density=1000.0, supports=(sw.Fixed(on="bottom"),))
    push = sw.Traction(on="top.top", value=(0.0, -1e4))
    contact = Contact(between=("top.bottom", "base.top", "base.left"), name="c", friction=Coulomb(mu=mu))
    scene = sw.Scene(bodies={"top": top, "base": base}, contacts=(contact,), loads=(push,))
    steps = list(march(scene, until=0.1, step=2e-3))
    normal = sum(s.ledger.contacts["c"].force_n * s.slab.span for s in steps)
    model = build(scene)
    mass = model.mass @ np.ones(model.shape[0])
    before, after = (
        (mass[model.parts[0].nodes] * v[:, 0]).sum()
        for v in (steps[0].before.velocity["top"], steps[-1].after.velocity["top"])
    )
    assert before - after == pytest.approx(mu * normal, rel=1e-3)


@pytest.mark.slow
def test_events_tell_who_touches() -> None:
    found = {e.bodies for s in discs((Contact(between="all"),)) for e in s.events if e.kind == "touch"}
    assert found <= {("a", "b"), ("b", "a"), ("a", "c"), ("c", "a")}
    assert {frozenset(pair) for pair in found} == {frozenset("ab"), frozenset("ac")}
