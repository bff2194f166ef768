"""The command ``softway race``."""

import json
from io import StringIO
from pathlib import Path
from time import sleep

import pytest
from rich.console import Console

from softway.apps import cli
from softway.apps.cli.output import progress
from softway.apps.cli.output.tables import ranking
from softway.scenario.built import built
from softway.scenario.files import load
from softway.solve.methods.fixed_point import FixedPoint
from softway.studies.race.contest import contest
from softway.studies.race.report import record

BAR = """
title = "Small bar"

[bodies.bar]
kind = "Solid"
mesh = { kind = "Interval", length = "1 m", cells = 2 }
material = { kind = "LinearElastic", E = "1 Pa" }
density = "1 kg/m^3"
velocity = "1 m/s"

[bodies.wall]
kind = "Tool"
shape = { kind = "HalfSpace", point = "1.25 m", normal = -1 }

[[contacts]]
name = "wall"
between = ["bar.right", "wall"]

[time]
end = "4 s"
step = "0.05 s"
"""


@pytest.fixture
def file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "bar.toml"
    path.write_text(BAR)
    return path


def test_all_methods_in_a_table_a_file_and_a_picture(file, capsys):
    assert cli.main(["race", "bar.toml", "--slabs", "3", "--tolerance", "1e-9"]) == 0
    printed = capsys.readouterr().out
    for word in ("Small bar", "plain", "accelerated", "modified", "newton", "penalty", "factorisations", "CPU time"):
        assert word in printed
    found = json.loads(Path("races/bar/race.json").read_text())
    assert len(found["methods"]) == 5 and found["title"] == "Small bar" and "[bodies.bar]" in found["scenario"]
    assert {m["slabs"] for m in found["methods"].values()} == {3}
    assert {m["tolerance"] for m in found["methods"].values()} == {1e-9}
    assert Path("races/bar/race.png").exists()
    assert cli.main(["race", "bar.toml", "--slabs", "2", "--methods", "plain", "-q"]) == 0
    assert Path("races/bar-2/race.json").exists() and not capsys.readouterr().out


def test_some_methods_with_the_tolerance_of_the_scenario(file):
    arguments = ["race", "bar.toml", "--methods", "newton", "penalty", "--slabs", "1", "--out", "made", "-q"]
    assert cli.main([*arguments, "--set", "solver.kind=FixedPoint", "--set", "solver.tolerance=1e-7"]) == 0
    found = json.loads(Path("made/race.json").read_text())
    assert list(found["methods"]) == ["newton", "penalty"]
    assert found["methods"]["newton"]["tolerance"] == 1e-7  # as given
    assert cli.main(arguments) == 2 and cli.main([*arguments, "--overwrite"]) == 0


@pytest.mark.parametrize(
    ("arguments", "where"),
    [
        (["--methods", "fast"], "methods"),
        (["--slabs", "0"], "--slabs"),
        (["--tolerance", "1"], "tolerance"),
        (["--set", "bodies.bar.density=-1"], "bodies.bar.density"),
    ],
)
def test_wrong_input_exits_2_and_leaves_no_folder(file, capsys, arguments, where):
    assert cli.main(["race", "bar.toml", *arguments]) == 2
    found = capsys.readouterr()
    assert where in found.err and "try:" in found.err and "Traceback" not in found.err
    assert not Path("races").exists()


def started(display):
    """Wait until a display is there: another thread shows it."""
    for _ in range(3000):
        if display.live.is_started:
            return
        sleep(0.01)
    pytest.fail("nothing is shown")


def test_progress_on_a_terminal(monkeypatch):
    monkeypatch.setattr(progress, "PATIENCE", -1.0)
    screen = StringIO()
    with progress.laps_of(("plain", "newton"), 2.0, Console(file=screen, force_terminal=True, width=100)) as watch:
        watch("plain", 1.0)
        watch("plain", 2.0)
        watch("newton", 1.0)
        started(watch.display)
    assert "plain" in screen.getvalue() and "ETA" in screen.getvalue()
    with progress.laps_of(("plain",), 2.0, Console(file=screen)) as nobody:
        assert nobody is None


def test_a_method_that_failed_is_named_with_its_reason(file):
    """One iteration a slab is not enough at the wall."""
    scene = built(load(file))
    methods = {"hasty": FixedPoint(limit=1, handover=False), "patient": FixedPoint()}
    found = record(contest(scene, until=0.5, step=0.05, methods=methods))
    screen = StringIO()
    ranking(found, Console(file=screen, width=100))
    assert (
        "hasty: accelerated fixed point; failed: t = " in screen.getvalue()
        and "no time step was accepted" in screen.getvalue()
    )
    assert "'patient'" in screen.getvalue()
