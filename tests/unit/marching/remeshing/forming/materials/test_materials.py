"""Bimetals whose meshes are replaced: masses, volumes, energy, memory, force, and what is refused."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from bimetals import (
    DENSITIES,
    HARD,
    HOW,
    LAWS,
    SOFT,
    Where,
    accounted,
    billet,
    core,
    divided,
    inclusion,
    layer,
    masses,
    pressed,
)
from forging import KEPT, changes, continues, force

import softway as sw
from softway.adaptivity.rezoning.quality import cell_quality
from softway.adaptivity.rezoning.zones import zones_of
from softway.apps.cli import main
from softway.errors import InputError
from softway.meshes.mesh import Mesh


@pytest.mark.slow
@pytest.mark.parametrize("where", [core, layer, inclusion])
def test_a_bimetal_pressed_to_half_of_its_height(where: Where) -> None:
    mesh = sw.meshes.Rectangle(size=(1.0, 0.8), cells=(10, 8)).build()
    kept, new = (pressed(billet(how, mesh, where), 0.5, 20) for how in (KEPT, HOW))
    assert len(changes(new)) >= 4
    accounted(new)
    good = [k for k, one in enumerate(kept) if one.after.time < 0.25 * 0.8]
    for k in good:
        assert force(new[k]) == pytest.approx(force(kept[k]), rel=1e-2)
    for k in set(changes(new)) & set(good):
        jump = (force(new[k]) / force(kept[k])) / (force(new[k - 1]) / force(kept[k - 1])) - 1.0
        assert abs(jump) < 5e-3
    ends = [
        cell_quality(one.model.parts[0].mesh.blocks, one.model.points + one.after.displacement["body"]).worst
        for one in (kept[-1], new[-1])
    ]
    assert ends[1][2] < 1.1 * ends[0][2]  # the corner is flat in both where it folds onto the platen


@pytest.mark.parametrize("cell", ["quad8", "tri3"])
def test_as_on_the_mesh_of_the_start_while_that_is_good(cell: str) -> None:
    cells = (4, 4) if cell == "quad8" else (6, 6)
    mesh = sw.meshes.Rectangle(size=(1.0, 0.8), cells=cells, cell=cell).build()
    limits = HOW if cell == "quad8" else replace(HOW, ratio=2.0)
    kept, new = (pressed(billet(how, mesh), 0.2, 5) for how in (KEPT, limits))
    assert changes(new)
    accounted(new)
    assert force(new[-1]) == pytest.approx(force(kept[-1]), rel=2e-3)


def test_several_types_of_cells() -> None:
    plain = sw.meshes.Rectangle(size=(1.0, 0.8), cells=(8, 8)).build()
    cells = plain.blocks["quad4"]
    low = plain.centres()[:, 1] < 0.4
    halves = np.concatenate([cells[low][:, [0, 1, 2]], cells[low][:, [0, 2, 3]]])
    mesh = Mesh(points=plain.points, blocks={"quad4": cells[~low], "tri3": halves}, tags=plain.tags)
    kept, new = (pressed(billet(how, mesh), 0.25, 6) for how in (KEPT, HOW))
    assert changes(new)
    accounted(new)
    assert force(new[-1]) == pytest.approx(force(kept[-1]), rel=2e-3)


def test_the_same_law_twice_is_as_one_material() -> None:
    """Only the nodes of the common boundary differ: they stay on it."""
    twice = pressed(billet(HOW, laws={"core": SOFT, "skin": SOFT}), 0.2, 5)
    scene = billet(HOW)
    body = scene.bodies["body"]
    assert isinstance(body, sw.Solid)
    once = replace(body, material=SOFT, density=1.0)
    one = pressed(replace(scene, bodies={**scene.bodies, "body": once}), 0.2, 5)
    assert changes(twice) == changes(one)
    assert force(twice[-1]) == pytest.approx(force(one[-1]), rel=1e-3)


def test_memory_passes_between_cells_of_one_material_only() -> None:
    """A core that stays elastic has no plastic strain after any change, and the same stress up to its own means."""
    elastic = sw.J2(E=1e3, nu=0.3, yield_stress=1e6, hardening=sw.laws.LinearHardening(modulus=0.5))
    steps = pressed(billet(HOW, where=layer, laws={"core": elastic, "skin": SOFT}), 0.15, 8)
    assert changes(steps)
    state = steps[-1].march_state.state.start.states[0]
    assert state is not None
    assert state.regions["core"].law["plastic_strain"].max() == 0.0
    assert state.regions["core"].dissipated.max() == 0.0
    assert state.regions["skin"].law["plastic_strain"].min() > 0.0


@pytest.mark.slow
def test_hexahedra_of_two_materials_keep_their_plane_boundary() -> None:
    mesh = sw.meshes.Box(size=(1.0, 1.0, 0.8), cells=(3, 3, 3), cell="hex8").build()
    body = sw.Solid(
        mesh=divided(mesh, lambda x: x[:, 2] < 0.3),
        material=LAWS,
        density=DENSITIES,
        dilatation="mean",
        remesh=HOW,
        supports=tuple(sw.Fixed(on=on, components=c) for on, c in (("left", "x"), ("front", "y"), ("bottom", "z"))),
    )
    scene = billet(HOW)
    platen = sw.Tool(
        shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, 0.8), normal=(0.0, 0.0, -1.0)),
        motion=sw.bodies.Translation(velocity=(0.0, 0.0, -1.0)),
    )
    bodies = {"body": body, "platen": platen}
    kept, new = (
        pressed(replace(scene, bodies={**bodies, "body": replace(body, remesh=how)}), 0.25, 6) for how in (KEPT, HOW)
    )
    assert changes(new)
    accounted(new)
    assert force(new[-1]) == pytest.approx(force(kept[-1]), rel=1e-2)


@pytest.mark.slow
def test_a_thrown_bar_keeps_momentum_and_energy() -> None:
    mesh = sw.meshes.Rectangle(size=(0.5, 2.0), cells=(5, 20)).build()
    bar = sw.Solid(
        mesh=divided(mesh, lambda x: x[:, 0] < 0.3),
        material={"core": SOFT, "skin": HARD},
        density=DENSITIES,
        section=sw.bodies.Axisymmetric(),
        dilatation="mean",
        remesh=sw.meshes.Remesh(ratio=2.2, shortened=0.0),
        velocity=(0.0, -0.5),
        supports=(sw.Fixed(on="left", components="x"),),
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    scene = sw.Scene(bodies={"body": bar, "wall": wall}, contacts=(sw.Contact(between=("body.bottom", "wall")),))
    steps = list(sw.march(scene, until=0.5, step=0.01))
    assert changes(steps)
    start = 0.5 * masses(steps[0]).sum() * 0.5**2
    for k in changes(steps):
        assert abs(steps[k].exchanges["body"].energy) < 1e-13 * start
        np.testing.assert_allclose(masses(steps[k]), masses(steps[0]), rtol=1e-12)
    assert abs(steps[-1].ledger.energy_error) < 1e-11 * start


def test_the_same_bits_from_a_stored_state() -> None:
    scene, until = billet(HOW), 0.15 * 0.8
    whole = list(sw.march(scene, until=until, step=until / 6))
    continues(scene, whole, changes(whole)[0] + 1, until=until, step=until / 6)


def test_zones_have_their_common_boundary_in_lines() -> None:
    part = sw.build(billet(None, where=inclusion)).parts[0]
    zones = zones_of(part.mesh, part.materials.owner)
    assert len(zones.blocks) == 2
    assert not zones.joints.any()
    assert len(zones.nodes) == 16


@pytest.mark.parametrize(
    ("laws", "remesh", "where"),
    [
        ({"core": sw.LinearElastic(E=1e3, nu=0.3), "skin": HARD}, sw.meshes.Remesh(), "bodies.body.material.core"),
        (LAWS, sw.meshes.Remesh(by="new cells"), "bodies.body.remesh.by"),
    ],
)
def test_what_does_not_pass_names_the_region_and_a_remedy(
    laws: dict[str, sw.laws.law.Material], remesh: sw.meshes.Remesh, where: str
) -> None:
    mesh = sw.meshes.Rectangle(size=(1.0, 0.8), cells=(4, 4), cell="tri3").build()
    with pytest.raises(InputError) as refusal:
        sw.march(billet(remesh, mesh, laws=laws), until=1e-3, step=1e-3)
    assert refusal.value.where == where
    assert refusal.value.remedy


SCENARIO = """
title = "bimetal"
inertia = { kind = "Off" }

