"""Thermal expansion on new meshes: free growth, clamped stress, both laws of thermodynamics, bodies in motion."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from forging import KEPT, changes, continues, force
from warm_billets import HOW, WARM, billet, keeps_its_heat, temperatures, upset

import softway as sw
from softway.adaptivity.new_cells.sizes import edge_lengths
from softway.apps.verify.scenes import taylor
from softway.arrays import Array
from softway.bodies.setup.supports import Support
from softway.marching.remeshing.carried_heat import temperature_of
from softway.marching.remeshing.forming.carried import carried_on
from softway.marching.remeshing.forming.formed_scene import Replacement, formed_scene
from softway.marching.state.march_state import MarchState
from softway.meshes.mesh import Mesh

ALPHA, E, NU = 1e-6, 1e5, 0.3
HELD = 3.0 * ALPHA * E / (3.0 * (1.0 - 2.0 * NU))
"""Stress of a clamped body by kelvin."""
LAW = sw.heat.Conduction(conductivity=1.0, capacity=1.0)
GROWS = replace(WARM, expansion=1e-5)


def heated(
    supports: tuple[Support, ...], temperature: float | Callable[[Array], Array], power: float, law: sw.heat.Conduction
) -> sw.Scene:
    """A body of revolution with a source of heat, of J2 that yields at a high stress."""
    body = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(4, 4), cell="tri3"),
        material=sw.J2(E=E, nu=NU, yield_stress=1e6),
        density=1.0,
        section=sw.bodies.Axisymmetric(),
        dilatation="corner",
        supports=(sw.Fixed(on="bottom", components="y"), sw.Fixed(on="left", components="x"), *supports),
        thermal=sw.bodies.Thermal(law=law, temperature=temperature, expansion=ALPHA),
        remesh=KEPT,
    )
    source = sw.heat.HeatSource(of="body", value=power)
    return sw.Scene(bodies={"body": body}, inertia=sw.bodies.Off(), loads=(source,))


def other(step: sw.Step, cells: tuple[int, int]) -> MarchState:
    """State of a march on another mesh of the present shape of a rectangle."""
    on, now = formed_scene(step.model), step.march_state
    x = on.places(now, "body")
    mesh = sw.meshes.Rectangle(size=(1.0, 1.0), cells=cells, cell="tri3").build()
    mesh = Mesh(points=mesh.points * x.max(axis=0), blocks=mesh.blocks, tags=mesh.tags)
    new = on.on({"body": Replacement(mesh=mesh, sizes=edge_lengths(mesh))}, now)
    reached, _ = carried_on(on, new, now, {"body": "a test"})
    return reached


def whole(one: sw.Ledger) -> float:
    """Kinetic and strain energy, heat, and what has left the solids, less the error of the slabs [J]."""
    assert one.heat is not None
    cold = one.dissipation - one.heat.received
    inside = one.energy_kinetic + one.energy_strain + one.heat.content + cold + one.remeshing
    return inside - one.heat.brought - one.work_external - one.energy_error


def stress(step: sw.Step) -> Array:
    """Stress (p, 3, 3) of the law and of the free strain at the points [Pa]."""
    start, found = step.march_state.state.start, temperature_of(step.model)
    assert found is not None and start.states[0] is not None
    k, temperature = found
    values = temperature.values_of(start.fields[k])
    free = temperature.moduli.free.of(values.temperature, values.share)
    (expansion,) = temperature.expansions
    pressure = expansion.pressures(free, start.displacement)[0]
    return np.asarray(start.states[0].stress - pressure[:, None, None] * np.eye(3))


def test_free_growth_through_two_meshes() -> None:
    """Each length is exp(alpha (T - T0)) of that at the start, without stress, on all meshes, to the second order of
    the strain: the stress of the law is per present area, that of the free strain per area of the reference.
    """
    scene = heated((), 300.0, 30.0, LAW)
    given = {"until": 3.0, "step": 0.25}
    first = list(sw.march(scene, **given))[3]
    second = list(sw.march(scene, state=other(first, (5, 3)), **given))[3]
    assert second.model.parts[0].mesh.n_cells == 30
    *_, last = sw.march(scene, state=other(second, (3, 6)), **given)
    for step in (first, second, last):
        kelvin = temperatures(step)
        assert np.ptp(kelvin) < 1e-7
        size = (step.model.points + step.after.displacement["body"]).max(axis=0)
        assert np.log(size) == pytest.approx(ALPHA * (kelvin[0] - 300.0), rel=3e-4)
        assert np.abs(stress(step)).max() < 1e-7 * HELD
    assert temperatures(last)[0] > 350.0
    assert whole(last.ledger) == pytest.approx(whole(first.ledger), rel=1e-12)
    assert abs(last.ledger.remeshing) < 1e-12


def test_clamped_stress_through_a_mesh() -> None:
    """The stress is -3 kappa alpha (T - T0) before and after, and the heat of the source has warmed the body."""
    sides = (sw.Fixed(on="top", components="y"), sw.Fixed(on="right", components="x"))
    scene = heated(sides, 300.0, 20.0, LAW)
    given = {"until": 2.0, "step": 0.25}
    first = list(sw.march(scene, **given))[3]
    *_, last = sw.march(scene, state=other(first, (3, 5)), **given)
    for step, kelvin in ((first, 320.0), (last, 340.0)):
        assert temperatures(step) == pytest.approx(kelvin, rel=1e-12)
        assert stress(step) == pytest.approx(np.broadcast_to(-HELD * (kelvin - 300.0) * np.eye(3), stress(step).shape))
    assert whole(last.ledger) == pytest.approx(whole(first.ledger), rel=1e-13)


def test_one_mesh_of_a_body_that_is_warm_on_one_side() -> None:
    """Stress passes as a whole: its integral stays although the temperatures of the points change; so do content and
    energy, and the entropy does not fall.
    """
    sides = (sw.Fixed(on="top", components="y"),)
    scene = heated(sides, lambda x: 300.0 + 40.0 * x[:, 0] ** 2, 0.0, LAW)
    body = scene.bodies["body"]
    assert isinstance(body, sw.Solid) and body.thermal is not None
    thermal = replace(body.thermal, reference=280.0)
    scene = replace(scene, bodies={"body": replace(body, thermal=thermal)})
    given = {"until": 0.06, "step": 0.01}
    step = list(sw.march(scene, **given))[3]
    now, found = step.march_state, other(step, (6, 3))
    sums = []
    for model, state, wide in ((step.model, now, stress(step)), (None, found, None)):
        heat = state.account.heat
        assert heat is not None
        start = state.state.start
        inside = float(start.energy.sum()) + heat.content + state.account.dissipation - heat.received
        sums.append((inside + state.account.remeshing, heat.content - heat.received, heat.entropy))
        assert model is None or np.abs(wide).max() > HELD
    assert sums[1][0] == pytest.approx(sums[0][0], rel=1e-13)
    assert sums[1][1] == pytest.approx(sums[0][1], rel=1e-13)
    assert sums[1][2] >= sums[0][2] - 1e-15
    *_, last = sw.march(scene, state=found, **given)
    assert last.ledger.heat is not None
    assert abs(last.ledger.heat.error) < 1e-12 * last.ledger.heat.content
    assert whole(last.ledger) == pytest.approx(whole(step.ledger), rel=1e-12)


@pytest.mark.slow
def test_as_on_the_mesh_of_the_start() -> None:
    """A warm billet that is upset by a quarter: force, heat and volume as on the mesh that stays."""
    kept, new = (upset(billet(how, GROWS), 0.25, 6) for how in (KEPT, HOW))
    assert changes(new)
    keeps_its_heat(new)
    assert force(new[-1]) == pytest.approx(force(kept[-1]), rel=1e-3)
    one, two = kept[-1].ledger.heat, new[-1].ledger.heat
    assert one is not None and two is not None
    assert two.received - two.zero == pytest.approx(one.received - one.zero, rel=0.05)
    assert two.content - one.content == pytest.approx(0.0, abs=1e-2 * one.received)
    assert temperatures(new[-1]).mean() == pytest.approx(temperatures(kept[-1]).mean(), abs=0.5)


@pytest.mark.slow
def test_the_same_bits_from_a_stored_state() -> None:
    scene, until = billet(HOW, GROWS), 0.25 * 0.75
    steps = list(sw.march(scene, until=until, step=until / 6))
    for slabs in (changes(steps)[0], changes(steps)[0] + 1):
        continues(scene, steps, slabs, until=until, step=until / 6)
    *_, last = sw.march(scene, state=steps[0].march_state, until=until, step=until / 6)
    assert np.array_equal(last.after.displacement["body"], steps[-1].after.displacement["body"])
    assert np.array_equal(temperatures(last), temperatures(steps[-1]))


def test_a_hot_bar_thrown_at_a_wall() -> None:
    """With inertia the massless nodes find their equilibrium at once, which changes the temperature but no content."""
    scene = taylor.scene((5, 25))
    bar = scene.bodies["bar"]
    assert isinstance(bar, sw.Solid)
    mesh = sw.meshes.Rectangle(size=(taylor.RADIUS, taylor.LENGTH), cells=(5, 25), cell="tri3")
    bar = replace(bar, mesh=mesh, dilatation="corner", remesh=sw.meshes.Remesh(by="new cells", quality=0.75))
    copper = sw.heat.Conduction(conductivity=400.0, capacity=385.0)
    thermal = sw.bodies.Thermal(law=copper, temperature=lambda x: 300.0 + 2e3 * x[:, 1], expansion=1.7e-5)
    scene = replace(scene, bodies={**scene.bodies, "bar": replace(bar, thermal=thermal)})
    steps = list(sw.march(scene, until=8 * 0.78e-6, step=0.78e-6, method=taylor.METHOD))
    kinetic = steps[0].ledger.energy_kinetic
    assert changes(steps)
    assert abs(steps[-1].ledger.remeshing) < 1e-12 * kinetic
    for last, taken in pairwise(steps):
        old, new = last.ledger.heat, taken.ledger.heat
        assert old is not None and new is not None
        assert abs(new.error) < 1e-13 * new.content
        assert new.entropy - new.produced - old.entropy >= -1e-13 * new.entropy
        assert whole(taken.ledger) == pytest.approx(whole(last.ledger), abs=1e-9 * kinetic)
