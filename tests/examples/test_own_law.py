"""The page about laws of one's own runs as it stands there."""

import re
import sys
from pathlib import Path

import pytest

from softway.apps.cli import main

PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "own_law.md"


@pytest.fixture
def place(tmp_path, monkeypatch):
    """A folder with the laws and the scenario of the page."""
    blocks = re.findall(r"^```(\w*)\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    law, fluid, sand = (text for kind, text in blocks if kind == "python" and "@dataclass" in text)
    (tmp_path / "my_law.py").write_text(law)
    (tmp_path / "fluid.py").write_text(fluid)
    (tmp_path / "sand.py").write_text(sand)
    (tmp_path / "block.toml").write_text(next(text for kind, text in blocks if kind == "toml"))
    uses = [text for kind, text in blocks if kind == "python" and "@dataclass" not in text]
    monkeypatch.chdir(tmp_path)
    yield uses
    for name in ("my_law", "fluid", "sand"):
        sys.modules.pop(name, None)


@pytest.mark.parametrize(
    "arguments",
    [
        ["my_law:Stiffening"],
        ["my_law:Stiffening", "--set", "E=50 kPa", "--set", "k=0"],
        ["NeoHookean", "--set", "nu=0.49"],
        ["fluid:Fluid"],
        ["sand:Rooted"],
        ["friction.NortonHoff"],
    ],
)
def test_the_laws_pass(place, arguments, capsys):
    assert main(["check-law", *arguments]) == 0, capsys.readouterr().out


def test_the_scenario_runs(place):
    assert main(["run", "block.toml", "--out", "made", "--quiet"]) == 0


def test_its_friction_stands_in_a_scenario(place):
    friction = "contacts[0].friction={kind='sand:Rooted', mu=0.3, p0='1 kPa'}"
    assert main(["check", "block.toml", "--quiet", "--set", friction]) == 0
    assert main(["check", "block.toml", "--quiet", "--set", friction.replace("sand:Rooted", "my_law:Stiffening")]) == 2


def test_the_python_runs(place, monkeypatch):
    monkeypatch.syspath_prepend(Path.cwd())
    assert len(place) == 2
    for text in place:
        exec(compile(text, "own_law.md", "exec"), {})
