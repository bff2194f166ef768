"""The balances of energy and spin that close a slab: exact for any configuration, for every group of bodies."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import event, given
from hypothesis import strategies as st

from softway.bodies.assembled.vector_space import LocalSpace
from softway.bodies.internal_force.slab_average import EnergyMomentum, SlabForce, Weighted
from softway.bodies.setup.loads import Gravity, Traction
from softway.bodies.setup.placement import Placement
from softway.bodies.solid import Driven, Fixed, Solid, Tool
from softway.contact.contact import Contact, NodeToSurface
from softway.contact.contact_rows import ContactRows, on_nodes
from softway.contact.stencils import normal_component
from softway.contact.tangential_rows import TangentialRows, tangents
from softway.laws.bulk import NeoHookean
from softway.meshes.generators.shapes import box, rectangle
from softway.model.build import build
from softway.model.model import Model
from softway.model.scene import Scene
from softway.obstacles.half_space import HalfSpace
from softway.solve.equations import energy_balance
from softway.solve.equations.end_forces import EndForces
from softway.solve.equations.energy_balance import BOUND, EnergyClosure, body_groups, close_energy
from softway.solve.equations.friction_work import FrictionWork
from softway.solve.equations.spin_balance import moment

NAMES = "abcd"
MEET = NodeToSurface(nodes="both")
dims = pytest.mark.parametrize("dim", [2, 3])
forces = pytest.mark.parametrize("force", [Weighted(), EnergyMomentum()], ids=lambda f: type(f).__name__)
seeds = st.integers(0, 10**6)

WHOLE = LocalSpace(())


@cache
def row_of_blocks(dim: int, force: SlabForce, driven: bool = False) -> Model:
    """Four blocks in a row: a and b may touch, b and c, and a and d a floor; loads on all."""
    up = (0.0,) * (dim - 1) + (1.0,)
    mesh = rectangle((1.0, 1.0), (2, 2)) if dim == 2 else box((1.0, 1.0, 1.0), (2, 1, 2))
    supports = (Driven(on="left", velocity=0.3), Fixed(on="top", components="xyz"[:dim])) if driven else ()
    bodies: dict[str, Solid | Tool] = {
        name: Solid(
            mesh=mesh, material=NeoHookean(E=1.0, nu=0.3), density=1.0, force=force,
            supports=supports if name == "a" else (),
            place=Placement(translation=(1.1 * k, *[0.0] * (dim - 1))),
        )
        for k, name in enumerate(NAMES)
    }  # fmt: skip
    bodies["floor"] = Tool(shape=HalfSpace(point=(0.0,) * dim, normal=up))
    contacts = (
        Contact(between=("a.right", "b.left"), method=MEET), Contact(between=("b.right", "c.left"), method=MEET),
        Contact(between=("a.bottom", "floor")), Contact(between=("d.bottom", "floor")),
    )  # fmt: skip
    pull, push = tuple(-0.1 * np.array(up)), (0.02,) * dim
    loads = (Gravity(acceleration=pull), Traction(on="a.bottom", value=push))
    return build(Scene(bodies=bodies, contacts=contacts, loads=loads))


def random_rows(model: Model, rng: np.random.Generator) -> ContactRows:
    """Rows that turn at will; each opponent of a pair is one node of the other body, each tool moves."""
    node, contact, n = model.contacts.node, model.contacts.contact, len(model.points)
    normal = rng.normal(size=(len(node), model.shape[1]))
    pair = ~model.against_tool[contact]
    partner = np.array([sum(solids) for solids in model.contact_solids])[contact] - model.part_of[node]
    light = [np.flatnonzero((model.part_of == k) & ~model.massive) for k in range(len(model.parts))]
    other = np.array([rng.choice(light[k]) if here else 0 for k, here in zip(partner, pair, strict=True)])
    weights = on_nodes(node, n) - sp.diags_array(1.0 * pair) @ on_nodes(other, n)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return ContactRows(
        node=node, contact=contact, normal=normal,
        gradient=normal_component(sp.csr_array(weights), normal), offset=np.where(rng.random(len(node)) < 0.9, 0.0,
        np.inf), tool_motion=np.where(pair, 0.0, 0.05 * rng.normal(size=len(node))), labels=model.contacts.labels,
        shear=TangentialRows.none(len(node), n, model.shape[1]),
    )  # fmt: skip


def ends(model: Model, seed: int, size: float = 0.02, touching: tuple[int, ...] = (0, 2, 3)) -> EndForces:
    """A slab between two random configurations with random contact forces in some of the contacts."""
    rng = np.random.default_rng(seed)
    u0, u1, v0 = size * rng.normal(size=(3, *model.shape))
    rows0 = random_rows(model, rng)
    rows1 = replace(random_rows(model, rng), offset=rows0.offset)
    here = np.isin(rows0.contact, touching) & rows0.near
    push0, push1 = (0.01 * here * (rng.random(len(here)) < 0.6) * rng.random(len(here)) for _ in range(2))
    (V0, f0), (V1, f1) = model.energy_and_force(u0), model.energy_and_force(u1)
    return EndForces(
        u0=u0, u1=u1, f0=f0, f1=f1, V0=V0, V1=V1, mean=0.5 * (f0 + f1), v0=v0, rows0=rows0, rows1=rows1,
        force0=push0, force1=push1, shear0=np.zeros_like(rows0.normal), shear1=np.zeros_like(rows1.normal),
    )  # fmt: skip


def shares(model: Model, e: EndForces, found: EnergyClosure) -> tuple[np.ndarray, np.ndarray]:
    """Contact forces (m,) of the rows at the start and at the end, as they act over the slab."""
    a = found.scalar[model.part_of[e.rows0.node]]
    return (0.5 - a) * e.force0, (0.5 + a) * e.force1


def gained(model: Model, e: EndForces, found: EnergyClosure) -> np.ndarray:
    """Energy (parts,) that the slab makes from nothing: kinetic and stored, less all work from outside.

    Nodes with inertia change their kinetic energy by the work of load less internal force, whatever their motion.
    """
    du, heavy = e.u1 - e.u0, model.massive[:, None]
    old, new = shares(model, e, found)
    push = e.rows0.spread(old, model.shape) + e.rows1.spread(new, model.shape)
    kinetic = model.space.totals((model.load - found.mean) * du * heavy)
    support = model.space.totals(np.where(heavy | model.free, 0.0, found.mean - model.load - push) * du)
    tools = np.bincount(
        model.part_of[e.rows0.node],
        weights=old * e.rows0.tool_motion + new * e.rows1.tool_motion,
        minlength=len(model.parts),
    )
    return kinetic + e.V1 - e.V0 - model.space.totals(model.load * du) - support - tools


def test_bodies_in_touch_are_one_group() -> None:
    model = row_of_blocks(2, Weighted())
    contact, rows = model.contacts.contact, random_rows(model, np.random.default_rng(1))
    for touching, expected in (
        ((), [0, 1, 2, 3]), ((0,), [0, 0, 1, 2]), ((1,), [0, 1, 1, 2]), ((0, 1), [0, 0, 0, 1]), ((2, 3), [0, 1, 2, 3]),
        ((0, 1, 2, 3), [0, 0, 0, 1]),
    ):  # fmt: skip
        label = body_groups(model, (rows, np.isin(contact, touching)))
        assert [label.tolist().index(x) for x in label] == [expected.index(x) for x in expected]
    one = np.zeros(len(contact), bool)
    one[np.flatnonzero(contact == 1)[0]] = True
    assert body_groups(model, (rows, one)).tolist() == [0, 1, 1, 2], "one row is enough"


@forces
@dims
@given(seed=seeds)
def test_every_group_keeps_its_energy(dim: int, force: SlabForce, seed: int) -> None:
    model = row_of_blocks(dim, force)
    e = ends(model, seed)
    found = close_energy(model, e, fallback=True)
    label = body_groups(model, (e.rows0, e.force0 > 0.0), (e.rows1, e.force1 > 0.0))
    np.testing.assert_allclose(np.bincount(label, weights=gained(model, e, found)), 0.0, atol=1e-15)
    assert label.max() == 2
    assert all(len(set(found.scalar[label == g])) == 1 for g in range(3))


@given(seed=seeds)
def test_driven_supports_do_work_on_nodes_without_inertia(seed: int) -> None:
    model = row_of_blocks(2, Weighted(), driven=True)
    assert (~model.free & ~model.massive[:, None]).any()
    e = ends(model, seed)
    found = close_energy(model, e, fallback=True)
    label = body_groups(model, (e.rows0, e.force0 > 0.0), (e.rows1, e.force1 > 0.0))
    np.testing.assert_allclose(np.bincount(label, weights=gained(model, e, found)), 0.0, atol=1e-15)


def rubbed(model: Model, seed: int, size: float = 0.01) -> EndForces:
    """A slab with friction: at both ends the nodes without inertia are in equilibrium with all that acts on them."""
    e, rng = ends(model, seed), np.random.default_rng(seed)
    for k, (rows, push, force) in enumerate(((e.rows0, e.force0, e.f0), (e.rows1, e.force1, e.f1))):
        entries = rows.gradient.toarray().reshape(len(rows.node), -1, model.shape[1])
        weights = sp.csr_array(np.einsum("mnd,md->mn", entries, rows.normal))
        tool = model.against_tool[rows.contact][:, None]
        shear = TangentialRows(
            weights=weights, tangents=tangents(rows.normal), moved=0.05 * tool * rng.normal(size=rows.normal.shape)
        )
        drag = shear.vectors(size * rng.normal(size=shear.tangents.shape[:2])) * (push > 0.0)[:, None]
        whole = model.load + rows.spread(push, model.shape) + shear.spread(drag)
        still = np.where(model.massive[:, None], force, whole)
        e = replace(e, **{f"rows{k}": replace(rows, shear=shear), f"shear{k}": drag, f"f{k}": still})
    return replace(e, mean=0.5 * (e.f0 + e.f1))


def rubbing(model: Model, e: EndForces, found: EnergyClosure) -> tuple[np.ndarray, np.ndarray]:
    """Work of tools along their surfaces, and energy that the mean friction force dissipates (groups,)."""
    a = found.scalar[model.part_of[e.rows0.node]][:, None]
    label = body_groups(model, (e.rows0, e.force0 > 0.0), (e.rows1, e.force1 > 0.0))
    tools, lost = np.zeros((2, label.max() + 1))
    for share, rows, drag in ((0.5 - a, e.rows0, e.shear0), (0.5 + a, e.rows1, e.shear1)):
        group, shear = label[model.part_of[rows.node]], rows.shear
        moved = shear.vectors(shear.flat(shear.moved))
        tools += np.bincount(group, np.einsum("md,md->m", share * drag, moved), len(tools))
        lost -= np.bincount(group, np.einsum("md,md->m", share * drag, shear.slip(e.u1 - e.u0)), len(tools))
    return tools, lost


def lawful(e: EndForces) -> EndForces:
    """The same slab with the friction at its end along the slip, against it, as by every law of friction."""
    slip = e.rows1.shear.slip(e.u1 - e.u0)
    size = np.linalg.norm(slip, axis=1, keepdims=True)
    drag = -slip / np.where(size > 0.0, size, 1.0) * np.linalg.norm(e.shear1, axis=1, keepdims=True)
    f1 = e.f1 + e.rows1.shear.spread(drag - e.shear1)
    return replace(e, shear1=drag, f1=f1, mean=0.5 * (e.f0 + f1))


@forces
@dims
@given(seed=seeds)
def test_with_friction_every_group_keeps_its_energy(dim: int, force: SlabForce, seed: int) -> None:
    """Kinetic and stored energy change by the work of loads and tools, along their surfaces too, less the friction.

    Friction counts as zero where its mean force would create energy.
    """
    model = row_of_blocks(dim, force)
    e = rubbed(model, seed)
    found = close_energy(model, e, fallback=True)
    tools, lost = rubbing(model, e, found)
    label = body_groups(model, (e.rows0, e.force0 > 0.0), (e.rows1, e.force1 > 0.0))
    made = np.bincount(label, weights=gained(model, e, found)) - tools + np.maximum(lost, 0.0)
    np.testing.assert_allclose(made, 0.0, atol=1e-15)


@forces
@dims
@given(seed=seeds, turned=st.sampled_from([0.01, 0.1, 1.0]))
def test_groups_in_which_friction_takes_energy_are_closed_as_without_the_rule(
    dim: int, force: SlabForce, seed: int, turned: float
) -> None:
    """Bit for bit, whatever happens in the others; and no group is closed by friction that creates energy."""
    model = row_of_blocks(dim, force)
    e = lawful(rubbed(model, seed, turned))
    found = close_energy(model, e, fallback=True)
    with pytest.MonkeyPatch.context() as patch:
        none = FrictionWork(np.zeros(3), np.zeros(3))
        patch.setattr(energy_balance, "friction_work", lambda *args: none)
        plain = close_energy(model, e, fallback=True)
    label = body_groups(model, (e.rows0, e.force0 > 0.0), (e.rows1, e.force1 > 0.0))
    creates = rubbing(model, e, plain)[1] < -1e-15
    for k, part in enumerate(model.parts):
        same = np.array_equal(found.mean[part.nodes], plain.mean[part.nodes])
        assert creates[label[k]] or (same and found.scalar[k] == plain.scalar[k])
    tools, lost = rubbing(model, e, found)
    made = np.bincount(label, weights=gained(model, e, found)) - tools + np.maximum(lost, 0.0)
    np.testing.assert_allclose(made, 0.0, atol=1e-12 * max(1.0, float(np.abs(lost).max())))
    event(f"groups in which friction would create energy: {creates.sum()}")


def test_one_of_two_groups_that_rub_is_closed_without_friction() -> None:
    """In one group the friction at the start drives the slip, in another it takes energy from it."""
    model = row_of_blocks(2, Weighted())
    for seed in range(99):
        e = lawful(rubbed(model, seed, 0.1))
        found = close_energy(model, e, fallback=False)
        tools, lost = rubbing(model, e, found)
        if lost.min() < -1e-5 and lost.max() > 1e-5 and not found.bounded:
            break
    label = body_groups(model, (e.rows0, e.force0 > 0.0), (e.rows1, e.force1 > 0.0))
    made = np.bincount(label, weights=gained(model, e, found)) - tools
    np.testing.assert_allclose(made[lost < -1e-5], 0.0, atol=1e-15)
    np.testing.assert_allclose((made + lost)[lost > 1e-5], 0.0, atol=1e-15)
    assert not found.clipped


@dims
@pytest.mark.parametrize("seed", range(20))
def test_a_convex_energy_and_gaps_without_curvature_bound_the_scalar(
    dim: int, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The tool closes some rows and opens others; stored energies lie between their tangents at both ends."""
    monkeypatch.setattr(energy_balance, "BOUND", np.inf)
    model, rng = row_of_blocks(dim, Weighted()), np.random.default_rng(seed)
    e = ends(model, seed, touching=(2, 3))
    rows, du, m = e.rows0, e.u1 - e.u0, len(e.rows0.node)
    gap0, gap1 = (np.where(rng.random(m) < 0.5, 0.0, 0.1 * rng.random(m)) for _ in range(2))
    rows = replace(rows, tool_motion=np.where(rows.near, gap0 - gap1 + rows.normal_component(du), 0.0))
    tool = rows.near & model.against_tool[rows.contact]
    push0, push1 = (np.where(tool & (gap == 0.0), rng.random(m), 0.0) for gap in (gap0, gap1))
    light = ~model.massive[:, None]
    f0, f1 = (
        np.where(light, model.load + rows.spread(p, model.shape), rng.normal(size=model.shape)) for p in (push0, push1)
    )
    concave = np.maximum(-model.space.totals((f1 - f0) * du * light), 0.0)
    stiffness = (concave * (1.0 + rng.random()) + 1e-3) / model.space.totals(du**2 * ~light)
    f1 = np.where(light, f1, f0 + model.nodal(stiffness) * du)
    low, high = (model.space.totals(f * du) for f in (f0, f1))
    stored = e.V0 + low + rng.random(len(low)) * (high - low)
    e = replace(e, rows0=rows, rows1=rows, force0=push0, force1=push1, f0=f0, f1=f1, mean=0.5 * (f0 + f1), V1=stored)
    found = close_energy(model, e, fallback=False)
    assert (np.abs(found.scalar) <= 0.5 + 1e-12).all()
    assert np.abs(found.scalar).max() > 0.05


