"""Drops that once stopped, found no end or broke off, and what they were about."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp

import softway as sw
from inputs.drops import Drop
from run_drops import fall, fall_together, judged
from softway.bodies.inertia.mass_matrix import Consistent
from softway.bodies.inertia.mass_redistribution import redistribute_mass
from softway.contact.contact_rows import ContactRows
from softway.contact.tangential_rows import TangentialRows
from softway.marching.audit.certificate import violation
from softway.marching.march import march
from softway.meshes.generators.shapes import box
from softway.model.build import build
from softway.scenario.hints.units_text import Units

RIM = Path(__file__).parent / "inputs" / "marched" / "rim.toml"
"""A cylinder that lands on the middle of its rim."""
CORNER = Path(__file__).parent / "inputs" / "marched" / "corner.toml"
"""A plate that lands on a corner, which slips away from the plate above it."""


def boxes() -> sw.Scene:
    """A block flush on another one, pressed on it by its speed."""
    soft = sw.NeoHookean(E=1.0, nu=0.3)
    below = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(2, 2, 2)),
        material=soft,
        density=1.0,
        supports=(sw.Fixed(on="bottom"),),
    )
    above = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(3, 3, 2), origin=(0.0, 0.0, 1.0)),
        material=soft,
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0, 0.0, -0.05)),
    )
    return sw.Scene(bodies={"below": below, "above": above}, contacts=(sw.Contact(between=("above", "below")),))


def test_corners_of_flush_blocks_do_not_touch_the_walls_beside_them():
    scene = boxes()
    made = {n: replace(b, mesh=b.mesh.build()) for n, b in scene.bodies.items()}
    model = build(replace(scene, bodies=made))
    rows = model.rows(model.displacement)
    touching = rows.near & (rows.gap(model.displacement) < 1e-9)
    np.testing.assert_allclose(np.abs(rows.normal[touching][:, 2]), 1.0, atol=1e-12)


def test_flush_blocks_press_each_other_without_halving():
    steps = list(march(boxes(), until=1.0, step=0.1))
    assert len(steps) == 10
    assert max(s.ledger.contacts["above-below"].force_n for s in steps) > 0.01
    assert abs(steps[-1].ledger.energy_error) < 1e-10 * steps[0].ledger.energy_kinetic


@pytest.mark.slow
def test_a_cylinder_lands_on_the_middle_node_of_its_rim():
    told = judged(Drop(number=0, text=RIM.read_text(), traits={}), Units.standard())
    assert told["end"] == "done", told["why"]
    assert told["rejections"] == 0
    assert told["energy"] < 1e-11


@pytest.mark.slow
def test_a_corner_of_massless_nodes_slips_from_one_equilibrium_to_another():
    """Between them its equilibrium is unstable: however short, slabs have no solution nearby."""
    told = judged(Drop(number=0, text=CORNER.read_text(), traits={}), Units.standard())
    assert told["end"] == "done", told["why"]
    assert told["slabs"] < 100
    assert told["energy"] < 1e-11


def test_a_bar_in_free_fall_asks_newton_for_a_few_iterations():
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=8),
        material=sw.NeoHookean(E=1e6),
        density=1.0,
        mass=sw.bodies.Lumped(),
        velocity=sw.bodies.Uniform(value=-1.0),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=-1.0, normal=1.0))
    scene = sw.Scene(
        bodies={"bar": bar, "floor": floor},
        contacts=(sw.Contact(between=("bar", "floor")),),
        loads=(sw.Gravity(acceleration=(-10.0,)),),
    )
    steps = list(march(scene, until=5e-3, step=2.5e-4, method=sw.Newton()))
    assert len(steps) == 20
    assert max(s.report.iterations for s in steps) <= 5
    assert steps[-1].ledger.energy_strain < 1e-20


def test_quadratic_tetrahedra_may_touch_with_all_their_surface():
    mesh = box((1.0, 1.0, 1.0), (2, 2, 2), cell="tet10")
    mass = redistribute_mass(
        mesh,
        3.0,
        sw.bodies.Volume(),
        Consistent(),
        np.unique(np.concatenate(list(mesh.boundary().values()), axis=None)),
    )
    assert np.isfinite(mass.data).all()
    assert mass.sum() == pytest.approx(3.0, rel=1e-9)


def test_rows_whose_slaves_slide_on_each_other_move_together():
    """Node 1 touches the segment of nodes 0 and 2, node 0 that of nodes 1 and 3: the least motion of all four."""
    gradient = np.zeros((2, 8))
    gradient[0, [3, 1, 5]] = 1.0, -0.5, -0.5
    gradient[1, [1, 3, 7]] = -1.0, 0.25, 0.75
    rows = ContactRows(
        node=np.array([1, 0]),
        contact=np.zeros(2, int),
        normal=np.array([[0.0, 1.0], [0.0, -1.0]]),
        gradient=sp.csr_array(gradient),
        offset=np.zeros(2),
        tool_motion=np.zeros(2),
        labels=("c",),
        shear=TangentialRows.none(2, 4, 2),
    )
    field = rows.motion(np.array([0.3, -0.2]), np.ones(2, bool), np.ones((4, 2), bool))
    np.testing.assert_allclose(rows.normal_component(field), [0.3, -0.2], atol=1e-14)
    np.testing.assert_allclose(field.ravel(), np.linalg.pinv(gradient) @ [0.3, -0.2], atol=1e-14)


def test_nan_violates_the_certificate():
    good = next(march(boxes(), until=0.1, step=0.1)).certificate
    for name in ("min_gap", "min_force", "power_residual", "momentum_error", "energy_error"):
        bad = replace(good, **{name: float("nan")})
        told = violation(None, None, None, None, None, bad)  # type: ignore[arg-type]
        assert told == "a gap, a force or a balance is not a number"


@pytest.mark.parametrize("rule", [sw.contact.Paper(), sw.contact.Impulse()], ids=lambda rule: type(rule).__name__)
def test_a_block_slides_off_the_edge_of_a_table(rule):
    """Its nodes touch faces that are out of their reach in the next slab: they let go."""
    stiff = sw.LinearElastic(E=1e5, nu=0.3)
    table = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 0.4), cells=(3, 1)),
        material=stiff,
        density=1000.0,
        supports=(sw.Fixed(on="bottom"),),
    )
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(0.2, 0.2), cells=(1, 1), origin=(0.7, 0.4)),
        material=stiff,
        density=1000.0,
        velocity=sw.bodies.Uniform(value=(8.0, -1.0)),
    )
    scene = sw.Scene(
        bodies={"block": block, "table": table},
        contacts=(sw.Contact(between=("block.bottom", "table.top"), timing=rule, name="fall"),),
        loads=(sw.Gravity(acceleration=(0.0, -100.0)),),
    )
    steps = list(march(scene, until=0.08, step=2e-3))
    assert any(step.after.closed["fall"].any() for step in steps)
    assert not steps[-1].after.closed["fall"].any()
    assert steps[-1].after.displacement["block"][:2, 1].max() < -0.25


@pytest.mark.slow
@pytest.mark.few(1)
@pytest.mark.parametrize("number", [58, 425], ids=["J2", "NeoHookean"])
def test_crushed_blocks_that_rub_go_on_with_a_definite_operator(number):
    """At 0.14 and 0.26 of the wave speed their massless nodes lose their stability; they used to stop there."""
    told = fall(number)
    assert told["end"] == "done", told["why"]
    assert told["rejections"] > 0
    assert told["energy"] < 1e-8 and told["depth"] < 1e-9 and told["given_back"] < 1e-12


@pytest.mark.slow
def test_nodes_inside_a_coarse_facet_do_not_end_a_march():
    """The corner of a ring that folds on two facets: mean gaps are zero, a node is a third of its edge inside."""
    told = fall(215)
    assert told["end"] == "done", told["why"]
    assert "overlap" in told["findings"]


@pytest.mark.minutes
def test_corners_without_an_inertia_of_their_own_give_no_energy():
    """A ring of tri6 under the literal rule; its corners, stopped alone, created 8e-4 of the energy."""
    told = fall(9)
    assert told["end"] == "done" and told["given_back"] < 1e-12
    assert "dissipation" not in told["findings"]


@pytest.mark.slow
@pytest.mark.few(1)
@pytest.mark.parametrize("number", [1, 9])
def test_assemblies_of_thin_rings_end(number):
    """Rings that may touch themselves; rows through their own walls once stopped them or took hundreds of slabs."""
    told = fall_together(number)
    assert told["end"] == "done", told["why"]
    assert told["rejections"] == 0
    assert told["energy"] < 1e-11 and told["depth"] < 1e-9 and told["given_back"] < 1e-12
