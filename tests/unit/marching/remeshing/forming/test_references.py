"""Forging with new meshes against the references of cases E02 and E03, and to 80 per cent where a fixed mesh folds."""

import re
from pathlib import Path

import numpy as np
import pytest
from forging import force, places, volume

import softway as sw
from softway.adaptivity.rezoning.quality import cell_quality
from softway.apps.verify.case import sheet
from softway.laws.law import Material
from softway.marching.results.finding import FLAT_CELL, INVERTED
from softway.meshes.cell_shapes import FLAT
from softway.meshes.remeshed.remesh import Remesh, Remeshing
from softway.scenario.files import loads

PUNCH = """
title = "Ball pressed into a block of quadrilaterals"
inertia = { kind = "Off" }
[bodies.body]
kind = "Solid"
mesh = { kind = "Rectangle", size = [1.0, 1.0], cells = [6, 6] }
material = { kind = "J2", E = 1000.0, nu = 0.3, yield_stress = 1.0 }
density = 1.0
section = { kind = "Axisymmetric" }
dilatation = "mean"
supports = [{ kind = "Fixed", on = "bottom", components = "y" }, { kind = "Fixed", on = "left", components = "x" }]
[bodies.ball]
kind = "Tool"
shape = { kind = "Sphere", centre = [0.0, 1.35], radius = 0.35 }
motion = { kind = "Translation", velocity = [0.0, -1.0] }
[[contacts]]
between = ["body", "ball"]
friction = { kind = "Coulomb", mu = 0.1 }
[time]
end = 0.5
step = 0.0133333
"""
PLATEN = sw.bodies.Translation(velocity=(0.0, -1.0))


def pressed(
    inner: float,
    size: tuple[float, float],
    cells: tuple[int, int],
    material: Material,
    friction: sw.laws.NortonHoffFriction,
    how: Remeshing,
    slabs: int,
) -> list[sw.Step]:
    """Slabs of a ring of triangles, or a cylinder, under a platen to 30 per cent of its height."""
    supports = [sw.Fixed(on="bottom", components="y")]
    supports += [sw.Fixed(on="left", components="x")] if inner == 0.0 else []
    body = sw.Solid(
        mesh=sw.meshes.Rectangle(size=size, cells=cells, cell="tri3"),
        place=sw.bodies.Placement(translation=(inner, 0.0)),
        material=material,
        density=1.0,
        section=sw.bodies.Axisymmetric(),
        dilatation="corner",
        supports=tuple(supports),
        remesh=how,
    )
    platen = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, size[1]), normal=(0.0, -1.0)), motion=PLATEN)
    contacts = (sw.Contact(between=("body.top", "platen"), friction=friction),)
    scene = sw.Scene(bodies={"body": body, "platen": platen}, contacts=contacts, inertia=sw.bodies.Off())
    until = 0.3 * size[1]
    return list(sw.march(scene, until=until, step=until / slabs))


def changes(steps: list[sw.Step]) -> int:
    """Number of new meshes."""
    return sum(bool(one.exchanges) for one in steps)


@pytest.mark.slow
def test_the_force_of_case_e02_through_new_cells() -> None:
    """Force of each slab but the first against the table of quadratic cells, read linearly."""
    friction = sw.laws.NortonHoffFriction(alpha=0.3, p=0.3, K=1.0)
    how = Remesh(by="new cells", quality=0.75, ratio=1.5)
    steps = pressed(0.0, (1.0, 0.75), (10, 12), sw.laws.NortonHoff(K=1.0, m=0.3), friction, how, 20)
    assert changes(steps) >= 1
    table = np.array(sheet("E02")["reference"]["fine_12x10x24"])
    reduction = np.array([0.5 * (one.before.time + one.after.time) for one in steps[1:]]) / 0.75
    known = np.interp(reduction, table[:, 0], table[:, 1])
    np.testing.assert_allclose([force(one) for one in steps[1:]], known, rtol=3e-3)
    assert volume(steps[-1]) == pytest.approx(np.pi * 0.75, rel=1e-4)
    assert sum(abs(one.exchanges["body"].volume) for one in steps if one.exchanges) < 1e-12