@dims
@given(seed=seeds)
def test_internal_forces_and_pairs_have_no_moment(dim: int, seed: int) -> None:
    """The moment on the nodes with inertia is that of the loads and tools on all nodes of the group."""
    model = row_of_blocks(dim, EnergyMomentum())
    e = ends(model, seed)
    found = close_energy(model, e, fallback=False)
    label = body_groups(model, (e.rows0, e.force0 > 0.0), (e.rows1, e.force1 > 0.0))
    tool = model.against_tool[e.rows0.contact]
    old, new = (tool * share for share in shares(model, e, found))
    outer = model.load + e.rows0.spread(old, model.shape) + e.rows1.spread(new, model.shape)
    total = np.where(model.massive[:, None], found.mean, outer)
    x = model.points + 0.5 * (e.u0 + e.u1)
    for g in range(3):
        here = label[model.part_of] == g
        assert moment(WHOLE, (x - x[here].mean(axis=0))[here], total[here]) == pytest.approx(0.0, abs=1e-15)


@forces
@dims
@given(seed=seeds)
def test_the_completion_has_no_resultant_and_leaves_nodes_without_inertia_in_equilibrium(
    dim: int, force: SlabForce, seed: int
) -> None:
    model = row_of_blocks(dim, force)
    e = ends(model, seed)
    for fallback in (True, False):
        found = close_energy(model, e, fallback)
        more = found.mean - e.mean - model.nodal(found.scalar) * (e.f1 - e.f0)
        np.testing.assert_allclose([more[p.nodes].sum(axis=0) for p in model.parts], 0.0, atol=1e-15)
        np.testing.assert_allclose(more[~model.massive], 0.0, atol=1e-17)
        assert np.abs(found.scalar).max() <= BOUND


