"""March over ranks of two bodies, with friction, histories and step control: the bits of any number of ranks."""

from dataclasses import replace

import numpy as np
import pytest
from over_ranks import GIVEN, over, require_equal, steps, told

import softway as sw
from softway.laws.plasticity.rate_dependence import Perzyna
from softway.marching.results.finding import FLAT_CELL, INVERTED
from softway.model.build import build
from softway.model.model import Model
from softway.ranks.alone import Alone

SOFT = sw.NeoHookean(E=1e4, nu=0.3)
STIFF = sw.NeoHookean(E=3e4, nu=0.3)
PLAIN = sw.meshes.Rectangle(size=(1.0, 0.6), cells=(3, 2), origin=(0.1, 0.62))
HALVES = PLAIN.build().with_region("core", lambda x: x[:, 0] < 0.4).with_region("skin", lambda x: x[:, 0] > 0.4)
FLOWING = {"E": 1e4, "nu": 0.3, "yield_stress": 40.0}


def thrown(
    material: object = SOFT,
    mu: float = 0.0,
    method: object = None,
    mesh: object = PLAIN,
    between: str | None = None,
    **more: object,
) -> Model:
    """Block thrown aslant at a bed, which stands above an inclined floor."""
    block = sw.Solid(
        mesh=mesh,
        material=material,
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.5, -5.0)),
        **more,
    )
    bed = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.3, 0.6), cells=(4, 2)), material=sw.NeoHookean(E=2e4, nu=0.3), density=1.0
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.01), normal=(0.05, 1.0)))
    friction = sw.Coulomb(mu=mu) if mu else sw.laws.Frictionless()
    contacts: tuple[sw.Contact, ...] = (
        sw.Contact(between=("block.bottom", "bed.top"), friction=friction, method=method),
        sw.Contact(between=("bed.bottom", "floor"), friction=friction),
    )
    if between is not None:
        contacts = (sw.Contact(between=between, friction=friction),)
    return build(sw.Scene(bodies={"block": block, "bed": bed, "floor": floor}, contacts=contacts))


