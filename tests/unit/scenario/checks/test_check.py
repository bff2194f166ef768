"""What the check finds without computing, and the scales that it derives."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import softway.scenario.scenario as model
from softway.bodies.inertia.mass_matrix import Lumped
from softway.bodies.internal_force.slab_average import EnergyMomentum
from softway.bodies.setup.initial_fields import Uniform
from softway.bodies.setup.loads import Gravity, Traction
from softway.bodies.setup.placement import Placement
from softway.bodies.solid import Driven, Fixed, Solid, Tool
from softway.contact.contact import Contact
from softway.contact.impact_rule import Impulse
from softway.errors import InputError
from softway.laws.bulk import LinearElastic
from softway.meshes.generators.recipes import Disc, Interval, Rectangle
from softway.model.time_weight import Momentum
from softway.obstacles.half_space import HalfSpace
from softway.scenario.checks.check import check
from softway.scenario.files import dumps, load, loads
from softway.scenario.hints.units_text import Units
from softway.scenario.text.templates import templates
from softway.solve.methods.central_difference import Explicit
from softway.solve.stable_step import stable_step

UNITS = Units.standard()
FOLDER = Path(__file__).parents[4] / "scenarios"
FILES = sorted(FOLDER.glob("*.toml"))
BAR = load(FOLDER / "paper_bar.toml", units=UNITS)


def changed(*changes, of="paper_bar.toml"):
    return load(FOLDER / of, changes, units=UNITS)


@pytest.mark.parametrize("file", FILES, ids=[f.stem for f in FILES])
def test_every_scenario_survives_writing(file):
    """That it is right, tests/scenarios/test_notes.py finds."""
    scenario = load(file, units=UNITS)
    assert loads(dumps(scenario), units=UNITS) == scenario


@pytest.mark.parametrize("name", [n for n in templates() if n != "part"])
def test_templates_are_right(name):
    assert check(loads(templates()[name], units=UNITS)).slabs > 10


def test_the_template_for_a_part_asks_for_its_file():
    with pytest.raises(InputError, match="no such file") as found:
        check(loads(templates()["part"], units=UNITS))
    assert found.value.where == "bodies.part.mesh.path"


def test_scales_of_the_first_example():
    checked = check(BAR)
    bar, wall = checked.bodies["bar"], checked.contacts["wall"]
    assert (bar.nodes, bar.cells, bar.dofs, bar.edge, bar.length) == (3, 2, 3, 0.5, 1.0)
    assert (bar.wave_speed, bar.transit) == pytest.approx((1.0, 1.0))
    assert (wall.nodes, wall.approach, wall.duration) == pytest.approx((1, 1.0, 2.0))
    assert wall.gap == pytest.approx(0.3)
    assert (checked.step, checked.slabs) == (0.01, 400)


def test_the_approach_is_relative_to_a_tool_that_moves():
    away, towards = (check(changed(f'bodies.wall.motion={{kind="Translation", velocity={v}}}')) for v in (0.25, -0.25))
    assert away.contacts["wall"].approach == pytest.approx(0.75)
    assert towards.contacts["wall"].approach == pytest.approx(1.25)


def test_the_softer_body_determines_how_long_a_contact_lasts():
    """A stiff head on a soft mat: waves run through the head many times before that of the mat returns."""
    head = square(mesh=Rectangle(size=(1.0, 0.1), cells=(4, 1)), place=Placement(bottom=0.01))
    mat = square(mesh=Rectangle(size=(1.0, 0.5), cells=(4, 2), origin=(0.0, -0.5)))
    durations = []
    for law in (LinearElastic(E=1e4, nu=0.3), mat.material, LinearElastic(E=1e-4, nu=0.3)):
        contact = Contact(between=("head", "mat.top"), name="c", timing=Impulse())
        found = check(scenario(bodies={"head": replace(head, material=law), "mat": mat}, contacts=(contact,)))
        speeds = {name: body.wave_speed for name, body in found.bodies.items()}
        durations.append(found.contacts["c"].duration)
    assert durations == pytest.approx([1.0 / speeds["mat"], 0.2 / speeds["mat"], 0.2 / speeds["head"]])


@pytest.mark.slow
def test_the_scales_of_a_contact_are_those_of_the_nearest_place():
    """A wheel above a plate: its flanks, which face the plate askew, do not count.  Gaps are along the normals of its
    sixteen facets.
    """
    wheel = square(mesh=Disc(radius=0.5, cells=8), velocity=Uniform(value=(0.3, -0.1)), place=Placement(bottom=0.01))
    plate = square(mesh=Rectangle(size=(4.0, 1.0), cells=(4, 1), origin=(-2.0, -1.0)))
    bodies = {"wheel": wheel, "plate": plate}
    found = check(scenario(bodies=bodies, contacts=(Contact(between=("wheel", "plate.top"), name="c"),)))
    speed, lean = found.bodies["wheel"].wave_speed, 1.0 / np.cos(np.pi / 16.0)
    told = found.contacts["c"]
    assert (told.gap, told.approach, told.duration) == pytest.approx((0.01 * lean, 0.1 * lean, 2.0 / speed), rel=1e-9)


def test_a_body_without_inertia_wants_supports():
    with pytest.raises(InputError, match="no body without inertia") as found:
        check(changed('inertia={kind="Off"}'))
    assert found.value.where == "bodies.bar.supports"


@pytest.mark.parametrize("mass", ["Consistent", "Lumped"])
def test_the_stable_step_of_equal_bars_is_near_the_exact_one(mass):
    """The infinite mesh has the estimated frequency; a mesh of ten elements with free ends reaches it."""
    checked = check(changed(f"bodies.bar.mass={mass}", "bodies.bar.mesh.cells=10", "contacts=[]"))
    exact = stable_step(checked.model, np.zeros((11, 1)), Momentum())
    assert checked.bodies["bar"].stable_step == pytest.approx(exact, rel=1e-9)


def test_the_automatic_step_divides_the_time_and_respects_the_weight():
    wave = check(changed("time.step=auto", "time.end=4.1"))
    assert wave.step * wave.slabs == pytest.approx(4.1)
    assert wave.step <= 0.5
    bounded = check(changed("time.step=auto", "time.weight=Momentum", "contacts=[]"))
    assert bounded.step <= 0.9 * 0.5 * (1 + 1e-9)


def test_gravity_needs_a_vector_of_the_space():
    with pytest.raises(InputError) as found:
        check(replace(BAR, loads=(Gravity(acceleration=(0.0, -9.81)),)))
    assert found.value.where == "loads[0].acceleration"


def square(**changes):
    solid = Solid(mesh=Rectangle(size=(1.0, 1.0), cells=(2, 2)), material=LinearElastic(E=1.0), density=1.0)
    return replace(solid, **changes)


def scenario(**changes):
    given = {"bodies": {"block": square()}, "time": model.Time(end=1.0)}
    return model.Scenario(**{**given, **changes})


FLOOR = Tool(shape=HalfSpace(point=(0.0, -1.0), normal=(0.0, 1.0)))
BOTH = {"block": square(), "floor": FLOOR}
WRONG = [
    (scenario(bodies={"floor": FLOOR}), "bodies", "no Solid"),
    (scenario(bodies={"block": square(density=-1.0)}), "bodies.block.density", "-1 kg/m.3 is not positive"),
    (scenario(bodies={"block": square(density=0.0)}), "bodies.block.density", "not positive"),
    (
        scenario(bodies={"bar": replace(square(), mesh=Interval(length=1.0, cells=1)), "block": square()}),
        "bodies.block.mesh",
        "2D together with 'bar' in 1D",
    ),
    (
        scenario(bodies={"block": square(), "wall": Tool(shape=HalfSpace(point=1.0, normal=-1.0))}),
        "bodies.wall.shape",
        "HalfSpace in 1D together with 'block' in 2D",
    ),
    (scenario(loads=(Traction(on="blok.left", value=(1.0, 0.0)),)), "loads[0].on", "'blok'.*did you mean 'block'"),
    (scenario(loads=(Traction(on="block.lift", value=(1.0, 0.0)),)), "loads[0].on", "'lift' matches nothing"),
    (scenario(loads=(Traction(on="block.left", value=1.0),)), "loads[0].value", "2 components"),
    (
        scenario(bodies=BOTH, contacts=(Contact(between=("blok.bottom", "floor")),)),
        "contacts[0].between",
        "'blok'.*did you mean 'block'",
    ),
    (
        scenario(bodies=BOTH, contacts=(Contact(between=("floor", "block")),)),
        "contacts[0].between",
        "'floor' is a Tool",
    ),
    (
        scenario(bodies={"a": square(), "block": square()}, contacts=(Contact(between=("a.top", "block.below")),)),
        "contacts[0].between",
        "'below' matches nothing",
    ),
    (
        scenario(bodies=BOTH, contacts=(Contact(between=("block.below", "floor")),)),
        "contacts[0].between",
        "'below' matches nothing",
    ),
    (
        scenario(
            bodies=BOTH,
            contacts=(
                Contact(between=("block.bottom", "floor")),
                Contact(between=("block.top", "floor"), timing=Impulse()),
            ),
        ),
        "contacts[1].timing",
        "Impulse.* differs from Energy",
    ),
    (
        scenario(bodies=BOTH, contacts=(Contact(between=("block.bottom", "floor")),) * 2),
        "contacts[1].name",
        "is already in use",
    ),
    (scenario(time=model.Time(end=1.0, step=2.0)), "time.step", "longer than time.end"),
]


@pytest.mark.parametrize(("wrong", "where", "problem"), WRONG, ids=[f"{w[1]}: {w[2]}" for w in WRONG])
def test_what_is_refused(wrong, where, problem):
    with pytest.raises(InputError, match=f"(?s){problem}") as found:
        check(wrong)
    assert found.value.where == where
    assert found.value.remedy


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ("bodies.bar.supports=[{kind='Fixed', on='left', components='y'}]", "bodies.bar.supports[0].components"),
        ("bodies.bar.supports=[{kind='Fixed', on='left', components=''}]", "bodies.bar.supports[0].components"),
        ("bodies.bar.supports=[{kind='Fixed', on='lft'}]", "bodies.bar.supports[0].on"),
        ("bodies.bar.section=Volume", "bodies.bar.section"),
        ("bodies.bar.mesh.length=-1", "bodies.bar.mesh.length"),
        ("bodies.bar.place.translation=[1, 2]", "bodies.bar.place.translation"),
        ("bodies.bar.velocity=[1, 2]", "bodies.bar.velocity.value"),
        ("bodies.bar.velocity={kind='OnTag', tag='end', value=1}", "bodies.bar.velocity.tag"),
        ("output.probes[0].of=wall", "output.probes[0].of"),
        ("output.probes[0].tag=end", "output.probes[0].tag"),
        ("output.probes[0].component=y", "output.probes[0].component"),
        ("output.probes[1].name=rear", "output.probes[1].name"),
        ("output.probes[1].at=[1]", "output.probes[1]"),
    ],
)
def test_what_is_refused_in_the_file(change, where):
    with pytest.raises(InputError) as found:
        check(changed(change))
    assert found.value.where == where
    assert found.value.remedy


def test_a_body_may_start_touching():
    checked = check(changed("bodies.wall.shape.point=1 m"))
    assert checked.contacts["wall"].gap == 0.0


def test_lumped_mass_allows_longer_slabs():
    slow = check(replace(BAR, bodies={**BAR.bodies, "bar": replace(BAR.bodies["bar"], mass=Lumped())}))
    assert slow.bodies["bar"].stable_step == pytest.approx(np.sqrt(3.0) * 0.5)


@pytest.mark.parametrize("name", ["a.b", "a\nb", "", " ", "\x1b[2J"])
def test_names_that_nothing_can_name_or_show_are_refused(name):
    with pytest.raises(InputError, match="cannot be the name of a body") as found:
        check(replace(BAR, bodies={**BAR.bodies, name: BAR.bodies["wall"]}))
    assert found.value.where == "bodies"
    check(replace(BAR, bodies={**BAR.bodies, "a name with blanks, ä": BAR.bodies["wall"]}))


def test_times_whose_squares_are_no_numbers_are_refused():
    """The slab of 1e-300 s was accepted, and the run divided by its square."""
    for end, step in ((1e-300, "auto"), (1.0, 1e-300)):
        with pytest.raises(InputError) as found:
            check(replace(BAR, time=replace(BAR.time, end=end, step=step)))
        assert found.value.where in ("time.end", "time.step")


def test_bodies_in_one_place_have_an_approach_speed():
    """Their nearest nodes coincide: there is no direction between them."""
    mesh, law = Rectangle(size=(1.0, 1.0), cells=(2, 2)), LinearElastic(E=1.0)
    bodies = {n: Solid(mesh=mesh, material=law, density=1.0, velocity=v) for n, v in (("a", (1.0, 0)), ("b", (0.0, 0)))}
    bodies = {n: replace(b, velocity=Uniform(value=b.velocity)) for n, b in bodies.items()}
    contact = Contact(between=("a.left", "b.top"))
    found = check(model.Scenario(bodies=bodies, contacts=(contact,), time=model.Time(end=1.0)))
    assert np.isfinite(found.contacts[contact.label].approach)
    assert found.contacts[contact.label].gap == 0.0


def test_supports_that_others_override_are_refused():
    """The later of two driven supports won without a word, and a driven one over a fixed one."""
    left = {"on": "left", "velocity": 1.0}
    for first in (Fixed(on="left"), Driven(on="left", velocity=2.0)):
        supports = (first, Driven(**left))
        with pytest.raises(InputError, match="driven by other supports") as found:
            check(replace(BAR, bodies={**BAR.bodies, "bar": replace(BAR.bodies["bar"], supports=supports)}))
        assert found.value.where == "bodies.bar.supports[0]"
    twice = replace(BAR.bodies["bar"], supports=(Fixed(on="left"), Fixed(on="left")), velocity=Uniform())
    check(replace(BAR, bodies={**BAR.bodies, "bar": twice}))


def test_a_force_that_central_differences_do_not_take_is_refused():
    bar = replace(BAR.bodies["bar"], force=EnergyMomentum())
    with pytest.raises(InputError, match="EnergyMomentum with Explicit") as found:
        check(replace(BAR, bodies={**BAR.bodies, "bar": bar}, solver=Explicit()))
    assert found.value.where == "bodies.bar.force"
