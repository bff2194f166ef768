"""Marches with new cells: a bar thrown at a wall, presses, and bodies that get none."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.adaptivity.rezoning.quality import cell_quality
from softway.adaptivity.rezoning.volume import volume_of
from softway.apps.verify.scenes import taylor
from softway.arrays import Array
from softway.errors import InputError
from softway.march.remeshing.forming.formed_scene import formed_scene
from softway.march.remeshing.forming.forming_march import FormedStep, forming_march
from softway.march.remeshing.forming.remesh import Generator, Remesh, Way
from softway.march.remeshing.forming.replacement import replacement

LAW = sw.laws.NortonHoff(K=1.0, m=0.3)
HEIGHT = 0.75


def thrown(cells: tuple[int, int], speed: float, until: float, how: Remesh) -> list[FormedStep]:
    scene = taylor.scene(cells)
    bar = scene.bodies["bar"]
    assert isinstance(bar, sw.Solid)
    mesh = sw.meshes.Rectangle(size=(taylor.RADIUS, taylor.LENGTH), cells=cells, cell="tri3")
    new = replace(bar, mesh=mesh, dilatation="corner", velocity=sw.bodies.Uniform(value=(0.0, -speed)))
    scene = replace(scene, bodies={**scene.bodies, "bar": new})
    return list(forming_march(scene, {"bar": how}, until=until, step=0.78e-6, method=taylor.METHOD))


def press(cell: str = "tri3", cells: tuple[int, int] = (6, 5), dilatation: str = "corner") -> sw.Scene:
    body = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, HEIGHT), cells=cells, cell=cell),
        material=LAW,
        density=1.0,
        section=sw.bodies.Axisymmetric(),
        dilatation=dilatation,  # type: ignore[arg-type]
        supports=(sw.Fixed(on="bottom", components="y"), sw.Fixed(on="left", components="x")),
    )
    platen = sw.Tool(
        shape=sw.obstacles.HalfSpace(point=(0.0, HEIGHT), normal=(0.0, -1.0)),
        motion=sw.bodies.Translation(velocity=(0.0, -1.0)),
    )
    rough = sw.laws.NortonHoffFriction(alpha=0.3, p=0.3, K=1.0)
    contacts = tuple(sw.Contact(between=(f"body.{tag}", "platen"), friction=rough) for tag in ("top", "right"))
    return sw.Scene(bodies={"body": body, "platen": platen}, contacts=contacts, inertia=sw.bodies.Off())


def pressed(how: Remesh, reduction: float, slabs: int, cell: str = "tri3") -> list[FormedStep]:
    until = reduction * HEIGHT
    return list(forming_march(press(cell), {"body": how}, until=until, step=until / slabs))


def places(one: FormedStep) -> Array:
    displacement = np.concatenate([one.step.after.displacement[p.name] for p in one.model.parts])
    return np.asarray(one.model.points + displacement)


def volume(one: FormedStep) -> float:
    part = one.model.parts[0]
    return volume_of(part.mesh.blocks, part.internal.section, places(one))


def force(one: FormedStep) -> float:
    return sum(c.force_n for c in one.step.ledger.contacts.values())


def test_momentum_and_energy_of_a_thrown_bar() -> None:
    """Momentum and energy of the change itself pass to rounding but for the equilibrium of the massless nodes."""
    steps = thrown((5, 25), 227.0, 8e-6, Remesh(by="new cells"))
    (at,) = [k for k, one in enumerate(steps) if one.exchanges]
    whole = 0.5 * taylor.DENSITY * np.pi * taylor.RADIUS**2 * taylor.LENGTH * 227.0**2
    assert abs(steps[at].exchanges["bar"].volume) < 1e-14
    assert abs(steps[at].exchanges["bar"].energy) < 5e-4 * whole
    assert max(abs(one.step.ledger.energy_error) for one in steps) < 1e-8 * whole
    before, after = steps[at - 1], steps[at]
    momenta = [
        float((one.model.mass @ velocity).sum(axis=0)[1])
        for one, velocity in ((before, before.step.after.velocity["bar"]), (after, after.step.before.velocity["bar"]))
    ]
    assert momenta[1] == pytest.approx(momenta[0], rel=1e-12)


@pytest.mark.slow
def test_bar_of_case_d09_with_new_cells() -> None:
    """The final length is within the tolerance of case D09; the radius is that of the same cells without new ones,
    which is beyond the tolerance of the case (7.12 +- .2 mm) like theirs.
    """
    steps = thrown((5, 25), 227.0, taylor.END, Remesh())
    x = places(steps[-1])
    assert sum(bool(one.exchanges) for one in steps) >= 3
    assert 1e3 * np.ptp(x[:, 1]) == pytest.approx(21.48, abs=0.12)
    assert 1e3 * x[:, 0].max() == pytest.approx(7.379, rel=1e-2)
    mesh = steps[-1].model.parts[0].mesh
    assert cell_quality(mesh.blocks, x).worst[0] > 0.2
    whole = 0.5 * taylor.DENSITY * np.pi * taylor.RADIUS**2 * taylor.LENGTH * 227.0**2
    assert abs(steps[-1].step.ledger.remeshing) < 1e-3 * whole


@pytest.mark.parametrize("cell", ["tri3", "tri6"])
def test_press_with_new_cells(cell: str) -> None:
    steps = pressed(Remesh(by="new cells", quality=0.5), 0.4, 20, cell)
    changes = [one for one in steps if one.exchanges]
    assert changes
    for one in changes:
        assert abs(one.exchanges["body"].volume) < 1e-12
    assert volume(steps[-1]) == pytest.approx(np.pi * HEIGHT, rel=1e-4)
    assert abs(steps[-1].step.ledger.energy_error) < 1e-12 * steps[-1].step.ledger.work_external
    kept = pressed(Remesh(quality=0.0, angle=0.0, ratio=1e9, shortened=0.0), 0.4, 20, cell)
    assert force(steps[-1]) == pytest.approx(force(kept[-1]), rel=2e-2)  # 6 x 5 cells


def test_auto_takes_new_cells_where_rezoning_is_not_enough() -> None:
    scene = press()
    state = list(sw.march(scene, until=0.1, step=0.05))[-1].march_state
    for how, same in ((Remesh(quality=0.1, angle=5.0), True), (Remesh(quality=0.95), False)):
        on = formed_scene(scene, {"body": how})
        found = replacement(on, how, state, "body")
        assert found is not None
        assert (found.mesh.n_cells == on.part("body").mesh.n_cells) is same


@pytest.mark.parametrize("generator", ["own", "mmg"])
def test_new_tetrahedra_in_a_march(generator: Generator) -> None:
    if generator == "mmg":
        pytest.importorskip("mmgpy")
    box = sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(3, 3, 3), cell="tet4").build()
    inside = np.setdiff1d(np.arange(box.n_nodes), box.nodes("surface"))
    points = np.array(box.points)
    points[inside] += [0.1, 0.05, 0.0]
    body = sw.Solid(
        mesh=replace(box, points=points),
        material=LAW,
        density=1.0,
        dilatation="corner",
        supports=tuple(sw.Fixed(on=on, components=c) for on, c in (("bottom", "z"), ("left", "x"), ("front", "y"))),
    )
    platen = sw.Tool(
        shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, 1.0), normal=(0.0, 0.0, -1.0)),
        motion=sw.bodies.Translation(velocity=(0.0, 0.0, -1.0)),
    )
    scene = sw.Scene(
        bodies={"body": body, "platen": platen},
        contacts=(sw.Contact(between=("body.top", "platen")),),
        inertia=sw.bodies.Off(),
    )
    how = Remesh(by="new cells", generator=generator, quality=0.9, angle=0.0, ratio=1e9, shortened=0.0)
    steps = list(forming_march(scene, {"body": how}, until=0.3, step=0.05))
    assert any(one.exchanges for one in steps)
    assert volume(steps[-1]) == pytest.approx(1.0, rel=1e-4)
    assert force(steps[-1]) > force(steps[0])


@pytest.mark.parametrize(
    ("by", "cell", "words"),
    [("new cells", "quad4", "new cells for quad4"), ("auto", "quad4", ""), ("rezone", "tri3", "")],
)
def test_cells_that_get_none(by: Way, cell: str, words: str) -> None:
    scene = press(cell, dilatation="mean" if cell == "quad4" else "corner")
    march = forming_march(scene, {"body": Remesh(by=by)}, until=0.01, step=0.01)
    if words:
        with pytest.raises(InputError, match=words):
            next(march)
    else:
        assert not next(march).exchanges


def test_supports_on_nodes_inside() -> None:
    scene = press()
    body = scene.bodies["body"]
    assert isinstance(body, sw.Solid)
    mesh = sw.meshes.Rectangle(size=(1.0, HEIGHT), cells=(6, 5), cell="tri3").build()
    held = mesh.with_tag("middle", lambda x: (x[:, 0] > 0.4) & (x[:, 0] < 0.6))
    bodies = {**scene.bodies, "body": replace(body, mesh=held, supports=(sw.Fixed(on="middle"),))}
    with pytest.raises(InputError, match="support on nodes inside"):
        next(forming_march(replace(scene, bodies=bodies), {"body": Remesh()}, until=0.01, step=0.01))
