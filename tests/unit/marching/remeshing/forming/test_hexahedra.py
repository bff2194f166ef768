"""A block of hexahedra pressed between planes, with meshes that are replaced: volume, energy, force."""

import numpy as np
import pytest
from forging import KEPT, changes, force

import softway as sw
from softway.adaptivity.rezoning.quality import cell_quality
from softway.adaptivity.rezoning.volume import volume_of
from softway.errors import InputError
from softway.meshes.remeshed.remesh import Remeshing

HEIGHT = 0.8
HOW = sw.meshes.Remesh(ratio=1.5, shortened=0.0)
LAW = sw.J2(E=1e3, nu=0.3, yield_stress=1.0, hardening=sw.laws.LinearHardening(modulus=0.5))


def block(remesh: Remeshing, cell: str = "hex8", **given: object) -> sw.Scene:
    """An eighth of a block between two planes with friction."""
    body = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, HEIGHT), cells=(3, 3, 3), cell=cell).build(),
        material=LAW,
        density=1.0,
        dilatation="mean" if cell == "hex8" else "point",
        remesh=remesh,
        supports=(
            sw.Fixed(on="left", components="x"),
            sw.Fixed(on="front", components="y"),
            sw.Fixed(on="bottom", components="z"),
        ),
        **given,  # type: ignore[arg-type]
    )
    platen = sw.Tool(
        shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, HEIGHT), normal=(0.0, 0.0, -1.0)),
        motion=sw.bodies.Translation(velocity=(0.0, 0.0, -1.0)),
    )
    contact = sw.Contact(between=("body.top", "platen"), friction=sw.laws.Coulomb(mu=0.2))
    return sw.Scene(bodies={"body": body, "platen": platen}, contacts=(contact,), inertia=sw.bodies.Off())


def pressed(scene: sw.Scene, reduction: float, slabs: int) -> list[sw.Step]:
    until = reduction * HEIGHT
    return list(sw.march(scene, until=until, step=until / slabs))


def volume(one: sw.Step) -> float:
    part = one.model.parts[0]
    return volume_of(part.mesh.blocks, part.internal.section, part.mesh.points + one.after.displacement["body"])


@pytest.mark.slow
def test_a_block_pressed_to_half_of_its_height() -> None:
    steps = pressed(block(HOW), 0.5, 20)
    assert len(changes(steps)) >= 4
    for one in steps:
        if one.exchanges:
            found = one.exchanges["body"]
            assert abs(found.volume) < 1e-13
            assert abs(found.energy) < 1e-13 * one.ledger.work_external
    last = steps[-1]
    assert abs(last.ledger.energy_error) < 1e-12 * last.ledger.work_external
    part = last.model.parts[0]
    found = cell_quality(part.mesh.blocks, part.mesh.points + last.after.displacement["body"]).worst
    assert found[0] > 0.25
    assert found[2] < 5.0  # 5.8 on the mesh of the start
    assert volume(last) == pytest.approx(HEIGHT, rel=2e-3)


def test_as_on_the_mesh_of_the_start_while_that_is_good() -> None:
    kept, new = (pressed(block(how), 0.25, 7) for how in (KEPT, HOW))
    assert changes(new)
    first = changes(new)[0]
    assert force(new[first]) == pytest.approx(force(kept[first]), rel=2e-3)
    assert force(new[-1]) == pytest.approx(force(kept[-1]), rel=2e-2)
    assert volume(new[-1]) == pytest.approx(volume(kept[-1]), rel=1e-4)


def test_warm_hexahedra_keep_their_heat() -> None:
    thermal = sw.bodies.Thermal(
        law=sw.heat.Conduction(conductivity=1e-2, capacity=1e-2), temperature=lambda x: 900.0 + 200.0 * x[:, 2]
    )
    steps = pressed(block(HOW, thermal=thermal), 0.15, 4)
    assert changes(steps)
    for one in steps:
        heat = one.ledger.heat
        assert heat is not None
        assert abs(heat.error) < 1e-12 * heat.content
    values = steps[-1].after.fields["temperature"]["body"]
    assert values.min() > 900.0
    assert np.ptp(values) < 200.0


@pytest.mark.slow
def test_quadratic_hexahedra_slide_on_flat_faces_with_the_middles_of_their_edges() -> None:
    kept, new = (pressed(block(how, "hex20"), 0.3, 9) for how in (KEPT, HOW))
    assert len(changes(new)) >= 2
    for one in new:
        if one.exchanges:
            assert abs(one.exchanges["body"].volume) < 1e-13
            assert abs(one.exchanges["body"].energy) < 1e-13 * one.ledger.work_external
    assert abs(new[-1].ledger.energy_error) < 1e-12 * new[-1].ledger.work_external
    assert force(new[-1]) == pytest.approx(force(kept[-1]), rel=2e-2)
    assert volume(new[-1]) == pytest.approx(volume(kept[-1]), rel=1e-4)
    part = new[-1].model.parts[0]
    edges = part.mesh.blocks["hex20"][:, [0, 1, 8]]
    on = np.isin(edges, part.mesh.nodes("bottom")).all(axis=1)
    x = part.mesh.points[edges[on]]
    assert x[:, 2] == pytest.approx(0.5 * (x[:, 0] + x[:, 1]), abs=1e-15)


def test_new_cells_and_other_hexahedra_are_refused_with_remedies() -> None:
    with pytest.raises(InputError) as refusal:
        sw.march(block(sw.meshes.Remesh(by="new cells")), until=1e-3, step=1e-3)
    assert refusal.value.where == "bodies.body.remesh.by"
    assert 'by = "rezone"' in refusal.value.remedy
    with pytest.raises(InputError) as refusal:
        sw.march(block(sw.meshes.Remesh(), "hex27"), until=1e-3, step=1e-3)
    assert refusal.value.where == "bodies.body.mesh"
    assert "hex20" in refusal.value.remedy
    thermal = sw.bodies.Thermal(law=sw.heat.Conduction(conductivity=1.0, capacity=1.0), temperature=300.0)
    with pytest.raises(InputError) as refusal:
        sw.march(block(sw.meshes.Remesh(), "hex20", thermal=thermal), until=1e-3, step=1e-3)
    assert refusal.value.where == "bodies.body.thermal.mesh"
