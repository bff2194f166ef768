"""The verb ``schema``: it admits what the reader admits, and refuses misspelt keys at any depth."""

import copy
import json
import tomllib
from pathlib import Path
from typing import Any

import pytest

from softway.apps.cli import main
from softway.scenario.files import dumps, loads
from softway.scenario.json_schema import schema
from softway.scenario.text.templates import templates

jsonschema = pytest.importorskip("jsonschema")
ROOT = Path(__file__).parents[4]
TEXTS = {p.stem: p.read_text(encoding="utf-8") for p in sorted(ROOT.glob("scenarios/*.toml"))} | dict(templates())


@pytest.fixture(scope="module")
def judge() -> Any:
    """A validator of the schema, which is one."""
    made = schema()
    jsonschema.Draft202012Validator.check_schema(made)
    return jsonschema.Draft202012Validator(made)


@pytest.mark.parametrize("name", TEXTS)
def test_every_scenario_is_admitted_and_a_misspelt_key_is_not(name: str, judge: Any) -> None:
    data = tomllib.loads(TEXTS[name])
    assert not [e.message for e in judge.iter_errors(data)]
    tables = list(_tables(data))
    assert len(tables) > 3
    for way in tables:
        wrong = copy.deepcopy(data)
        here: Any = wrong
        for step in way:
            here = here[step]
        here["misspelt"] = 1
        assert not judge.is_valid(wrong), way


def _tables(data: Any, way: tuple[Any, ...] = ()) -> Any:
    """The way to every table whose keys are fields: not that of the bodies, nor materials of the library."""
    if isinstance(data, dict) and way != ("bodies",) and "library" not in data:
        yield way
    for key, value in data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ():
        yield from _tables(value, (*way, key))


def test_what_is_written_with_every_default_is_admitted(judge: Any) -> None:
    text = dumps(loads(templates()["bar"]))
    assert judge.is_valid(tomllib.loads(text))


def test_kinds_units_and_defaults_are_told() -> None:
    found = schema()["$defs"]
    solid = found["bodies.solid.Solid"]["properties"]
    assert "a density [kg/m^3]" in solid["density"]["description"] and solid["kind"] == {"const": "Solid"}
    assert {"enum": ["FixedPoint", "Newton", "Explicit"]} in schema_of_solver()
    assert found["scenario.scenario.Time"]["properties"]["step"]["default"] == "auto"


def schema_of_solver() -> list[Any]:
    return schema()["$defs"]["scenario.scenario.Scenario"]["properties"]["solver"]["anyOf"]


def test_printed_or_into_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["schema"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert main(["schema", "--out", str(tmp_path / "softway.json")]) == 0
    assert json.loads((tmp_path / "softway.json").read_text()) == printed == json.loads(json.dumps(schema()))
    assert main(["schema", "--out", str(tmp_path / "none/softway.json")]) == 2
