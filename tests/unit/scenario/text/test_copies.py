"""Copies of a solid in a scenario file: names, places, contacts, loads, refusals."""

import numpy as np
import pytest

from softway.errors import InputError
from softway.scenario.checks.check import check
from softway.scenario.files import dumps, loads
from softway.scenario.hints.units_text import Units
from softway.scenario.scenario import Scenario
from softway.scenario.text.copies import with_copies

UNITS = Units.standard()
TEXT = """
[bodies.ball]
kind = "Solid"
mesh = { kind = "Disc", radius = "10 mm", cells = 4, centre = ["0 mm", "11 mm"] }
material = "glass"
velocity = ["1 m/s", "0 m/s"]
copies = [["0 mm", "0 mm"], { at = ["5 cm", "1 mm"], velocity = ["-2 m/s", "0 m/s"] }, ["0.1 m", "0 m"]]

[bodies.floor]
kind = "Tool"
shape = { kind = "HalfSpace", point = [0, 0], normal = [0, 1] }

[[contacts]]
between = "all"

[time]
end = "1 us"
"""


def scenario(*changes: str) -> Scenario:
    return loads(TEXT, changes=changes, units=UNITS)


def test_copies_are_bodies_at_their_places() -> None:
    found = check(scenario()).scenario.bodies
    assert list(found) == ["ball1", "ball2", "ball3", "floor"]
    centres = [0.5 * (m.points.min(axis=0) + m.points.max(axis=0)) for m in map(_mesh, list(found.values())[:3])]
    assert np.allclose(centres, [[0.0, 0.011], [0.05, 0.012], [0.1, 0.011]], atol=1e-15)
    assert [found[n].velocity.value for n in ("ball1", "ball2", "ball3")] == [(1.0, 0.0), (-2.0, 0.0), (1.0, 0.0)]


def test_own_placement_comes_first() -> None:
    place = "bodies.ball.place={rotations=[{angle='45 deg'}]}"
    turned, plain = (_mesh(check(scenario(*c)).scenario.bodies["ball3"]).points for c in ((place,), ()))
    centre = np.array([0.1, 0.011])
    angle = np.pi / 4.0
    rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    assert np.allclose(turned - centre, (plain - centre) @ rotation.T, atol=1e-15)


def test_lattice_runs_along_the_first_axis_first() -> None:
    change = 'bodies.ball.copies={ count = [2, 3], spacing = ["30 mm", 0.05] }'
    moves = [body.group[0].translation for n, body in scenario(change).bodies.items() if n != "floor"]
    assert np.allclose(moves, [[x, y] for y in (0.0, 0.05, 0.1) for x in (0.0, 0.03)], atol=1e-15)


def test_lists_of_contacts_take_all_copies_and_pairs_are_repeated() -> None:
    def between(text: str) -> list[tuple[str, ...]]:
        return [c.between for c in scenario(f"contacts[0].between={text}").contacts]

    assert between('["ball", "ball", "floor"]') == [("ball1", "ball2", "ball3", "ball1", "ball2", "ball3", "floor")]
    assert between('["ball", "floor"]') == [(f"ball{k}", "floor") for k in (1, 2, 3)]
    assert between('["ball1", "floor"]') == [("ball1", "floor")]
    assert between('["ball", "ball"]') == [("ball1", "ball2", "ball3", "ball1", "ball2", "ball3")]


def test_pairs_with_a_name_get_numbers() -> None:
    found = scenario('contacts=[{ between = ["ball.boundary", "floor"], name = "ground" }]').contacts
    assert [(c.name, c.between[0]) for c in found] == [(f"ground{k}", f"ball{k}.boundary") for k in (1, 2, 3)]


def test_loads_are_repeated() -> None:
    change = 'loads=[{kind="Traction", on="ball.boundary", value=[1, 0]}, {kind="Gravity", acceleration=[0, -9.81]}]'
    assert [getattr(load, "on", "") for load in scenario(change).loads] == [
        *(f"ball{k}.boundary" for k in (1, 2, 3)),
        "",
    ]


def test_the_written_text_holds_the_bodies() -> None:
    assert loads(dumps(scenario()), units=UNITS) == scenario()


def test_a_scenario_without_copies_is_left_alone() -> None:
    data = {"bodies": {"rod": {"kind": "Solid"}}, "contacts": [{"between": ["rod", "wall"]}]}
    assert with_copies(data, UNITS) == data


@pytest.mark.parametrize(
    ("change", "place", "problem"),
    [
        ("bodies.ball.copies=3", "bodies.ball.copies", "3 is no list of places"),
        ("bodies.ball.copies=[]", "bodies.ball.copies", "[] is no list of places"),
        ("bodies.ball.copies=[[0, 0], 1]", "bodies.ball.copies[1]", "1 has no place"),
        ("bodies.ball.copies=[{velocity=[0, 0]}]", "bodies.ball.copies[0]", "has no place"),
        ("bodies.ball.copies=[[0, '1 kg']]", "bodies.ball.copies[0].at[1]", "1 kg"),
        ("bodies.ball.copies=[[0, 0, 1]]", "bodies.ball1.group[0].translation", "3 components in 2D"),
        ("bodies.ball.copies=[{at=[0, 0], velocty=1}]", "bodies.ball1.velocty", "unknown key"),
        ("bodies.ball.copies={count=[2, 0], spacing=[1, 1]}", "bodies.ball.copies.count", "positive"),
        ("bodies.ball.copies={count=[2, 2], spacing=[1]}", "bodies.ball.copies.spacing", "list of 2 lengths"),
        ("bodies.ball.copies={counts=[2, 2]}", "bodies.ball.copies.counts", "unknown key"),
        ("bodies.ball.copies={count=[200, 200], spacing=[1, 1]}", "bodies.ball.copies", "40000 copies"),
        ("bodies.ball.group=1", "bodies.ball.copies[0]", "group of the body is 1"),
        ("bodies.floor.copies=[[0, 0]]", "bodies.floor.copies", "kind 'Tool'"),
    ],
)
def test_what_is_no_place_is_refused(change: str, place: str, problem: str) -> None:
    with pytest.raises(InputError) as caught:
        check(scenario(change))
    assert caught.value.where == place
    assert problem in caught.value.problem


def test_a_name_that_exists_is_refused() -> None:
    text = TEXT + '[bodies.ball2]\nkind = "Tool"\nshape = { kind = "HalfSpace", point = [0, 9], normal = [0, -1] }\n'
    with pytest.raises(InputError, match="there is a body 'ball2' already"):
        loads(text, units=UNITS)


def _mesh(body: object) -> object:
    mesh = body.mesh  # type: ignore[attr-defined]
    return mesh if hasattr(mesh, "points") else body.group[0].applied(body.place.applied(mesh.build()))  # type: ignore[attr-defined]
