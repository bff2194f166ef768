"""Changes by path on plain data."""

import pytest

from softway.errors import InputError
from softway.scenario.text.override import overridden, steps

DATA = {
    "bodies": {"bar": {"density": 1, "material": {"E": 1}}},
    "contacts": [{"timing": "Energy"}],
    "time": {"end": 1, "step": "0.1 s"},
}


@pytest.mark.parametrize(
    ("change", "way", "value"),
    [
        ("time.end=2", ("time", "end"), 2),
        ("time.end = 2.5 ms", ("time", "end"), "2.5 ms"),
        ('time.end="2 ms"', ("time", "end"), "2 ms"),
        ("time.flag=true", ("time", "flag"), True),
        ("bodies.bar.velocity=[1, '2 m/s']", ("bodies", "bar", "velocity"), [1, "2 m/s"]),
        ("bodies.bar.material={kind='X', E=2}", ("bodies", "bar", "material"), {"kind": "X", "E": 2}),
        ("bodies.bar.place.bottom=5 mm", ("bodies", "bar", "place"), {"bottom": "5 mm"}),
        ("bodies.bar.name=a=b", ("bodies", "bar", "name"), "a=b"),
        ("contacts[0].name=x", ("contacts", 0, "name"), "x"),
        ("contacts[0].timing.located=true", ("contacts", 0, "timing"), {"kind": "Energy", "located": True}),
        ("output.fields_every=1", ("output", "fields_every"), 1),
    ],
)
def test_changes(change, way, value):
    found = overridden(DATA, [change])
    for step in way:
        found = found[step]
    assert found == value


def test_the_data_stay_as_they_were():
    overridden(DATA, ["bodies.bar.material.E=2", "contacts[0].timing=Paper"])
    assert DATA["bodies"]["bar"]["material"] == {"E": 1}
    assert DATA["contacts"][0]["timing"] == "Energy"


@pytest.mark.parametrize(
    ("change", "where", "problem"),
    [
        ("bodies.baar.density=1", "bodies.baar.density", "no body 'baar'.*did you mean 'bar'"),
        ("contacts[1].name=x", "contacts[1].name", "contacts has 1 entries"),
        ("loads[0].acceleration=1", "loads[0].acceleration", "loads has 0 entries"),
        ("time.end.x=1", "time.end.x", "time.end is 1, not a table"),
        ("time.step.x=1", "time.step.x", "time.step is '0.1 s', not a table"),
        ("bodies[0]=1", "bodies[0]", "bodies has 0 entries"),
        ("time.end", "time.end", "is not of the form path=value"),
        ("=1", "=1", "is not of the form path=value"),
        ("time..end=1", "time..end", "not valid in a path"),
        ("time.end[x]=1", "time.end[x]", "not valid in a path"),
    ],
)
def test_paths_that_lead_nowhere(change, where, problem):
    with pytest.raises(InputError, match=f"(?s){problem}") as found:
        overridden(DATA, [change])
    assert found.value.where == where


def test_steps():
    assert steps("output.probes[10].at[0]") == ("output", "probes", 10, "at", 0)