def test_a_scalar_beyond_its_bound_is_told_unless_the_motion_may_close_the_balance() -> None:
    """Stored energy out of nothing in one body, the other balanced."""
    model = row_of_blocks(2, Weighted())
    e = ends(model, 0, touching=())
    odd = replace(e, V1=e.V1 + [0.1, 0.0, 0.0, 0.0])
    cut, along = close_energy(model, odd, fallback=False), close_energy(model, odd, fallback=True)
    assert cut.clipped and cut.bounded
    assert along.bounded and not along.clipped
    assert not close_energy(model, e, fallback=False).clipped
    assert 0.0 < np.abs(cut.scalar[0]) <= BOUND and cut.scalar[0] == along.scalar[0]
    assert abs(gained(model, odd, cut)[0]) > 0.01
    np.testing.assert_allclose(gained(model, odd, along), 0.0, atol=1e-15)
    np.testing.assert_array_equal(cut.mean[model.parts[1].nodes], along.mean[model.parts[1].nodes])


def test_a_body_that_is_not_deformed_needs_no_scalar() -> None:
    model = row_of_blocks(2, EnergyMomentum())
    e = ends(model, 0, size=0.0, touching=())
    moved = np.tile([0.3, -0.2], (len(model.points), 1))
    light = replace(model, load=np.zeros(model.shape), load_before=np.zeros(model.shape))
    found = close_energy(light, replace(e, u1=moved), fallback=False)
    assert found.scalar.tolist() == [0.0] * 4
    np.testing.assert_allclose(found.mean, 0.0, atol=1e-17)


