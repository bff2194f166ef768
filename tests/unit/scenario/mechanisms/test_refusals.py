"""Wrong scenarios of rigid bodies: every refusal names the place, the value and a remedy."""

from pathlib import Path

import pytest

from softway.errors import InputError
from softway.scenario.checks.check import check
from softway.scenario.files import load

FOLDER = Path(__file__).parents[4] / "scenarios"
SOLID = (
    "{kind='Solid', mesh={kind='Rectangle', size=[1, 1], cells=[1, 1]}, material={kind='LinearElastic', E=1, nu=0.3}, "
    "density=1}"
)
WRONG = {
    "a misspelt key": ("joints.pin.betwen=['crank', 'rod']", "joints.pin.betwen", "", "did you mean 'between'"),
    "a misspelt kind": ("joints.pin.kind=Hing", "joints.pin.kind", "'Hing'", "did you mean 'Hinge'"),
    "a misspelt body": ("joints.pin.between=['crunk', 'rod']", "joints.pin.between", "'crunk'", "did you mean 'crank'"),
    "a wrong unit": ("bodies.crank.mass=40 mm", "bodies.crank.mass", "40 mm", "kg"),
    "a solid among rigid bodies": (f"bodies.slider={SOLID}", "bodies.crank.kind", "'slider'", '"Rigid" for all'),
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
