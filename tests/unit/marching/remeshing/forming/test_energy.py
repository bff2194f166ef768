"""Energy of bodies in motion through new meshes: it passes to rounding, and only where cells get better."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.apps.verify.scenes import taylor
from softway.errors import NumericsError
from softway.laws.law import Material
from softway.marching.remeshing.forming.carried import carried_on
from softway.marching.remeshing.forming.formed_scene import _uncleared, formed_scene
from softway.marching.remeshing.forming.forming_march import _rescue
from softway.marching.remeshing.forming.replacement import replacement
from softway.marching.state.march_state import RemeshedMeshes
from softway.meshes.remeshed.remesh import Remesh

ENERGY = 0.5 * taylor.DENSITY * np.pi * taylor.RADIUS**2 * taylor.LENGTH * 227.0**2
STEP = 0.78e-6
FAST = sw.laws.Maxwell(E=30e9, nu=0.35, shares=(0.3, 0.2), times=(0.2 * STEP, 2.0 * STEP))
HOW = Remesh(by="new cells", quality=0.75, shortened=0.0)


def thrown(material: Material | None, how: Remesh | None) -> sw.Scene:
    """The bar of case D09 in 5 x 25 cells, or of another material."""
    scene = taylor.scene((5, 25))
    bar = scene.bodies["bar"]
    assert isinstance(bar, sw.Solid)
    mesh = sw.meshes.Rectangle(size=(taylor.RADIUS, taylor.LENGTH), cells=(5, 25), cell="tri3")
    new = replace(bar, mesh=mesh, dilatation="corner", remesh=how, material=material or bar.material)
    return replace(scene, bodies={**scene.bodies, "bar": new})


def test_new_meshes_take_no_energy() -> None:
    steps = list(sw.march(thrown(None, HOW), until=10 * STEP, step=STEP, method=taylor.METHOD))
    assert sum(bool(one.exchanges) for one in steps) >= 1
    assert abs(steps[-1].ledger.remeshing) < 1e-12 * ENERGY
    assert max(abs(one.ledger.energy_error) for one in steps) < 1e-8 * ENERGY


@pytest.mark.slow
def test_the_energy_of_waves_that_a_projection_loses_comes_back() -> None:
    """A disc hits the floor at an angle; half of the energy of its motion beside the rigid one is in waves that the
    projection on its first new mesh loses: 14 J, 9 % of all, were booked.
    """
    law = sw.J2(E=4.56154e8, nu=0.3, yield_stress=3.19491e6)
    mesh = sw.meshes.Disc(radius=0.0022366, cells=6, cell="tri6")
    place = sw.bodies.Placement(rotations=(sw.bodies.Rotation(angle=140.324),), bottom=3.49384e-6)
    velocity = sw.bodies.Uniform(value=(-19.6536, -46.2658))
    disc = sw.Solid(mesh=mesh, material=law, density=8337.63, velocity=velocity, place=place, remesh="auto")
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    contact = sw.Contact(between=("disc", "floor"), friction=sw.laws.Coulomb(mu=0.53))
    scene = sw.Scene(bodies={"disc": disc, "floor": floor}, contacts=(contact,))
    steps = sw.march(scene, until=8.72592e-5, step=2.0776e-6)
    changed = next(step for step in steps if step.exchanges)
    assert abs(changed.ledger.remeshing) < 1e-12 * changed.ledger.energy_kinetic


def test_stress_does_not_relax_in_a_change_of_meshes() -> None:
    """Massless nodes find their equilibrium at once: what the material dissipates is far below what a slab does."""
    steps = list(sw.march(thrown(FAST, None), until=8 * STEP, step=STEP, method=taylor.METHOD))
    now = steps[-1].march_state
    old = formed_scene(sw.build(thrown(FAST, HOW)))
    now = replace(now, remeshed=RemeshedMeshes(meshes=old.meshes))
    mesh = replacement(old, HOW, now, "bar")
    assert mesh is not None
    reached, _ = carried_on(old, old.on({"bar": mesh}, now), now, {"bar": "a test"})
    slab = steps[-1].ledger.dissipation - steps[-2].ledger.dissipation
    lost = reached.account.dissipation - now.account.dissipation
    assert slab > 1e-4 * ENERGY
    assert abs(lost) < 1e-3 * slab
    assert reached.account.remeshing == pytest.approx(now.account.remeshing, abs=1e-12 * ENERGY)


def test_good_cells_are_not_replaced_because_slabs_are_short() -> None:
    """A slab that crawls asks for a new mesh only where cells are a fifth worse than new ones."""
    how = Remesh(quality=0.0, angle=0.0, ratio=1e9)
    scene = thrown(None, how)
    steps = list(sw.march(scene, until=6 * STEP, step=STEP, method=taylor.METHOD))
    for one, asks in ((steps[0], False), (steps[-1], True)):
        now = one.march_state
        on = formed_scene(one.model)
        history = replace(now.step_history, rejected=3)
        crawling = replace(now, step_history=history, state=replace(now.state, span=0.01 * history.span))
        assert bool(on.asks(crawling)) is asks
        assert not on.asks(now)


def test_a_body_whose_surface_crosses_itself() -> None:
    """The error names the solid, and a contact that keeps its sides apart."""
    *_, step = sw.march(thrown(None, HOW), until=STEP, step=STEP, method=taylor.METHOD)
    on, now = formed_scene(step.model), step.march_state
    mesh, u = on.part("bar").mesh, np.array(now.state.start.displacement)
    assert on.crossing(now, "bar") is None
    corner = int((mesh.points[:, 0] + mesh.points[:, 1]).argmax())
    u[on.part("bar").nodes.start + corner] -= [4.0 * taylor.RADIUS, 3.0 * taylor.RADIUS]
    start = replace(now.state.start, displacement=u)
    assert now.remeshed is not None
    rescued = replace(now.remeshed, rescued=now.state.time)
    folded = replace(now, state=replace(now.state, start=start), remeshed=rescued)
    with pytest.raises(NumericsError, match="the surface of 'bar' crosses itself") as caught:
        _rescue(on, folded, False, NumericsError("no time step was accepted", 1.0))
    assert '["bar", "bar"]' in caught.value.remedy
    assert _rescue(on, replace(now, remeshed=rescued), False, NumericsError("no time step was accepted", 1.0)) is None


def test_gaps_of_other_shapes_are_no_offsets() -> None:
    """Curved facets that overlap at the start have gaps with an offset; those of a new mesh have none."""
    scene = thrown(None, HOW)
    on = formed_scene(sw.build(scene))
    *_, step = sw.march(thrown(None, None), until=STEP, step=STEP, method=taylor.METHOD)
    now = replace(step.march_state, remeshed=RemeshedMeshes(meshes=on.meshes))
    rows = len(on.model.contacts.contact)
    offset = replace(on.model, contacts=replace(on.model.contacts, clearance=np.full(rows, -1.0)))
    assert _uncleared(offset, on.meshes).contacts.clearance == pytest.approx(np.full(rows, -1.0))
    mesh = replacement(on, HOW, now, "bar")
    assert mesh is not None
    assert _uncleared(offset, on.on({"bar": mesh}, now).meshes).contacts.clearance is None