@given(seed=seeds)
def test_closing_along_the_motion_gives_bodies_with_supports_no_resultant(seed: int) -> None:
    """A supported body would else get a push that neither contact nor a support gives."""
    model = row_of_blocks(2, Weighted(), driven=True)
    e = ends(model, seed)
    found = close_energy(model, replace(e, V1=e.V1 + [0.3, 0.0, 0.0, 0.0]), fallback=True)
    more = found.mean - e.mean - model.nodal(found.scalar) * (e.f1 - e.f0)
    assert np.abs(more).max() > 0.01
    left = [more[p.nodes].sum(axis=0) for p in model.parts]
    np.testing.assert_allclose(left, 0.0, atol=1e-13 * float(np.abs(more).max()))


def test_moments() -> None:
    rng = np.random.default_rng(0)
    x, f = rng.normal(size=(2, 7, 3))
    expected = sum(np.cross(a, b) for a, b in zip(x, f, strict=True))
    np.testing.assert_allclose(moment(WHOLE, x, f), expected, atol=1e-14)
    flat = [1.0, 1.0, 0.0]
    np.testing.assert_allclose(moment(WHOLE, x[:, :2], f[:, :2]), moment(WHOLE, x * flat, f * flat)[2:], atol=1e-14)
    assert moment(WHOLE, x[:, :1], f[:, :1]).shape == (0,)