[bodies.billet]
kind = "Solid"
section = { kind = "Axisymmetric" }
dilatation = "mean"
density = { core = "1 kg/m^3", skin = "2 kg/m^3" }
remesh = { ratio = 1.3, shortened = 0 }
supports = [{ kind = "Fixed", on = "bottom", components = "y" }, { kind = "Fixed", on = "left", components = "x" }]

[bodies.billet.mesh]
kind = "Divided"
rest = "skin"
mesh = { kind = "Rectangle", size = ["1 m", "0.8 m"], cells = [4, 4] }
regions = { core = { kind = "InBox", high = ["0.5 m"] } }

[bodies.billet.material]
core = { kind = "J2", E = "1 kPa", nu = 0.3, yield_stress = "1 Pa" }
skin = { kind = "J2", E = "2 kPa", nu = 0.3, yield_stress = "2 Pa" }

[bodies.platen]
kind = "Tool"
shape = { kind = "HalfSpace", point = [0, 0.8], normal = [0, -1] }
motion = { kind = "Translation", velocity = [0, -1] }

[[contacts]]
between = ["billet", "platen"]

[time]
end = "0.16 s"
step = "20 ms"

[output]
fields_every = "20 ms"
"""


def test_a_scenario_file_is_run_and_audited(tmp_path: Path) -> None:
    (file := tmp_path / "bimetal.toml").write_text(SCENARIO)
    assert main(["run", str(file), "--out", str(tmp_path / "run")]) == 0
    assert main(["audit", str(tmp_path / "run"), "--strict"]) == 0
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert summary["mesh"]["changes"] >= 1
