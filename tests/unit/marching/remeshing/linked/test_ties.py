"""Ties of solids that adapt: patch test, waves through a tie, ties that break."""

from dataclasses import replace

import numpy as np
import pytest
from adapting import adapting, adaptive_march
from passing import finest, keeps_its_balances

import softway as sw
from softway.adaptivity.marking.even_surface import even
from softway.errors import InputError
from softway.marching.remeshing.adapted_scene import adapted_scene
from softway.marching.remeshing.carried.carrying import carried_over
from softway.marching.start.preparation import prepare
from softway.meshes.adaptive.adapt import Adapt
from softway.meshes.adaptive.refinement import AdaptedMesh, refined
from softway.meshes.generators.shapes import box, disc, rectangle
from softway.meshes.mesh import Mesh

ADAPT = Adapt(levels=4, tolerance=1.0, buffer=2, contact_cells=1)
CASES = [
    (("tri3", 4), ("tri3", 4)),
    (("tri3", 4), ("tri3", 3)),
    (("quad4", 4), ("tri3", 3)),
    (("quad9", 3), ("quad4", 4)),
]
IDS = ["matching", "tri3", "quad4-tri3", "quad9-quad4"]


def stacked(*meshes: tuple[str, int], law: object = sw.NeoHookean(E=1.0, nu=0.3)) -> dict[str, sw.Solid]:
    """Square blocks of side 1, one on the other."""
    names = ("low", "high")
    made = [rectangle((1.0, 1.0), (n, n), cell=cell, origin=(0.0, float(k))) for k, (cell, n) in enumerate(meshes)]
    return {name: sw.Solid(mesh=mesh, material=law, density=1.0) for name, mesh in zip(names, made, strict=True)}


TIE = sw.Tie(between=("low.top", "high.bottom"))
PUSH = sw.bodies.Ramp(times=(0.0, 0.1, 0.2), factors=(0.0, 1.0, 0.0))


def pushed(*meshes: tuple[str, int], tie: sw.Tie = TIE, force: tuple[float, float] = (0.01, 0.05)) -> sw.Scene:
    """Two blocks that a tie joins, pushed from below for a short time."""
    loads = (sw.Traction(on="low.bottom", value=force, ramp=PUSH),)
    return sw.Scene(bodies=stacked(*meshes), ties=(tie,), loads=loads)


def strained(bodies: dict[str, sw.Solid]) -> sw.Scene:
    """Solids in one uniform strain, with one uniform gradient of the velocity."""
    d = next(iter(bodies.values())).mesh.dim
    rng = np.random.default_rng(1)
    strain, rate = 0.01 * rng.normal(size=(2, d, d))
    moving = {
        name: replace(
            body,
            displacement=sw.bodies.Affine(value=(0.0,) * d, gradient=tuple(map(tuple, strain))),
            velocity=sw.bodies.Affine(value=(0.1,) * d, gradient=tuple(map(tuple, rate))),
        )
        for name, body in bodies.items()
    }
    return sw.Scene(bodies=moving, ties=(TIE,))


@pytest.mark.parametrize(
    "meshes",
    [
        *[[rectangle((1.0, 1.0), (n, n), cell=c, origin=(0.0, float(k))) for k, (c, n) in enumerate(m)] for m in CASES],
        [
            box((1.0, 1.0, 1.0), (n, n, 2), cell=c, origin=(0.0, 0.0, z))
            for c, n, z in (("hex8", 2, 0.0), ("tet4", 3, 1.0))
        ],
    ],
    ids=[*IDS, "hex8-tet4"],
)
def test_a_uniform_stress_passes_a_tie_whatever_the_meshes(meshes: list[Mesh]) -> None:
    law = sw.LinearElastic(E=1.0, nu=0.3)
    bodies = {
        name: sw.Solid(mesh=mesh, material=law, density=1.0) for name, mesh in zip(("low", "high"), meshes, strict=True)
    }
    scene = strained(bodies)
    on = adapted_scene(sw.build(adapting(scene, {"low": ADAPT, "high": ADAPT})))
    settings = next(sw.march(scene, until=0.01, step=0.01)).march_state.settings
    now = prepare(on.model, settings).march_state
    rng = np.random.default_rng(0)
    for _ in range(3):
        new = on.on({name: varied(mesh, rng, name) for name, mesh in on.meshes.items()})
        now, passed = carried_over(on, new, now)
        on, start = new, now.state.start
        for found, exact in ((start.displacement, on.model.displacement), (start.velocity, on.model.velocity)):
            assert found == pytest.approx(exact, abs=1e-12 * float(abs(exact).max()))
        assert set(passed) == {"low", "high"}
        stress = on.model.stress("high", start.displacement[on.model.parts[1].nodes])
        assert stress == pytest.approx(np.broadcast_to(stress[0], stress.shape), abs=1e-11 * float(abs(stress).max()))
    assert abs(now.account.remeshing) < 1e-12 * now.account.energy_start


