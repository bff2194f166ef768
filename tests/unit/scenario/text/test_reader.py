"""Mistakes in a scenario text: where, what, and what to write instead."""

import pytest

from softway.bodies.solid import Driven, Fixed
from softway.errors import InputError
from softway.scenario.files import loads
from softway.scenario.hints.units_text import Units
from softway.scenario.text.templates import templates

UNITS = Units.standard()
BAR = templates()["bar"]

MISTAKES = [
    ("bodies.bar.material.nuu=0.3", "bodies.bar.material.nuu", "unknown key .value 0.3.", "'nu'.*E, nu"),
    ("bodies.bar.desity=1", "bodies.bar.desity", "unknown key", "'density'"),
    ("titel=x", "titel", "unknown key", "'title'"),
    ("bodies.bar.material.kind=NeoHookian", "bodies.bar.material.kind", "NeoHookian", "'NeoHookean'.*StVenant"),
    ("bodies.bar.material.kind=nowhere:Law", "bodies.bar.material.kind", "nowhere:Law", "nowhere.py"),
    ("bodies.bar.material.kind=math:pi", "bodies.bar.material.kind", "would run Python", "--allow-python"),
    ("bodies.bar.material.kind=softway.meshes.mesh:Mesh", "bodies.bar.material.kind", "is no StoredEnergy", "needs"),
    ("bodies.bar.material.kind=softway.errors:within", "bodies.bar.material.kind", "no dataclass", "dataclass"),
    ("bodies.bar.kind=Tol", "bodies.bar.kind", "Tol", "'Tool'"),
    ("bodies.bar.material.E=5 mm", "bodies.bar.material.E", "length", "210 GPa"),
    ("bodies.bar.material.nu=0.7", "bodies.bar.material.nu", "0.7", "."),
    ("bodies.bar.material={E=1}", "bodies.bar.material.kind", "missing", "LinearElastic"),
    ("bodies.bar.material=5", "bodies.bar.material", "5 is not a known kind", "kind = one of"),
    ("bodies.bar.mesh={kind='Interval', cells=2}", "bodies.bar.mesh.length", "missing", "5 mm"),
    ("bodies.bar.mesh.cells=2.5", "bodies.bar.mesh.cells", "2.5", "whole number"),
    ("bodies.bar.mesh.cells=true", "bodies.bar.mesh.cells", "True", "whole number"),
    ("bodies.bar.velocity=true", "bodies.bar.velocity", "True", "Uniform"),
    ("bodies.bar.velocity=1 mm", "bodies.bar.velocity.value", "1 mm", "4.4 m/s"),
    ("bodies.bar.velocity=['1 m/s', '2 m']", "bodies.bar.velocity.value[1]", "2 m", "4.4 m/s"),
    ("bodies.bar.supports={on='left'}", "bodies.bar.supports", "not a list", "square brackets"),
    ("bodies.bar.supports=[{kind='Fixed', at='left'}]", "bodies.bar.supports[0].at", "unknown key", "on, components"),
    (
        "bodies.bar.place.rotations=[{axis=[0,1], angle=1}]",
        "bodies.bar.place.rotations[0].axis",
        "2 entries",
        "3 entries",
    ),
    ("bodies.bar.place=7", "bodies.bar.place", "not a table", "rotations"),
    ("bodies.wall.shape.kind=HalfSpase", "bodies.wall.shape.kind", "HalfSpase", "'HalfSpace'"),
    ("bodies.wall.shape.normal=0", "bodies.wall.shape.normal", "0", "."),
    ("bodies.wall.shape.point={}", "bodies.wall.shape.point", "does not fit", "5 mm"),
    ("bodies.bar.place.bottom={}", "bodies.bar.place.bottom", "does not fit", "5 mm"),
    ("bodies.bar.mesh={kind='MeshFile', path={}}", "bodies.bar.mesh.path", "does not fit", "text in quotes"),
    ("bodies=3", "bodies", "not a table", "NAME"),
    ("contacts[0].between=[1, 2]", "contacts[0].between", "1", "text"),
    ("contacts[0].timing=Energie", "contacts[0].timing", "Energie", "Energy, Impulse, Paper"),
    ("contacts[0].timing.located=1", "contacts[0].timing.located", "1", "true or false"),
    ("time.end=0", "time.end", "0 s is not positive", "2 ms"),
    ("time.end=-1 ms", "time.end", "-0.001 s", "2 ms"),
    ("time.step=0", "time.step", "0 s", "auto"),
    ("time.step=atuo", "time.step", "atuo", "'auto'"),
    ("time.weight.theta=0.2", "time.weight.theta", "0.2", "0.5"),
    ("time.weight.delta=0.2", "time.weight.kind", "missing", "EndPeaks"),
    ("time.weight={kind='EndPeaks', theta=0.2}", "time.weight.theta", "0.2", "0.5"),
    ("output.fields_every=-1", "output.fields_every", "-1", "auto"),
    ("output.probes[0].quantity=speed", "output.probes[0].quantity", "speed", "velocity"),
    ("solver={kind='FixedPoint', depth=-1}", "solver.depth", "-1", "."),
]


@pytest.mark.parametrize(("change", "where", "problem", "remedy"), MISTAKES, ids=[m[0] for m in MISTAKES])
def test_mistakes(change, where, problem, remedy):
    with pytest.raises(InputError, match=f"(?s){problem}.*try: .*{remedy}") as found:
        loads(BAR, changes=[change], units=UNITS)
    assert found.value.where == where


def test_an_end_is_needed():
    with pytest.raises(InputError) as found:
        loads(BAR[: BAR.index("[time]")], units=UNITS)
    assert (found.value.where, found.value.problem) == ("time", "missing")


def test_a_kind_may_be_left_out_where_there_is_only_one():
    assert loads(BAR, changes=["contacts[0].between=['bar.right', 'wall']"], units=UNITS).contacts[0].body == "bar"


@pytest.mark.parametrize(
    ("support", "expected"),
    [
        ("{on='left'}", Fixed(on="left")),
        ("{on='left', velocity='2 m/s'}", Driven(on="left", velocity=2.0)),
        (
            "{on='left', velocity=[0, '2 m/s'], times=[0, '5 ms']}",
            Driven(on="left", velocity=(0.0, 2.0), times=(0.0, 0.005)),
        ),
    ],
)
def test_a_kind_may_be_left_out_where_only_one_takes_the_keys(support, expected):
    assert loads(BAR, changes=[f"bodies.bar.supports=[{support}]"], units=UNITS).bodies["bar"].supports == (expected,)


def test_a_kind_is_needed_where_two_take_the_keys():
    with pytest.raises(InputError) as found:
        loads(BAR, changes=["bodies.bar.mesh={radius='1 m', cells=4}"], units=UNITS)
    assert (found.value.where, found.value.problem) == ("bodies.bar.mesh.kind", "missing")
