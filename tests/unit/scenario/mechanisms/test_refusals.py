"""Wrong scenarios of rigid bodies: every refusal names the place, the value and a remedy."""

from pathlib import Path

import pytest

from softway.errors import InputError
from softway.scenario.checks.check import check
from softway.scenario.files import load

FOLDER = Path(__file__).parents[4] / "scenarios"
TOOL = "{kind='Tool', shape={kind='HalfSpace', point=[0, -1], normal=[0, 1]}}"
BEAM = "hammer_on_beam.toml"
BESIDE = {
    "no surface": (
        "bodies.hammer={kind='Rigid', mass=1, centre=[0.4, 0.06], inertia=1}", "contacts[0].between", "shape",
    ),
    "the rigid body first": ("contacts=[{between=['hammer', 'beam.top']}]", "contacts[0].between", "the solid first"),
    "a tag of a rigid body": ("contacts=[{between=['beam.top', 'hammer.face']}]", "contacts[0].between", "its name"),
    "no such carrier": ("bodies.beam.supports=[{kind='Carried', on='left', by='hamer'}]", "supports[0].by", "hammer"),
    "an inertia": ("inertia={kind='Scaled', factor=2}", "inertia", "omit it"),
    "a static start": ("start=StaticStart", "start", "AsGiven"),
    "an explicit method": ("solver=Explicit", "solver", "FixedPoint"),
    "a probe of nobody": ("output.probes=[{name='p', of='bean', tag='left'}]", "output.probes[0].of", "hammer"),
    "a surface in space": (
        "bodies.hammer.shape={kind='Sphere', centre=[0, 0, 0], radius=1}", "bodies.hammer.shape", "a shape in 2D",
    ),
    "a body in space": ("bodies.hammer={kind='Rigid', mass=1, centre=[0, 0, 0]}", "joints.pivot", "3 coord"),
    "gravity that changes": (
        "loads=[{kind='Gravity', acceleration=[0, -9.81], ramp={times=[0, 1], factors=[0, 1]}}]",
        "loads[0].ramp",
        "omit",
    ),
}  # fmt: skip
WRONG = {
    "a misspelt key": ("joints.pin.betwen=['crank', 'rod']", "joints.pin.betwen", "", "did you mean 'between'"),
    "a misspelt kind": ("joints.pin.kind=Hing", "joints.pin.kind", "'Hing'", "did you mean 'Hinge'"),
    "a misspelt body": ("joints.pin.between=['crunk', 'rod']", "joints.pin.between", "'crunk'", "did you mean 'crank'"),
    "a wrong unit": ("bodies.crank.mass=40 mm", "bodies.crank.mass", "40 mm", "kg"),
    "a tool among rigid bodies": (f"bodies.slider={TOOL}", "bodies.slider.kind", "'slider'", "[stops.NAME]"),
    "a contact": ("contacts=[{between=['crank', 'rod']}]", "contacts[0]", "'crank', 'rod'", "[stops.NAME]"),
    "a traction": ("loads=[{kind='Traction', on='rod.top', value=[0, 1]}]", "loads[0]", "'rod.top'", "[[torques]]"),
    "a static start": ("start=StaticStart", "start", "StaticStart", "omit it"),
    "no inertia": ("inertia=Off", "inertia", "Off", "omit it"),
    "a solver": ("solver=Newton", "solver", "Newton", "omit it"),
    "an automatic step": ("time.step=auto", "time.step", "'auto'", '"0.00011 s"'),
    "a long step": ("time.step=1 s", "time.step", "1 s is longer", "a shorter step"),
    "a probe with a tag": (
        "output.probes=[{name='p', of='rod', tag='top'}]",
        "output.probes[0].tag",
        "'top'",
        "'at', a point",
    ),
    "a probe of a reaction": (
        "output.probes=[{name='p', of='rod', quantity='reaction'}]",
        "output.probes[0].quantity",
        "'reaction'",
        "'position'",
    ),
    "a spin about x in the plane": (
        "output.probes=[{name='p', of='rod', quantity='spin'}]",
        "output.probes[0].component",
        "'x'",
        "'z'",
    ),
    "a torque on nothing": ("torques=[{on='rot', value=1}]", "torques[0].on", "'rot'", "did you mean 'rod'"),
    "an overlapped stop": (
        "stops.s={kind='PlaneStop', between=['ground', 'rod'], point=[0.2, 0], plane=[0, '1 mm'], normal=[0, 1]}",
        "stops.s",
        "0.001 m",
        "a gap of zero or more",
    ),
    "gravity in space": (
        "loads=[{kind='Gravity', acceleration=[0, 0, -9.81]}]",
        "loads[0].acceleration",
        "3 components",
        "2 components",
    ),
}


@pytest.mark.parametrize("case", sorted(WRONG))
def test_a_refusal_names_place_value_and_remedy(case):
    change, where, value, remedy = WRONG[case]
    with pytest.raises(InputError) as found:
        check(load(FOLDER / "slider_crank.toml", [change]))
    assert found.value.where == where and value in found.value.problem and remedy in found.value.remedy, found.value


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ("joints.j={kind='Hinge', between=['ground', 'bar'], at=[0]}", "joints.j"),
        ("stops.s={kind='PlaneStop', between=['ground', 'bar'], point=[0], plane=[0], normal=[1]}", "stops.s"),
        ("springs=[{between=['ground', 'bar'], ends=[[0], [1]]}]", "springs[0]"),
        ("torques=[{on='bar', value=1}]", "torques[0]"),
        ("impacts=sequential", "impacts"),
    ],
)
def test_parts_of_a_mechanism_need_rigid_bodies(change, where):
    with pytest.raises(InputError, match='kind = "Rigid" only') as found:
        check(load(FOLDER / "paper_bar.toml", [change]))
    assert found.value.where == where


def test_solids_neither_spin_nor_rotate():
    probe = "output.probes=[{name='p', of='bar', tag='left', quantity='spin'}]"
    with pytest.raises(InputError, match="'spin' is not recorded"):
        check(load(FOLDER / "paper_bar.toml", [probe]))


@pytest.mark.parametrize("case", sorted(BESIDE))
def test_refusals_of_rigid_bodies_beside_solids(case):
    change, where, remedy = BESIDE[case]
    with pytest.raises(InputError) as found:
        check(load(FOLDER / BEAM, [change]))
    assert found.value.where.endswith(where) and remedy in found.value.remedy, found.value
