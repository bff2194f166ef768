"""The verb ``sweep``: its runs, its table, what stops and goes on, and what is refused."""

import csv
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import softway as sw
from softway.apps.cli import main
from softway.record.run import Run
from softway.scenario.text.templates import templates
from softway.studies.sweep.plan import parsed, trials

pytestmark = pytest.mark.slow

CELLS = "bodies.bar.mesh.cells"
SHORT = ("--over", f"{CELLS}=4,5", "--over", "bodies.bar.velocity=1 m/s,50 cm/s", "--set", "time.end=0.4 s")

FAILING = ("--set", "solver.kind=FixedPoint", "--set", "time.end=0.5 s")


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a scenario, to work in."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bar.toml").write_text(templates()["bar"])
    return tmp_path


def lines(here: Path) -> list[dict[str, str]]:
    """The table of the sweep."""
    return list(csv.DictReader((here / "sweeps/bar/sweep.csv").read_text().splitlines()))


def test_every_combination_is_a_run_and_a_row(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sweep", "bar.toml", *SHORT, "--jobs", "2"]) == 0
    told = capsys.readouterr().out
    assert told.count("done") == 4 and "sweep.csv" in told
    rows = lines(here)
    assert [(r[f"{CELLS} [-]"], r["bodies.bar.velocity [-]"]) for r in rows] == [
        ("4", "1 m/s"),
        ("4", "50 cm/s"),
        ("5", "1 m/s"),
        ("5", "50 cm/s"),
    ]
    for row in rows:
        run = Run(here / "sweeps/bar" / row["run [-]"])
        assert float(row["energy_error_worst [J]"]) == run.summary["energy_error_worst"]
        assert int(row["slabs [1]"]) == run.summary["slabs"]
        speed = {"1 m/s": 1.0, "50 cm/s": 0.5}[row["bodies.bar.velocity [-]"]]
        assert run.history["energy_kinetic"][0] == pytest.approx(0.5 * speed**2, rel=1e-12)
    further_values_compute_only_themselves(here)


def further_values_compute_only_themselves(here: Path) -> None:
    """Of the same sweep with one more value; another scenario is refused in its folder."""
    values, seen = {CELLS: [4, 5, 6], "bodies.bar.velocity": ["1 m/s"]}, []
    more = sw.sweep(
        "bar.toml", values, changes=SHORT[-1:], watch=lambda row, left: seen.append((row.values[CELLS], left))
    )
    assert seen == [("6", 0)] and not more.failed
    assert list(more.table["stop"]) == ["done"] * 3 and more.table.units["wall_time"] == "s"
    assert "resumed" not in Run(more.rows[0].folder).provenance
    with pytest.raises(sw.InputError, match="another scenario"):
        sw.sweep("bar.toml", values, changes=["time.end=0.3 s"])


def test_a_run_that_fails_is_a_row_and_is_repeated_on_request(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A single iteration cannot solve a slab."""
    words = ["sweep", "bar.toml", "--over", "solver.limit=1,60", *FAILING, "--jobs", "1"]
    assert main(words) == 3
    assert "failed" in capsys.readouterr().out
    rows = lines(here)
    assert [r["stop [-]"] for r in rows] == ["failed", "done"] and rows[0]["reason [-]"]
    note = here / "sweeps/bar" / rows[0]["run [-]"] / "provenance.json"
    before = note.read_bytes()
    assert main(words) == 3
    assert note.read_bytes() == before
    assert main([*words, "--again"]) == 3
    assert note.read_bytes() != before


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT for another process")
def test_an_interrupted_sweep_goes_on_with_the_same_bits(here: Path) -> None:
    words = ["sweep", "bar.toml", "--over", f"{CELLS}=200", "--set", "time.end=0.4 s", "--jobs", "1"]
    process = subprocess.Popen([sys.executable, "-m", "softway", *words], stderr=subprocess.PIPE)
    folder = here / "sweeps/bar" / trials({CELLS: [200]})[0].name
    try:
        for _ in range(600):
            if (folder / "history.csv").is_file() and Run(folder).history.rows > 3:
                break
            time.sleep(0.05)
        os.kill(process.pid, signal.SIGINT)
        _, told = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == 130 and b"same command" in told and b"Traceback" not in told
    assert Run(folder).stop.reason == "interrupted" and Run(folder).history.rows > 3
    assert lines(here)[0]["stop [-]"] == "interrupted"
    (here / "sweeps/bar/sweep.csv").unlink()
    assert main(words) == 0
    whole = sw.run(sw.load("bar.toml", [f"{CELLS}=200", "time.end=0.4 s"]))
    assert len(Run(folder).provenance["resumed"]) == 1
    assert (Run(folder).history["energy_kinetic"] == whole.history["energy_kinetic"]).all()


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ([], "nothing to sweep over"),
        (["--over", CELLS], "gives no values"),
        (["--over", f"{CELLS}=4,,5"], "a value is missing"),
        (["--over", f"{CELLS}=4,4"], "twice"),
        (["--over", f"{CELLS}=4", "--over", f"{CELLS}=5"], "twice"),
        (["--over", "bodies.bar.densty=4,5"], "did you mean 'density'"),
        (["--over", f"{CELLS}=4,none"], "whole number"),
        (["--over", "bodies.bar.velocity=1 m/s,1 kg"], "velocity"),
        (["--over", f"{CELLS}=4", "--jobs", "0"], "--jobs"),
        (["--over", f"{CELLS}=4", "--out", "bar.toml"], "is a file"),
    ],
)
def test_wrong_input_is_found_before_anything_runs(
    words: list[str], told: str, here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["sweep", "bar.toml", *words]) == 2
    assert told in capsys.readouterr().err
    assert [p.name for p in here.iterdir()] == ["bar.toml"]


def test_values_are_parted_outside_brackets_and_quotes() -> None:
    assert parsed(["a.b=[1,0],[2,0]", "c='x,y',z"]) == {"a.b": ("[1,0]", "[2,0]"), "c": ("'x,y'", "z")}
    assert [t.changes for t in trials({"a": [True, (1, 2)]})] == [("a=true",), ("a=[1, 2]",)]
    one, other = trials({"a": [1], "b": [2]})[0], trials({"b": [2], "a": [1]})[0]
    assert one.name == other.name


def test_without_dask_the_command_that_installs_it_is_named(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(sw.InputError, match="Dask is not installed") as caught:
        sw.sweep("bar.toml", {CELLS: [4]}, scheduler="tcp://127.0.0.1:8786")
    assert "softway[dask]" in caught.value.remedy
    assert not (here / "sweeps").exists()


@pytest.mark.filterwarnings("ignore")
def test_the_workers_of_dask_compute_the_same(here: Path) -> None:
    distributed = pytest.importorskip("distributed")
    values, changes = {"solver.limit": [1, 60]}, FAILING[1::2]
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
    ) as cluster:
        there = sw.sweep("bar.toml", values, changes=changes, out="there", scheduler=cluster.scheduler_address)
    ours = sw.sweep("bar.toml", values, changes=changes, out="ours")
    assert [row.stop.reason for row in there.rows] == [row.stop.reason for row in ours.rows] == ["failed", "done"]
    for name in set(ours.rows[1].numbers) - {"wall_time"}:
        assert there.rows[1].numbers[name] == ours.rows[1].numbers[name]
