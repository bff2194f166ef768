"""Rigid tools and their motion in scenario texts."""

from pathlib import Path

import meshio
import numpy as np
import pytest

from softway.bodies.prescribed_motion import Still, Table, Translation, Turning
from softway.errors import InputError
from softway.obstacles.primitives import Block, Cavity, Cylinder
from softway.obstacles.signed_distance import SignedDistance
from softway.obstacles.triangulated import Facets, Surface
from softway.scenario.checks.check import check
from softway.scenario.files import dumps, load, loads
from softway.scenario.hints.units_text import Units
from softway.scenario.text.user_modules import Modules

UNITS = Units.standard()
TEXT = """
[bodies.part]
kind = "Solid"
mesh = { kind = "Box", size = ["20 mm", "20 mm", "20 mm"], cells = [2, 2, 2] }
material = { kind = "LinearElastic", E = "1 GPa" }
density = 1000
place = { bottom = "1 mm" }

[bodies.die]
kind = "Tool"
shape = { kind = "Surface", file = "tools/die.stl", scale = "1 mm" }

[[contacts]]
between = ["part.bottom", "die"]

[time]
end = "1 ms"
"""
CORNERS = np.array([[x, y, z] for z in (-10.0, 0.0) for y in (-16.0, 48.0) for x in (-16.0, 48.0)])
FACES = np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
BLOCK = Block(low=(-0.016, -0.016, -0.01), high=(0.048, 0.048, 0.0))


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A scenario with a surface in a folder beside it."""
    (tmp_path / "tools").mkdir()
    cells = np.concatenate([FACES[:, [0, 1, 2]], FACES[:, [0, 2, 3]]])
    meshio.write(tmp_path / "tools" / "die.stl", meshio.Mesh(CORNERS, [("triangle", cells)]), binary=True)
    path = tmp_path / "press.toml"
    path.write_text(TEXT)
    return path


def test_a_surface_is_looked_for_beside_the_scenario(file):
    shape = load(file, units=UNITS).bodies["die"].shape
    assert shape == Surface(file=file.parent / "tools" / "die.stl", scale=1e-3)
    x = np.random.default_rng(0).uniform(-0.1, 0.1, (200, 3))
    assert shape.facets.closed and np.abs(shape.gap(x) - BLOCK.gap(x)).max() < 1e-15


def test_a_scenario_with_a_surface_is_right(file):
    checked = check(load(file, units=UNITS))
    assert checked.contacts["part.bottom-die"].gap == pytest.approx(1e-3, rel=1e-12)


def tool(text, name="die"):
    data = f'[bodies.die]\nkind = "Tool"\n{text}\n[time]\nend = 1\n'
    return loads(data, units=UNITS, modules=Modules(allowed=True)).bodies[name]


@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        (
            '{ kind = "Cylinder", start = [0, 0, "1 cm"], end = [0, 0, 0], radius = "2 mm" }',
            Cylinder(start=(0.0, 0.0, 0.01), end=(0.0, 0.0, 0.0), radius=0.002),
        ),
        (
            '{ kind = "SignedDistance", function = "numpy:sum", dim = 3, step = "1 nm" }',
            SignedDistance(function="numpy:sum", dim=3, step=1e-9),
        ),
        (
            '{ kind = "Cavity", of = { kind = "Cylinder", start = [0, 0, 1], end = [0, 0, 0], radius = 2 } }',
            Cavity(of=Cylinder(start=(0.0, 0.0, 1.0), end=(0.0, 0.0, 0.0), radius=2.0)),
        ),
    ],
    ids=["Cylinder", "SignedDistance", "Cavity"],
)
def test_shapes_are_read(shape, expected):
    assert tool(f"shape = {shape}").shape == expected


@pytest.mark.parametrize(
    ("motion", "expected"),
    [
        ("", Still()),
        ('motion = "Still"', Still()),
        ('motion = { kind = "Translation", velocity = [0, 0, "-36 km/h"] }', Translation(velocity=(0.0, 0.0, -10.0))),
        ('motion = [0, 0, "-2 m/s"]', Translation(velocity=(0.0, 0.0, -2.0))),
        (
            'motion = { kind = "Table", times = [0, "2 ms"], displacements = [[0, 0, 0], [0, 0, "-5 mm"]] }',
            Table(times=(0.0, 0.002), displacements=((0.0, 0.0, 0.0), (0.0, 0.0, -0.005))),
        ),
        (
            'motion = { kind = "Turning", point = [0, 0, "1 cm"], axis = [0, 1, 0], rate = "30 rpm" }',
            Turning(point=(0.0, 0.0, 0.01), axis=(0.0, 1.0, 0.0), rate=np.pi),
        ),
    ],
)
def test_motions_are_read(motion, expected):
    found = tool(f'shape = {{ kind = "HalfSpace", point = [0, 0, 0], normal = [0, 0, 1] }}\n{motion}').motion
    assert type(found) is type(expected) and np.allclose(
        found.at(1.7).place(np.ones(3)), expected.at(1.7).place(np.ones(3))
    )


def test_motions_in_one_dimension():
    wall = 'shape = { kind = "HalfSpace", point = 1, normal = -1 }\nmotion = '
    assert tool(wall + '"-2 m/s"').motion == Translation(velocity=-2.0)
    table = '{ kind = "Table", times = [0, 1], displacements = [0, "-5 mm"] }'
    assert tool(wall + table).motion == Table(times=(0.0, 1.0), displacements=(0.0, -0.005))


@pytest.mark.parametrize(
    "motion",
    [
        "{ kind = 'Translation', velocity = [1, 2, 3] }",
        "{ kind = 'Table', times = [0, 0.1], displacements = [[0, 0, 0], [1, 2, 3]] }",
        "{ kind = 'Turning', point = [1, 2, 3], axis = [0, 0, 1], rate = 5 }",
    ],
)
def test_what_is_written_is_read_back(file, motion):
    scenario = load(file, changes=[f"bodies.die.motion={motion}", "bodies.die.shape.smooth=true"], units=UNITS)
    text = dumps(scenario)
    assert loads(text, units=UNITS) == scenario and dumps(loads(text, units=UNITS)) == text
    assert scenario.bodies["die"].shape.smooth and 'scale = "0.001 m"' in text


MISTAKES = [
    ("bodies.die.shape.file=tools/dye.stl", "bodies.die.shape.file", "no such file"),
    ("bodies.die.shape.file=press.toml", "bodies.die.shape.file", "ending"),
    ("bodies.die.shape.file=3", "bodies.die.shape.file", "not a path"),
    ("bodies.die.shape.scale=0", "bodies.die.shape.scale", "not positive"),
    ("bodies.die.shape.scale=1 s", "bodies.die.shape.scale", "dimension"),
    ("bodies.die.shape.kind=Facets", "bodies.die.shape.kind", "'Facets' is unknown"),
    ("bodies.die.motion=[0, 1]", "bodies.die.motion", "2D for a shape in 3D"),
    ("bodies.die.motion={kind='Moving'}", "bodies.die.motion.kind", "unknown"),
    ("bodies.die.motion={kind='Translation', velocity='1 m'}", "bodies.die.motion.velocity", "dimension"),
    ("bodies.die.motion={kind='Table', times=[1, 0], displacements=[0, 1]}", "bodies.die.motion.times", "increase"),
    ("bodies.die.motion={kind='Turning', point=[0, 0, 0], rate='1 Hz'}", "bodies.die.motion.rate", "angular"),
    ("bodies.die.motion={kind='Turning', point=[0, 0, 0], rate=1}", "bodies.die.motion.axis", "not an axis in 3D"),
    ("bodies.die.shape={kind='SignedDistance', dim=3, function='no:f'}", "bodies.die.shape.function", "no"),
    ("bodies.die.shape={kind='SignedDistance', dim=3, function='math'}", "bodies.die.shape.function", "math"),
    ("bodies.die.shape={kind='SignedDistance', dim=3, function='numpy:sum'}", "bodies.die.shape.function", "Python"),
]


@pytest.mark.parametrize(("change", "where", "problem"), MISTAKES, ids=[m[0] for m in MISTAKES])
def test_mistakes_name_their_place(file, change, where, problem):
    with pytest.raises(InputError, match=problem) as found:
        load(file, changes=[change], units=UNITS)
    assert found.value.where == where and found.value.remedy


def test_what_only_python_can_say_is_not_written(file):
    from dataclasses import replace

    from softway.bodies.solid import Tool

    scenario = load(file, units=UNITS)
    facets = Facets(points=CORNERS, cells=FACES[:, [0, 1, 2]][:1])
    for shape, where in (
        (facets, "bodies.die.shape"),
        (SignedDistance(function=lambda x: x[:, 0], dim=3), "bodies.die.shape.function"),
    ):
        with pytest.raises(InputError) as found:
            dumps(replace(scenario, bodies={"die": Tool(shape=shape)}))
        assert found.value.where == where and found.value.remedy
