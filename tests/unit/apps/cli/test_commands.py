"""The command line: exit codes, messages, folders."""

import logging
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import softway.scenario.run
from softway.apps import cli
from softway.apps.cli import commands
from softway.errors import NumericsError
from softway.marching.slab.step_group import in_steps
from softway.record.run import Run

BAR = """
title = "Small bar"

[bodies.bar]
kind = "Solid"
mesh = { kind = "Interval", length = "1 m", cells = 4 }
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

[[output.probes]]
name = "front"
of = "bar"
tag = "right"
quantity = "position"
"""


@pytest.fixture
def file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "bar.toml"
    path.write_text(BAR)
    return path


def folders(path: Path) -> list[str]:
    return sorted(p.name for p in path.iterdir() if p.is_dir())


@pytest.mark.slow
def test_run_show_plot(file, capsys):
    assert cli.main(["run", "bar.toml", "--out", "made"]) == 0
    printed = capsys.readouterr().out
    assert "Small bar" in printed and "wave speed" in printed and "80 slabs" in printed and "first touch" in printed
    run = Run(Path("made"))
    assert run.stop.reason == "done" and run.history["front"].max() == pytest.approx(1.25, abs=1e-12)
    assert run.summary["contacts"]["wall"]["first_touch"] == pytest.approx(0.25, abs=1e-12)
    assert run.summary["energy_error_relative"] < 1e-12
    assert cli.main(["show", "made"]) == 0 and "peak force" in capsys.readouterr().out
    assert cli.main(["plot", "made", "--out", "p.png"]) == 0
    assert Path("p.png").exists() and Path("p_history.png").exists()


def test_the_resolved_scenario_gives_the_same_history(file):
    assert cli.main(["run", "bar.toml", "--out", "a", "--quiet"]) == 0
    assert cli.main(["run", "a/scenario.toml", "--out", "b", "-q"]) == 0
    assert Path("a/history.csv").read_text() == Path("b/history.csv").read_text()
    assert Path("a/scenario.toml").read_text() == Path("b/scenario.toml").read_text()


def test_set_changes_and_quiet_is_quiet(file, capsys):
    change = ["--set", "time.end=1 s", "--set", "bodies.bar.velocity=2 m/s", "--set", "bodies.wall.shape.point=1.5"]
    assert cli.main(["run", "bar.toml", *change, "--quiet"]) == 0
    assert capsys.readouterr().out == ""
    run = Run(Path("runs/bar"))
    assert run.history["time"][-1] == 1.0 and run.events["time"][0] == pytest.approx(0.25, abs=1e-12)


def test_runs_without_a_name_are_numbered(file):
    for _ in range(2):
        assert cli.main(["run", "bar.toml", "--set", "time.end=0.1", "-q"]) == 0
    assert folders(file.parent / "runs") == ["bar", "bar-2"]


def test_check_computes_nothing(file, capsys):
    assert cli.main(["check", "bar.toml"]) == 0
    assert "expected duration" in capsys.readouterr().out and folders(file.parent) == []


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ("bodies.bar.densty=1", "densty"),
        ("bodies.bar.density=5 mm", "bodies.bar.density"),
        ("bodies.bar.density=-1", "bodies.bar.density"),
        ("contacts[0].between=['bar.rihgt', 'wall']", "contacts[0]"),
        ("bodies.wall.shape.point=0.5 m", "contacts[0].between"),
        ("output.probes[0].tag=nothing", "output.probes[0]"),
    ],
)
def test_wrong_input_exits_2_and_leaves_no_folder(file, capsys, change, where):
    assert cli.main(["run", "bar.toml", "--out", "made", "--set", change]) == 2
    found = capsys.readouterr()
    assert where in found.err and "try:" in found.err and "Traceback" not in found.err
    assert folders(file.parent) == []


@pytest.mark.parametrize(
    "arguments",
    [
        ["run", "none.toml"],
        ["run"],
        ["fly"],
        ["show", "none"],
        ["plot", "none"],
        ["new", "none"],
        ["run", "bar.toml", "--no"],
    ],
)
def test_wrong_arguments_exit_2(file, capsys, arguments):
    assert cli.main(arguments) == 2
    assert "error" in capsys.readouterr().err


def test_an_earlier_run_stays(file, capsys):
    assert cli.main(["run", "bar.toml", "--out", "made", "-q"]) == 0
    assert cli.main(["run", "bar.toml", "--out", "made", "-q"]) == 2
    assert "--overwrite" in capsys.readouterr().err
    assert cli.main(["run", "bar.toml", "--out", "made", "-q", "--overwrite", "--set", "time.end=1"]) == 0
    assert Run(Path("made")).history["time"][-1] == 1.0