def varied(mesh: AdaptedMesh, rng: np.random.Generator, name: str) -> AdaptedMesh:
    """A mesh of another refinement, even along the tie."""
    levels = max(mesh.step, 2) * rng.integers(0, 2, mesh.base.n_cells)
    return even(refined(mesh.base, levels), [TIE.tags[TIE.bodies.index(name)]])


@pytest.mark.slow
@pytest.mark.parametrize("names", [("low", "high"), ("low",)], ids=["both", "one"])
@pytest.mark.parametrize("meshes", CASES, ids=IDS)
def test_a_wave_passes_a_tie_as_on_the_finest_meshes(
    meshes: tuple[tuple[str, int], tuple[str, int]], names: tuple[str, ...]
) -> None:
    scene = pushed(*meshes)
    adapt = replace(ADAPT, tolerance=0.15)
    steps = list(adaptive_march(scene, dict.fromkeys(names, adapt), until=1.5, step=0.02))
    energy = max(taken.ledger.energy_kinetic + taken.ledger.energy_strain for taken in steps)
    assert keeps_its_balances(steps) > 1
    assert abs(steps[-1].ledger.remeshing) < 1e-9 * energy
    fine = list(sw.march(finest(scene, 4, *names), until=1.5, step=0.02))
    for one, other in zip(steps, fine, strict=True):
        momenta = [moving(taken, "high") for taken in (one, other)]
        assert momenta[0] == pytest.approx(momenta[1], abs=0.015 * MOST)


MOST = 0.005
"""Momentum that the push gives [kg m/s]."""


def moving(step: sw.Step, name: str) -> np.ndarray:
    """Momentum of a solid."""
    model, velocity = step.model, step.model.join(step.after.velocity)
    part = next(part for part in model.parts if part.name == name)
    return np.asarray((model.mass @ velocity)[part.nodes].sum(axis=0))


GLUE = sw.BilinearCohesive(strength=0.02, energy=1e-4, stiffness=200.0)


@pytest.mark.parametrize(
    ("meshes", "touching"),
    [*((case, False) for case in CASES[:3]), pytest.param(CASES[1], True, marks=pytest.mark.slow)],
    ids=[*IDS[:3], "with contact"],
)
def test_a_tie_that_breaks_keeps_its_damage(meshes: tuple[tuple[str, int], tuple[str, int]], touching: bool) -> None:
    scene = pushed(*meshes, tie=replace(TIE, breaks=GLUE), force=(0.0, 0.0))
    loads = (sw.Traction(on="low.left", value=(0.0, -0.08), ramp=PUSH),)
    contacts = (sw.Contact(between=TIE.between),) if touching else ()
    scene = replace(scene, loads=loads, contacts=contacts)
    steps = list(adaptive_march(scene, {"low": ADAPT, "high": ADAPT}, until=0.8, step=0.02))
    energy = max(taken.ledger.energy_kinetic + taken.ledger.energy_strain for taken in steps)
    assert keeps_its_balances(steps) > 2
    assert abs(steps[-1].ledger.remeshing) < 1e-9 * energy
    *_, fine = sw.march(finest(scene, 4, "low", "high"), until=0.8, step=0.02)
    lost = [taken.ledger.dissipation for taken in (steps[-1], fine)]
    assert 0.1 * GLUE.energy < lost[1] < 0.9 * GLUE.energy
    assert lost[0] == pytest.approx(lost[1], rel=0.02)
    assert torn(steps[-1]) == pytest.approx(torn(fine), abs=0.01)


