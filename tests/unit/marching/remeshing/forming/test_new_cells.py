"""Marches with new cells: a bar thrown at a wall, presses, and bodies that get none."""

import sys
from dataclasses import replace

import numpy as np
import pytest
from forging import HEIGHT, KEPT, LAW, changes, continues, has_no_jumps

import softway as sw
from softway.adaptivity.rezoning.quality import cell_quality
from softway.adaptivity.rezoning.volume import volume_of
from softway.apps.verify.scenes import taylor
from softway.arrays import Array
from softway.errors import InputError
from softway.marching.remeshing.forming import forming_march
from softway.marching.remeshing.forming.formable import makes_cells, require_formable
from softway.marching.remeshing.forming.formed_scene import FormedScene, formed_scene
from softway.marching.remeshing.forming.replacement import replacement
from softway.marching.state.march_state import MarchState
from softway.meshes.remeshed.remesh import Generator, Remesh, Way
from softway.record.storage.serialisation import packed, unpacked

GIVEN: dict[str, float] = {"until": 0.45 * HEIGHT, "step": 0.45 * HEIGHT / 24}


def thrown(cells: tuple[int, int], speed: float, until: float, how: Remesh) -> list[sw.Step]:
    scene = taylor.scene(cells)
    bar = scene.bodies["bar"]
    assert isinstance(bar, sw.Solid)
    mesh = sw.meshes.Rectangle(size=(taylor.RADIUS, taylor.LENGTH), cells=cells, cell="tri3")
    new = replace(bar, mesh=mesh, dilatation="corner", remesh=how, velocity=sw.bodies.Uniform(value=(0.0, -speed)))
    scene = replace(scene, bodies={**scene.bodies, "bar": new})
    return list(sw.march(scene, until=until, step=0.78e-6, method=taylor.METHOD))


def press(
    how: Remesh | None, cell: str = "tri3", dilatation: str = "corner", cells: tuple[int, int] = (6, 5)
) -> sw.Scene:
    body = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, HEIGHT), cells=cells, cell=cell),
        material=LAW,
        density=1.0,
        section=sw.bodies.Axisymmetric(),
        dilatation=dilatation,  # type: ignore[arg-type]
        supports=(sw.Fixed(on="bottom", components="y"), sw.Fixed(on="left", components="x")),
        remesh=how,
    )
    platen = sw.Tool(
        shape=sw.obstacles.HalfSpace(point=(0.0, HEIGHT), normal=(0.0, -1.0)),
        motion=sw.bodies.Translation(velocity=(0.0, -1.0)),
    )
    rough = sw.laws.NortonHoffFriction(alpha=0.3, p=0.3, K=1.0)
    contacts = tuple(sw.Contact(between=(f"body.{tag}", "platen"), friction=rough) for tag in ("top", "right"))
    return sw.Scene(bodies={"body": body, "platen": platen}, contacts=contacts, inertia=sw.bodies.Off())


def pressed(how: Remesh, reduction: float, slabs: int, cell: str = "tri3") -> list[sw.Step]:
    until = reduction * HEIGHT
    return list(sw.march(press(how, cell), until=until, step=until / slabs))


def places(one: sw.Step) -> Array:
    displacement = np.concatenate([one.after.displacement[p.name] for p in one.model.parts])
    return np.asarray(one.model.points + displacement)


def volume(one: sw.Step) -> float:
    part = one.model.parts[0]
    return volume_of(part.mesh.blocks, part.internal.section, places(one))


def force(one: sw.Step) -> float:
    return sum(c.force_n for c in one.ledger.contacts.values())