CASES = {
    "mortar": (thrown, {}),
    "nodes on facets": (thrown, {"method": sw.contact.NodeToSurface()}),
    "friction": (thrown, {"mu": 0.2}),
    "plastic, with friction": (thrown, {"material": sw.J2(**FLOWING), "mu": 0.2}),
    "viscoplastic": (thrown, {"material": sw.J2(**FLOWING, flow=Perzyna(drag=30.0, reference=10.0, exponent=1.0))}),
    "mean dilatation": (thrown, {"material": sw.J2(**FLOWING), "dilatation": "mean"}),
    "several materials": (thrown, {"material": {"core": SOFT, "skin": STIFF}, "mesh": HALVES}),
    "several materials, one plastic": (
        thrown,
        {"material": {"core": sw.J2(**FLOWING), "skin": STIFF}, "mesh": HALVES, "mu": 0.2},
    ),
    "each with each": (thrown, {"between": "all"}),
    "each with each, with friction": (thrown, {"between": "all", "mu": 0.2}),
    "a law without kernels": (thrown, {"material": sw.laws.MooneyRivlin(c10=4e3, c01=1e3, bulk=4e4)}),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_two_bodies_have_the_same_bits_on_any_number_of_ranks_and_move_as_on_one_process(name: str) -> None:
    made, given = CASES[name]
    model = made(**given)
    ours = require_equal(model)
    theirs = list(sw.march(model, until=GIVEN.until, step=GIVEN.step, method=GIVEN.method))
    assert {e.kind for step in ours for e in step.events} >= {"touch"}
    for mine, other in zip(ours, theirs, strict=True):
        assert abs(mine.certificate.energy_error) < 1e-11 * 7.5
        assert mine.certificate.momentum_error < 1e-11 * 3.0
        for body in ("block", "bed"):
            np.testing.assert_allclose(
                mine.after.displacement[body], other.after.displacement[body], atol=1e-12, rtol=0.0
            )
            np.testing.assert_allclose(mine.after.velocity[body], other.after.velocity[body], atol=1e-9, rtol=0.0)


def test_events_name_the_nodes_of_their_bodies() -> None:
    model = thrown(method=sw.contact.NodeToSurface(), mu=0.2)
    theirs = [e for s in sw.march(model, until=GIVEN.until, step=GIVEN.step, method=GIVEN.method) for e in s.events]
    found = [(e.kind, e.contact, e.node) for s in over(2, model) for e in s.events]
    assert found == [(e.kind, e.contact, e.node) for e in theirs]


def test_a_plastic_block_flows_and_its_history_is_whole() -> None:
    model = thrown(material=sw.J2(**FLOWING))
    last = over(3, model)[-1]
    state = last.after.memory["block"]
    (cells,) = model.parts[0].mesh.blocks.values()
    assert state.law["plastic_strain"].shape == (4 * len(cells),)
    assert float(state.law["plastic_strain"].max()) > 1e-3
    np.testing.assert_array_equal(state.displacement, last.after.displacement["block"])
    energy = model.parts[0].internal.sampling.volume @ (state.stored + state.dissipated)
    assert last.ledger.energy_strain > 0.0
    assert float(energy) > 0.1


def test_the_histories_of_several_materials_are_those_of_one_process() -> None:
    """Stress, plastic strain and stored energy of each region, and the energy of the elastic one in the state."""
    model = thrown(material={"core": sw.J2(**FLOWING), "skin": STIFF}, mesh=HALVES)
    ours = over(3, model)[-1].after.memory["block"]
    *_, last = sw.march(model, until=GIVEN.until, step=GIVEN.step, method=GIVEN.method)
    theirs = last.after.memory["block"]
    assert list(ours.regions) == list(theirs.regions) == ["core"]
    mine, other = ours.regions["core"], theirs.regions["core"]
    assert float(mine.law["plastic_strain"].max()) > 1e-3
    assert mine.law["plastic_strain"] == pytest.approx(other.law["plastic_strain"], abs=1e-12)
    assert mine.stress == pytest.approx(other.stress, abs=1e-9)
    assert mine.displacement == pytest.approx(other.displacement, abs=1e-12)
    assert ours.displacement == pytest.approx(theirs.displacement, abs=1e-12)
    assert ours.elastic == pytest.approx(theirs.elastic, abs=1e-11)
    assert ours.elastic > 1e-3


@pytest.mark.parametrize("tolerance", [None, 1e-3])
def test_slabs_whose_length_is_chosen_have_the_same_bits(tolerance: float | None) -> None:
    require_equal(thrown(), replace(GIVEN, step="auto", tolerance=tolerance))


def test_a_cell_that_folds_is_told_as_on_one_process() -> None:
    """A cell belongs to one rank; rank 0 tells it with the numbers of the whole body."""
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(5, 5)),
        material=sw.J2(E=1e4, nu=0.3, yield_stress=10.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0, 40.0)),
        dilatation="mean",
    )
    punch = sw.Tool(shape=sw.obstacles.Sphere(centre=(0.45, 1.301), radius=0.3))
    model = build(sw.Scene(bodies={"block": block, "punch": punch}, contacts=(sw.Contact(between=("block", "punch")),)))
    given = replace(GIVEN, until=0.005)
    theirs = [e for s in sw.march(model, until=given.until, step=given.step, method=GIVEN.method) for e in s.events]
    one, three = ([e for s in over(size, model, given) for e in s.events if e.finding] for size in (1, 3))
    assert {e.kind for e in one} & {FLAT_CELL, INVERTED}
    assert [(e.node, e.time, e.finding) for e in three] == [(e.node, e.time, e.finding) for e in one]
    assert [(e.kind, e.node) for e in one] == [(e.kind, e.node) for e in theirs if e.finding]


@pytest.mark.slow
def test_three_blocks_in_space_each_of_which_may_touch_each_move_as_on_one_process() -> None:
    """Rows of edges that cross are redundant; no iterate of conjugate gradients may close dependent ones."""

    def block(at: tuple[float, float, float], velocity: tuple[float, float, float]) -> sw.Solid:
        mesh = sw.meshes.Box(size=(1.0, 0.8, 0.6), cells=(3, 3, 3), origin=at)
        return sw.Solid(mesh=mesh, material=SOFT, density=1.0, velocity=sw.bodies.Uniform(value=velocity))

    bodies = {
        "bed": block((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
        "block": block((0.13, 0.17, 0.605), (0.5, 0.0, -5.0)),
        "side": block((1.145, 0.3, 0.05), (-5.0, 0.0, 0.0)),
    }
    model = build(sw.Scene(bodies=bodies, contacts=(sw.Contact(between="all"),)))
    given = replace(GIVEN, until=0.003)
    ours, theirs = steps(Alone(), model, given), list(sw.march(model, until=0.003, step=5e-4))
    assert [told(s) for s in over(2, model, given)] == [told(s) for s in ours]
    plain = list(sw.march(model, until=0.003, step=5e-4, method=sw.FixedPoint(operator=sw.solve.ConjugateGradients())))
    assert {e.kind for step in ours for e in step.events} >= {"touch"}
    for mine, one, other in zip(ours, plain, theirs, strict=True):
        assert abs(mine.certificate.energy_error) < 1e-11 * 20.0
        for body in bodies:
            assert mine.after.displacement[body] == pytest.approx(other.after.displacement[body], abs=1e-12)
            assert mine.after.velocity[body] == pytest.approx(other.after.velocity[body], abs=1e-9)
            assert one.after.velocity[body] == pytest.approx(other.after.velocity[body], abs=1e-9)