def torn(step: sw.Step) -> float:
    """Share of the surface of the tie that is damaged, by its damage."""
    model = step.model
    (tie,) = model.bonds[0].ties
    damage = model.join(step.after.fields["damage"])[tie.jump.node, 0]
    return float(tie.jump.area @ damage / tie.jump.area.sum())


@pytest.mark.parametrize("breaks", [None, GLUE], ids=["for good", "breaks"])
def test_a_resumed_march_has_the_same_bits(breaks: sw.BilinearCohesive | None) -> None:
    scene = adapting(pushed(*CASES[1], tie=replace(TIE, breaks=breaks)), {"low": ADAPT, "high": ADAPT})
    whole = list(sw.march(scene, until=0.8, step=0.02))
    rest = list(sw.march(scene, until=0.8, step=0.02, state=whole[17].march_state))
    assert sum(bool(taken.transfers) for taken in rest) > 1
    for one, other in zip(whole[18:], rest, strict=True):
        for name in ("low", "high"):
            assert np.array_equal(one.after.displacement[name], other.after.displacement[name])
            assert np.array_equal(one.after.velocity[name], other.after.velocity[name])


@pytest.mark.parametrize("around", [24, 40])
def test_a_disc_glued_into_a_ring(around: int) -> None:
    turning = sw.bodies.Affine(value=(0.0, 0.0), gradient=((0.05, 0.02), (0.0, -0.03)))
    bodies = {
        name: sw.Solid(mesh=mesh, material=sw.NeoHookean(E=1.0, nu=0.3), density=1.0, velocity=turning)
        for name, mesh in (("disc", disc(0.5, 6, cell="tri3")), ("ring", ring(0.5, 1.0, 4, around)))
    }
    scene = sw.Scene(bodies=bodies, ties=(sw.Tie(between=("disc.boundary", "ring.inner"), tolerance=0.08),))
    steps = list(adaptive_march(scene, {"disc": ADAPT, "ring": ADAPT}, until=0.8, step=0.02))
    assert keeps_its_balances(steps) > 4
    assert abs(steps[-1].ledger.remeshing) < 1e-12 * steps[0].ledger.energy_kinetic


def ring(inner: float, outer: float, layers: int, around: int) -> Mesh:
    """Ring of triangles, whose nodes are not those of a disc."""
    angle = 2.0 * np.pi * (np.arange(around) + 0.37) / around
    radii = np.linspace(inner, outer, layers + 1)
    points = (radii[:, None, None] * np.column_stack([np.cos(angle), np.sin(angle)])).reshape(-1, 2)
    k = around * np.arange(layers)[:, None] + np.arange(around)
    n = around * np.arange(layers)[:, None] + (np.arange(around) + 1) % around
    cells = np.concatenate([np.stack([k, k + around, n + around], -1), np.stack([k, n + around, n], -1)])
    mesh = Mesh(points=points, blocks={"tri3": cells.reshape(-1, 3)})
    return mesh.with_tag("inner", lambda x: np.isclose(np.hypot(*x.T), inner))


def test_solids_that_adapt_are_not_tied_to_cells_that_cannot() -> None:
    bodies = stacked(("tri3", 2), ("tri3", 2))
    mixed = Mesh(
        points=np.array([[0.0, 1.0], [1.0, 1.0], [2.0, 1.0], [0.0, 2.0], [1.0, 2.0]]),
        blocks={"quad4": np.array([[0, 1, 4, 3]]), "tri3": np.array([[1, 2, 4]])},
    ).with_tag("bottom", lambda x: x[:, 1] == 1.0)
    bodies["high"] = replace(bodies["high"], mesh=mixed)
    scene = sw.Scene(bodies=bodies, ties=(TIE,))
    with pytest.raises(InputError) as refusal:
        next(adaptive_march(scene, {"low": ADAPT}, until=0.1, step=0.01))
    assert refusal.value.where == "ties[0].between"
    assert refusal.value.remedy