def test_momentum_and_energy_of_a_thrown_bar() -> None:
    """Momentum and energy pass to rounding, with what the equilibrium of the massless nodes releases."""
    steps = thrown((5, 25), 227.0, 8e-6, Remesh(by="new cells"))
    (at,) = [k for k, one in enumerate(steps) if one.exchanges]
    whole = 0.5 * taylor.DENSITY * np.pi * taylor.RADIUS**2 * taylor.LENGTH * 227.0**2
    assert abs(steps[at].exchanges["bar"].volume) < 1e-14
    assert abs(steps[at].exchanges["bar"].energy) < 1e-12 * whole
    assert max(abs(one.ledger.energy_error) for one in steps) < 1e-8 * whole
    before, after = steps[at - 1], steps[at]
    momenta = [
        float((one.model.mass @ velocity).sum(axis=0)[1])
        for one, velocity in ((before, before.after.velocity["bar"]), (after, after.before.velocity["bar"]))
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
    assert abs(steps[-1].ledger.remeshing) < 1e-11 * whole


@pytest.mark.slow
@pytest.mark.parametrize("cell", ["tri3", "tri6"])
def test_press_with_new_cells(cell: str) -> None:
    steps = pressed(Remesh(by="new cells", quality=0.5), 0.4, 20, cell)
    changes = [one for one in steps if one.exchanges]
    assert changes
    for one in changes:
        assert abs(one.exchanges["body"].volume) < 1e-12
    assert volume(steps[-1]) == pytest.approx(np.pi * HEIGHT, rel=1e-4)
    assert abs(steps[-1].ledger.energy_error) < 1e-12 * steps[-1].ledger.work_external
    kept = pressed(KEPT, 0.4, 20, cell)
    assert force(steps[-1]) == pytest.approx(force(kept[-1]), rel=2e-2)  # 6 x 5 cells


def test_auto_takes_new_cells_where_rezoning_is_not_enough() -> None:
    state = list(sw.march(press(None), until=0.1, step=0.05))[-1].march_state
    for how, same in ((Remesh(quality=0.1, angle=5.0), True), (Remesh(quality=0.95), False)):
        on = formed_scene(sw.build(press(how)))
        found = replacement(on, how, state, "body")
        assert found is not None
        assert (found.mesh.n_cells == on.part("body").mesh.n_cells) is same


@pytest.mark.slow
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
        remesh=Remesh(by="new cells", generator=generator, quality=0.9, angle=0.0, ratio=1e9, shortened=0.0),
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
    steps = list(sw.march(scene, until=0.3, step=0.05))
    assert any(one.exchanges for one in steps)
    assert volume(steps[-1]) == pytest.approx(1.0, rel=1e-4)
    assert force(steps[-1]) > force(steps[0])


@pytest.mark.parametrize(
    ("by", "cell", "words"),
    [("new cells", "quad4", "new cells for quad4"), ("auto", "quad4", ""), ("rezone", "tri3", "")],
)
def test_cells_that_get_none(by: Way, cell: str, words: str) -> None:
    scene = press(Remesh(by=by), cell, dilatation="mean" if cell == "quad4" else "corner")
    if words:
        with pytest.raises(InputError, match=words):
            sw.march(scene, until=0.01, step=0.01)
    else:
        assert not next(sw.march(scene, until=0.01, step=0.01)).exchanges


@pytest.mark.parametrize("by", ["new cells", "auto"])
def test_supports_on_nodes_inside(by: Way) -> None:
    """New cells are refused, and ``auto`` only rezones."""
    scene = press(Remesh(by=by))
    body = scene.bodies["body"]
    assert isinstance(body, sw.Solid)
    mesh = sw.meshes.Rectangle(size=(1.0, HEIGHT), cells=(6, 5), cell="tri3").build()
    held = mesh.with_tag("middle", lambda x: (x[:, 0] > 0.4) & (x[:, 0] < 0.6))
    bodies = {**scene.bodies, "body": (solid := replace(body, mesh=held, supports=(sw.Fixed(on="middle"),)))}
    model = sw.build(replace(scene, bodies=bodies))
    if by == "auto":
        require_formable(model, "body", sw.FixedPoint())
        assert not makes_cells(Remesh(), held, solid)
        return
    with pytest.raises(InputError, match=r"bodies\.body\.remesh\.by: new cells with a support on nodes inside"):
        require_formable(model, "body", sw.FixedPoint())


HOW = Remesh(by="new cells", quality=0.6)
SCENE = press(HOW)


@pytest.fixture(scope="module")
def whole() -> list[sw.Step]:
    return list(sw.march(SCENE, **GIVEN))


@pytest.fixture(scope="module")
def kept() -> sw.Step:
    """Last slab on the mesh that stays."""
    return list(sw.march(press(KEPT), **GIVEN))[-1]


@pytest.mark.slow
@pytest.mark.parametrize("after", [-1, 0, 1])
def test_the_same_bits(whole: list[sw.Step], after: int) -> None:
    """From the stored states before, at and after the second change."""
    assert len(changes(whole)) >= 2
    slabs = changes(whole)[1] + after
    continues(SCENE, whole, slabs, **GIVEN)


def test_the_matter_has_no_jumps_on_other_cells(whole: list[sw.Step]) -> None:
    assert len({one.model.parts[0].mesh.n_cells for one in whole}) > 1
    has_no_jumps(whole, 1e-13)


def matter_errors(whole: list[sw.Step], kept: sw.Step) -> list[float]:
    """Mean distances, over the stroke, of matter from where it is on a mesh that stays, and of its origin from where it
    was.
    """
    mesh = whole[-1].model.remeshed["body"]
    gone, back = mesh.matter @ places(whole[-1]) - places(kept), mesh.matter @ mesh.origin - whole[0].model.points
    return [float(np.linalg.norm(way, axis=1).mean()) / GIVEN["until"] for way in (gone, back)]


@pytest.mark.slow
def test_the_matter_converges_on_other_cells(whole: list[sw.Step], kept: sw.Step) -> None:
    """On cells of half the size the errors are less than half, those of one order."""
    fine, finely_kept = (list(sw.march(press(how, cells=(12, 10)), **GIVEN)) for how in (HOW, KEPT))
    errors = matter_errors(whole, kept), matter_errors(fine, finely_kept[-1])
    assert len(changes(fine)) >= 2
    assert errors[1][0] < 0.5 * errors[0][0] and errors[1][1] < 0.5 * errors[0][1]


@pytest.mark.slow
def test_a_failed_change_waits_until_the_cells_are_a_fifth_worse(
    kept: sw.Step, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without a fit, the number of tries is that of the fifths that the worst cell loses; states are resumed alike."""
    tried: list[float] = []

    def none(on: FormedScene, how: Remesh, now: MarchState, name: str) -> None:
        tried.append(now.state.time)

    monkeypatch.setattr(forming_march, "replacement", none)
    steps = list(sw.march(SCENE, **GIVEN))
    assert np.array_equal(places(steps[-1]), places(kept))
    first = next(k for k, one in enumerate(steps) if one.after.time >= tried[0])
    assert 1 <= len(tried) < (len(steps) - first) / 2
    whole = tried.copy()
    tried.clear()
    rest = list(sw.march(SCENE, state=unpacked(*packed(steps[first + 1].march_state)), **GIVEN))
    assert tried == whole[1:] and np.array_equal(places(rest[-1]), places(steps[-1]))


def test_mmg_that_is_not_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Told before the march, not at the first change."""
    monkeypatch.setitem(sys.modules, "mmgpy", None)
    with pytest.raises(InputError, match=r"bodies\.body\.remesh\.generator: mmgpy"):
        sw.march(press(Remesh(generator="mmg")), until=0.01, step=0.01)