@pytest.mark.slow
@pytest.mark.few(2)
@pytest.mark.parametrize("alpha", [0.05, 0.2, 0.5])
def test_the_inner_radius_of_case_e03_through_new_cells(alpha: float) -> None:
    """Change of the inner radius at half height, and the force; the case allows .02 and 2 per cent."""
    friction = sw.laws.NortonHoffFriction(alpha=alpha, p=0.2, K=1.0)
    how = Remesh(by="new cells", quality=0.75, ratio=1.5)
    steps = pressed(1.5, (1.5, 1.0), (12, 12), sw.laws.NortonHoff(K=1.0, m=0.2), friction, how, 12)
    assert changes(steps) >= 1
    mesh, x = steps[-1].model.parts[0].mesh, places(steps[-1])
    low = mesh.nodes("bottom")
    table = np.array(sheet("E03")["reference"]["table"][str(alpha)])
    assert x[low, 0].min() == pytest.approx(table[-1, 4], abs=3e-3)
    middle = 0.5 * (steps[-1].before.time + steps[-1].after.time)
    assert force(steps[-1]) == pytest.approx(np.interp(middle, table[:, 0], table[:, 1]), rel=5e-3)


def punched(cell: str, how: Remeshing) -> list[sw.Step]:
    """A ball pressed into a block of J2 to 80 per cent of its height."""
    body = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(6, 6), cell=cell),
        material=sw.J2(E=1e3, nu=0.3, yield_stress=1.0),
        density=1.0,
        section=sw.bodies.Axisymmetric(),
        dilatation="mean" if cell == "quad4" else "corner",
        supports=(sw.Fixed(on="bottom", components="y"), sw.Fixed(on="left", components="x")),
        remesh=how,
    )
    ball = sw.Tool(shape=sw.obstacles.Sphere(centre=(0.0, 1.35), radius=0.35), motion=PLATEN)
    contacts = (sw.Contact(between=("body", "ball"), friction=sw.laws.Coulomb(mu=0.1)),)
    scene = sw.Scene(bodies={"body": body, "ball": ball}, contacts=contacts, inertia=sw.bodies.Off())
    return list(sw.march(scene, until=0.8, step=0.8 / 60))


@pytest.mark.slow
def test_a_ball_through_most_of_a_block() -> None:
    """No fixed mesh keeps a good certificate to 80 per cent: triangles get flat, and say so with the cell, the time and
    what helps; it does.  Quadrilaterals fold, see the next test.
    """
    marches = {key: punched(*key) for key in (("tri3", None), ("tri3", "auto"))}
    shapes = {key: min(one.certificate.shape for one in steps) for key, steps in marches.items()}
    assert 0.0 < shapes["tri3", None] < FLAT
    assert shapes["tri3", "auto"] > 0.2
    triangles, steps = ([e for one in steps for e in one.events if e.finding] for steps in marches.values())
    assert {e.kind for e in triangles} == {FLAT_CELL} and not steps
    assert 'Remedy: remesh = "auto"' in triangles[0].finding and 0.5 < triangles[0].time < 0.6
    steps = marches["tri3", "auto"]
    mesh = steps[-1].model.parts[0].mesh
    assert cell_quality(mesh.blocks, places(steps[-1])).worst[0] > 0.3
    assert changes(steps) >= 5
    assert volume(steps[-1]) == pytest.approx(np.pi, rel=1e-4)
    assert sum(abs(one.exchanges["body"].volume) for one in steps if one.exchanges) < 1e-12


def test_a_folded_cell_is_a_finding_of_a_run(tmp_path: Path) -> None:
    """The first slab with a folded cell tells it, though frames are stored at other instants.

    At .43 s a cell folds for good; before that corners turn over and back, in other slabs on other processors.
    """
    run = sw.run(loads(PUNCH), tmp_path / "run")
    assert run.status == "done, with findings"
    found = next(one for one in run.summary["findings"] if one["kind"] == INVERTED)
    shape = run.history["certificate.shape"]
    (first, *_) = np.flatnonzero(shape <= 0.0)
    assert found["between"] == "body"
    assert found["first"] == pytest.approx(run.history["time"][first])
    assert 0.15 < found["first"] < 0.45
    assert 'cells "tri3" with dilatation = "corner" and remesh = "auto"' in found["text"]
    assert re.match(r"cell \d+ of 'body', at its node \d+, has folded: scaled Jacobian -0\.\d", found["text"])
    assert run.summary["shape_worst"] < -0.5
    assert (shape[run.history["time"] > 0.43] < -0.7).all()
    assert run.summary["shape_worst"] == pytest.approx(shape[1:].min())
    assert np.isnan(shape[0]) and (shape[1:first] > 0.0).all()
