"""Warm billets whose meshes are replaced: first and second law, heat of plastic work, films, contacts, melting."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from forging import HEIGHT, KEPT, changes, continues, force
from warm_billets import HOW, PLASTIC, STEEL, WARM, accounted_changes, billet, keeps_its_heat, temperatures, upset

import softway as sw
from softway.errors import InputError
from softway.marching.remeshing.carried_heat import temperature_of
from softway.marching.remeshing.forming.formable import formable

LATENT = sw.heat.Latent(heat=1.0, melting=1050.0)
CURVED = replace(STEEL, capacity=sw.heat.TemperatureTable(temperatures=(900.0, 1200.0), values=(0.01, 0.02)))
SOFTER = sw.heat.StiffnessTable(temperatures=(900.0, 1500.0), values=(1.0, 0.5))


@pytest.mark.slow
@pytest.mark.parametrize(("cell", "least"), [("quad4", 3), ("tri3", 2)])
def test_a_billet_upset_to_half_of_its_height(cell: str, least: int) -> None:
    """New triangles have other cells, and need fewer changes."""
    steps = upset(billet(HOW, cell=cell), 0.5, 16)
    assert len(changes(steps)) >= least
    keeps_its_heat(steps)
    heat, ledger = steps[-1].ledger.heat, steps[-1].ledger
    begun = steps[0].ledger.heat
    assert heat is not None
    assert begun is not None
    start = begun.content - begun.received
    assert heat.content == pytest.approx(start + heat.received, rel=1e-13)
    plastic = heat.received - heat.friction + heat.cold_work
    assert heat.received - heat.friction == pytest.approx(0.9 * plastic, rel=1e-12)
    assert 0.7 * ledger.dissipation < plastic < ledger.dissipation
    assert heat.received > 0.05 * start


def test_as_on_the_mesh_of_the_start_while_that_is_good() -> None:
    kept, new = (upset(billet(how), 0.25, 6) for how in (KEPT, HOW))
    assert changes(new)
    one, other = kept[-1].ledger.heat, new[-1].ledger.heat
    assert one is not None
    assert other is not None
    assert force(new[-1]) == pytest.approx(force(kept[-1]), rel=5e-3)
    assert other.received == pytest.approx(one.received, rel=2e-3)
    rises = [temperatures(steps[-1]) - 1000.0 for steps in (kept, new)]
    assert rises[1].mean() == pytest.approx(rises[0].mean(), rel=5e-3)
    assert rises[1].max() == pytest.approx(rises[0].max(), rel=0.03)


def test_a_uniform_temperature_stays() -> None:
    """Without plastic heat, and in equilibrium with its surroundings."""
    thermal = replace(WARM, temperature=1000.0, heating=0.0)
    loads = (sw.heat.Convection(on="body.right", coefficient=0.1, ambient=1000.0),)
    steps = upset(billet(HOW, thermal, loads=loads), 0.2, 4)
    assert changes(steps)
    assert temperatures(steps[-1]) == pytest.approx(1000.0, rel=1e-12)


def test_tools_films_and_held_nodes_find_the_new_surface() -> None:
    """Heat passes into the tool in every slab, and prescribed temperatures are on the new mesh."""
    contact = sw.heat.ContactHeat(conductance=1e-3, tool_temperature=400.0)
    loads = (
        sw.heat.Temperature(on="body.bottom", value=900.0),
        sw.heat.Convection(on="body.right", coefficient=0.02, ambient=300.0),
    )
    steps = upset(billet(HOW, contact=contact, loads=loads), 0.25, 8)
    assert changes(steps)
    for last, taken in pairwise(steps):
        old, new = last.ledger.heat, taken.ledger.heat
        assert old is not None
        assert new is not None
        assert abs(new.error) < 1e-12 * new.content
        mesh = taken.model.parts[0].mesh
        bottom = mesh.nodes("bottom")
        assert sum(new.through) > sum(old.through)
        assert temperatures(taken)[bottom] == pytest.approx(900.0, rel=1e-12)


def test_laws_that_soften_know_the_temperature_of_their_points() -> None:
    soft = replace(PLASTIC, softening=sw.laws.JohnsonCookSoftening(reference=300.0, melting=1800.0))
    new = upset(billet(HOW, material=soft), 0.2, 5)
    assert changes(new)
    keeps_its_heat(new)
    changed = new[changes(new)[-1]]
    found = temperature_of(changed.model)
    state = changed.march_state.state.start.states[0]
    assert found is not None
    assert state is not None
    assert state.temperature is not None
    (point,) = found[1].points
    nodal = temperatures(changed)
    assert state.temperature == pytest.approx(point.at(np.stack([nodal] * 3))[0], rel=1e-12)


@pytest.mark.parametrize(
    "thermal",
    [
        pytest.param(replace(WARM, law=CURVED), id="capacity by temperature"),
        pytest.param(
            replace(WARM, stiffness=SOFTER),
            id="stiffness by temperature",
        ),
        pytest.param(replace(WARM, law=replace(STEEL, latent=replace(LATENT, half_range=20.0))), id="mushy"),
    ],
)
def test_other_laws_of_heat(thermal: sw.bodies.Thermal) -> None:
    steps = upset(billet(HOW, thermal), 0.2, 5)
    assert changes(steps)
    keeps_its_heat(steps)


@pytest.mark.slow
@pytest.mark.parametrize("cell", ["quad4", pytest.param("tri3", marks=pytest.mark.minutes)])
def test_fronts_of_melting_pass_with_their_latent_heat(cell: str) -> None:
    steps = upset(billet(HOW, replace(WARM, law=replace(STEEL, latent=LATENT)), cell), 0.45, 8)
    assert changes(steps)
    for _, taken in accounted_changes(steps):
        heat = taken.ledger.heat
        assert heat is not None
        assert 0.0 < heat.liquid["body"] < np.pi * HEIGHT


def test_the_same_bits_from_a_stored_state() -> None:
    scene, until = billet(HOW), 0.25 * HEIGHT
    whole = list(sw.march(scene, until=until, step=until / 6))
    first = changes(whole)[0]
    for slabs in (first, first + 1):
        continues(scene, whole, slabs, until=until, step=until / 6)


@pytest.mark.parametrize(
    ("thermal", "where"),
    [
        (replace(WARM, expansion=1e-5, stiffness=SOFTER), "bodies.body.thermal.expansion"),
        (
            replace(WARM, law=replace(STEEL, latent=LATENT), melting_strain=0.01),
            "bodies.body.thermal.melting_strain",
        ),
        (replace(WARM, law={"a": STEEL, "b": STEEL}), "bodies.body.thermal.law"),
    ],
)
def test_heat_that_does_not_pass(thermal: sw.bodies.Thermal, where: str) -> None:
    """With numbers it is refused, with a remedy; with auto the mesh stays."""
    scene = billet(sw.meshes.Remesh(), thermal)
    body = scene.bodies["body"]
    assert isinstance(body, sw.Solid)
    mesh = body.mesh.with_region("a", lambda x: x[:, 0] < 0.5)  # type: ignore[union-attr]
    mesh = mesh.with_region("b", lambda x: x[:, 0] > 0.5)
    scene = replace(scene, bodies={**scene.bodies, "body": replace(body, mesh=mesh)})
    with pytest.raises(InputError) as refusal:
        sw.march(scene, until=1e-3, step=1e-3)
    assert refusal.value.where == where
    assert "mesh that stays" in refusal.value.remedy
    body = replace(body, mesh=mesh, remesh="auto")
    stay = formable(sw.build(replace(scene, bodies={**scene.bodies, "body": body})), sw.FixedPoint())[1]
    assert set(stay) == {"body"}


def test_a_tool_takes_the_heat_of_its_present_contact() -> None:
    """Through the end face of a billet passes conductance times area times difference, of the middle of each slab."""
    contact = sw.heat.ContactHeat(conductance=1e-3, tool_temperature=400.0)
    passed = 0.0
    for k, step in enumerate(upset(billet(KEPT, contact=contact), 0.4, 8)):
        ends = []
        for state in (step.before, step.after):
            x = step.model.points + state.displacement["body"]
            face = step.model.parts[0].mesh.nodes("top")
            face = face[np.argsort(x[face, 0])]
            r, over = x[face, 0], state.fields["temperature"]["body"][face, 0] - 400.0
            a, b, one, two = r[:-1], r[1:], over[:-1], over[1:]
            ends.append(2e-3 * np.pi * ((b - a) * (a * (one + two) / 2 + (b - a) * (one + 2.0 * two) / 6)).sum())
        heat = step.ledger.heat
        assert heat is not None
        found, passed = (heat.through[0] - passed) / (step.after.time - step.before.time), heat.through[0]
        assert found == pytest.approx(np.mean(ends), rel=2e-3 if k > 1 else 2e-2)