@pytest.mark.parametrize(
    ("error", "code", "reason"),
    [
        (KeyboardInterrupt(), 130, "interrupted"),
        (NumericsError("no slab converges", 0.5, "a smaller step"), 3, "failed"),
    ],
)
def test_a_run_cut_short_stays_readable(file, capsys, monkeypatch, error, code, reason):
    march = softway.scenario.run.march_in_groups

    def short(*given, **named):
        for k, step in enumerate(in_steps(march(*given, **named))):
            if k == 10:
                raise error
            yield step

    monkeypatch.setattr(softway.scenario.run, "march_in_groups", short)
    assert cli.main(["run", "bar.toml", "--out", "made", "-q"]) == code
    assert "made" in capsys.readouterr().err
    run = Run(Path("made"))
    assert run.history.rows == 11 and run.stop.reason == reason
    assert cli.main(["show", "made"]) == 0 and reason in capsys.readouterr().out
    assert cli.main(["plot", "made"]) == 0


def test_new_lists_and_writes_templates_that_pass_the_check(file, capsys):
    assert cli.main(["new"]) == 0
    names = re.findall(r"^(\w+)  ", capsys.readouterr().out, re.MULTILINE)
    assert "bar" in names
    assert cli.main(["new", "--list"]) == 0 and cli.main(["new", "bar"]) == 2  # bar.toml exists
    assert cli.main(["new", "bar", "--out", "fresh.toml"]) == 0 and cli.main(["check", "fresh.toml", "--quiet"]) == 0


def test_progress_on_a_terminal(file, monkeypatch):
    """With no patience each step is shown; the display is gone afterwards."""
    from io import StringIO

    from rich.console import Console

    from softway.apps.cli.output import progress as cli_progress
    from softway.scenario import run
    from softway.scenario.checks.check import check
    from softway.scenario.files import load

    monkeypatch.setattr(cli_progress, "PATIENCE", 0.0)
    screen = StringIO()
    checked = check(load(file))
    with cli_progress.progress_of(checked, Console(file=screen, force_terminal=True, width=100)) as progress:
        run.run(checked, progress=progress)
        assert progress.watch.display.live.is_started
    assert not progress.watch.display.live.is_started
    assert "energy error" in screen.getvalue() and "ETA" in screen.getvalue()
    with cli_progress.progress_of(checked, Console(file=screen)) as nobody:
        assert nobody is None


def command(*arguments: str, **options) -> subprocess.Popen:
    """A process ``python -m softway``, of the package under test."""
    here = str(Path(softway.__file__).parents[1])
    return subprocess.Popen(
        [sys.executable, "-m", "softway", *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        env={**os.environ, "PYTHONPATH": here}, **options,
    )  # fmt: skip


def test_python_m(tmp_path):
    done = command("--help", cwd=tmp_path)
    printed, _ = done.communicate(timeout=60)
    assert done.returncode == 0 and "run" in printed and "plot" in printed


def test_ctrl_c_in_a_real_process(file):
    """SIGINT ends with 130, without a traceback, and the folder is readable."""
    run = command("run", "bar.toml", "--set", "time.end=4000", "--out", "made", "--quiet")
    history = file.parent / "made" / "history.csv"
    for _ in range(600):
        if history.exists() and history.stat().st_size > 2000:
            break
        time.sleep(0.05)
    run.send_signal(signal.SIGINT)
    _, errors = run.communicate(timeout=30)
    assert run.returncode == 130 and "Traceback" not in errors
    found = Run(file.parent / "made")
    assert found.stop.reason == "interrupted" and found.history.rows > 2 and len(found.fields) >= 1


def test_verbose_tells_what_is_chosen_and_leaves_the_log_as_it_was(file, capsys):
    tree = logging.getLogger("softway")
    before = list(tree.handlers)
    assert cli.main(["run", str(file), "--out", "plain", "--quiet"]) == 0
    assert capsys.readouterr().err == ""
    assert cli.main(["run", str(file), "--out", "told", "-q", "-v"]) == 0
    told = capsys.readouterr().err
    assert "operator Factored" in told and "done after 80 slabs" in told
    assert cli.main(["resume", "told", "--verbose"]) == 0
    assert tree.handlers == before and tree.level == logging.NOTSET


@pytest.mark.parametrize("arguments", [["--version"], ["--help"]])
def test_what_computes_nothing_loads_no_numbers(arguments):
    text = f"import sys; from softway.apps.cli import main; main({arguments}); print('numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "False"


def test_the_first_run_of_an_installation_does_not_compile_slabs(tmp_path):
    text = (
        "from softway.apps.cli import main\n"
        "main(['new', 'bar']); main(['run', 'bar.toml', '--quiet', '--out', 'bar'])\n"
        "from softway.kernels.slab.march import factor, slabs; print(factor.signatures, slabs.signatures)"
    )
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True, cwd=tmp_path)
    assert done.stdout.splitlines()[-1] == "[] []" and (tmp_path / "bar" / "history.csv").exists()


def test_every_command_is_described_before_it_is_loaded(capsys):
    assert cli.main(["--help"]) == 0
    said = " ".join(capsys.readouterr().out.replace("│", " ").split())
    for name in commands.COMMANDS:
        assert f"{name} " in said
    assert "Compute a scenario." in said
    assert "Show a run in the browser: moving mesh, fields, curves, events." in said
