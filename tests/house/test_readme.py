"""The examples of the README run as they stand there."""

import re
import tomllib
from pathlib import Path

import pytest

import softway as sw


@pytest.fixture(scope="module")
def blocks(root: Path) -> dict[str, str]:
    """First code block of each language."""
    found = re.findall(
        r"^```(\w+)\n(.*?)^```", (root / "README.md").read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL
    )
    return dict(reversed(found))


def test_the_python_example_runs(blocks: dict[str, str], capsys: pytest.CaptureFixture[str]) -> None:
    names: dict[str, object] = {}
    exec(compile(blocks["python"], "README.md", "exec"), names)
    run = names["run"]
    assert len(capsys.readouterr().out.splitlines()) == 2
    touch, release = run.events["time"]
    assert touch == pytest.approx(0.3, abs=1e-10)
    assert release == pytest.approx(2.3, abs=2.5 / 20.0)


def test_the_scenario_is_right(blocks: dict[str, str], tmp_path: Path) -> None:
    path = tmp_path / "bar.toml"
    path.write_text(blocks["toml"])
    scenario = sw.load(path)
    assert scenario.bodies.keys() == tomllib.loads(blocks["toml"])["bodies"].keys()
    assert 'E = "210000000000.0 Pa"' in sw.dumps(scenario)
    assert sw.run(scenario).summary["contacts"]


def test_the_table_of_exit_codes_is_the_one_of_the_command(blocks: dict[str, str], tmp_path: Path) -> None:
    from softway.apps.cli import main

    path = tmp_path / "bar.toml"
    path.write_text(blocks["toml"])
    assert main(["check", str(path), "--quiet"]) == 0
    path.write_text(blocks["toml"].replace("cells", "cell"))
    assert main(["check", str(path)]) == 2
