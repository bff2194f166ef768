"""Runs that stopped, however they did, end with the same bits as one that never stopped."""

import json
import logging
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest

import softway
import softway as sw
from records import differences
from softway.apps import cli
from softway.record.storage import provenance
from softway.record.storage.checkpoint import listed
from softway.record.storage.lock import locked
from softway.scenario.files import loads

pytestmark = pytest.mark.slow

BLOCK = (Path(__file__).parents[3] / "robustness" / "inputs" / "marched" / "skid.toml").read_text(encoding="utf-8")
BAR = """
[bodies.bar]
kind = "Solid"
mesh = { kind = "Interval", length = "1 m", cells = 3 }
material = { kind = "LinearElastic", E = "1 Pa" }
density = "1 kg/m^3"
velocity = "1 m/s"

[bodies.wall]
kind = "Tool"
shape = { kind = "HalfSpace", point = "1.25 m", normal = -1 }

[[contacts]]
between = ["bar.right", "wall"]

[time]
end = "3 s"
step = "0.1 s"

[output]
fields_every = "0.7 s"
checkpoints = { every = "0 s", keep = 3 }
"""
SLABS = 30


@pytest.fixture(scope="module")
def whole(tmp_path_factory) -> Path:
    """The run of a bar that nobody stops."""
    folder = tmp_path_factory.mktemp("bar") / "run"
    done = sw.run(loads(BAR), folder)
    assert done.events.rows == 2 and len(done.fields) == 6
    return folder


@pytest.fixture(scope="module")
def skid(tmp_path_factory) -> Path:
    """The run of a block that nobody stops: plastic flow, friction, a probe."""
    folder = tmp_path_factory.mktemp("block") / "run"
    done = sw.run(loads(BLOCK), folder)
    assert done.events.rows > 4 and done.history["dissipation"][-1] > 0.0 and len(done.fields) == 9
    return folder


def stopped(folder: Path, after: int, error: BaseException, text: str = BAR) -> Path:
    """A run that ends with an error after so many slabs."""
    with pytest.raises(type(error)):
        sw.run(loads(text), folder, progress=stopper(after, error))
    return folder


def stopper(after: int, error: BaseException):
    seen = []

    def watch(progress: sw.Progress) -> None:
        seen.append(progress)
        if len(seen) == after:
            raise error

    return watch


@pytest.mark.parametrize("after", [1, 17, SLABS])
def test_an_interrupted_run_goes_on(whole, tmp_path, after):
    folder = stopped(tmp_path / "run", after, KeyboardInterrupt())
    assert sw.Run(folder).stop.reason == "interrupted" and listed(folder)[0].name == f"slab-{after:09d}"
    seen = []
    run = sw.resume(folder, progress=seen.append)
    assert len(seen) == SLABS - after and differences(folder, whole) == []
    (entry,) = run.provenance["resumed"]
    assert entry["slabs"] == after and entry["stopped"] == "interrupted" and entry["changed"] == {}
    assert run.provenance["start"] < entry["at"] < run.provenance["stop"] and run.stop.reason == "done"


@pytest.mark.parametrize(
    "error", [sw.NumericsError("no time step was accepted", 0.5), MemoryError()], ids=lambda e: type(e).__name__
)
def test_a_failed_run_goes_on(whole, tmp_path, error):
    folder = stopped(tmp_path / "run", 9, error, BAR.replace('every = "0 s"', 'every = "1 h"'))
    assert [p.name for p in listed(folder)] == ["slab-000000009"]
    sw.resume(folder)
    assert results(folder, whole) == []


def results(one: Path, other: Path) -> list[str]:
    """What differs between two runs, but for their checkpoints."""
    return [d for d in differences(one, other) if not d.startswith(("scenario.toml", "provenance.json: input"))]


def test_a_run_stopped_many_times(whole, tmp_path):
    """Also within what a resumed run does, and before it has done anything."""
    folder = stopped(tmp_path / "run", 5, KeyboardInterrupt())
    for after in (1, 7, 3):
        with pytest.raises(KeyboardInterrupt):
            sw.resume(folder, progress=stopper(after, KeyboardInterrupt()))
    run = sw.resume(folder)
    assert [r["slabs"] for r in run.provenance["resumed"]] == [5, 6, 13, 16] and differences(folder, whole) == []


def test_without_a_checkpoint_it_begins_again(whole, tmp_path, caplog):
    folder = stopped(tmp_path / "run", 12, KeyboardInterrupt())
    for file in listed(folder):
        file.write_bytes(b"rubbish")
    with caplog.at_level(logging.WARNING):
        run = sw.resume(folder)
    assert caplog.text.count("damaged") == 3 and run.provenance["resumed"][0]["slabs"] == 0
    assert differences(folder, whole) == []


def test_a_damaged_checkpoint_is_named_and_the_one_before_used(whole, tmp_path, caplog):
    folder = stopped(tmp_path / "run", 12, KeyboardInterrupt())
    newest = listed(folder)[0]
    newest.write_bytes(newest.read_bytes()[:5000])
    with caplog.at_level(logging.WARNING):
        run = sw.resume(folder)
    assert str(newest) in caplog.text and run.provenance["resumed"][0]["slabs"] == 11
    assert differences(folder, whole) == []


def test_a_run_that_is_done_stays_as_it_is(whole, capsys):
    before = {p: p.stat().st_mtime_ns for p in whole.iterdir()}
    assert sw.resume(whole).path == whole
    assert cli.main(["resume", str(whole)]) == 0 and "done" in capsys.readouterr().out
    assert {p: p.stat().st_mtime_ns for p in whole.iterdir()} == before


def test_another_scenario_is_refused(tmp_path, capsys):
    folder = stopped(tmp_path / "run", 3, KeyboardInterrupt())
    file = folder / "scenario.toml"
    text = file.read_text()
    before = {p: p.read_bytes() for p in folder.rglob("*") if p.is_file() and p != file}
    file.write_text(text.replace("1.25", "1.26"))
    assert cli.main(["resume", str(folder)]) == 2
    assert "differs from the input at the start of the run" in capsys.readouterr().err
    assert {p: p.read_bytes() for p in before} == before
    file.write_text("# a remark of somebody\n" + text)
    assert cli.main(["resume", str(folder), "-q"]) == 0


def test_another_version_is_refused_and_other_libraries_are_named(tmp_path, monkeypatch, caplog):
    folder = stopped(tmp_path / "run", 3, KeyboardInterrupt())
    monkeypatch.setattr(provenance, "_version", lambda package: "99")
    with pytest.raises(sw.InputError, match="this is softway 99") as error:
        sw.resume(folder)
    assert "pip install" in error.value.remedy
    monkeypatch.undo()
    record = json.loads((folder / "provenance.json").read_text())
    record["versions"]["numpy"] = "0.1"
    (folder / "provenance.json").write_text(json.dumps(record))
    with caplog.at_level(logging.WARNING):
        changed = sw.resume(folder).provenance["resumed"][0]["changed"]
    assert "last digits" in caplog.text and changed.keys() == {"versions"}


def test_parts_built_in_python(tmp_path):
    scenario = loads(BAR)
    bar = scenario.bodies["bar"]
    built = replace(scenario, bodies={**scenario.bodies, "bar": replace(bar, mesh=bar.mesh.build())})
    with pytest.raises(KeyboardInterrupt):
        sw.run(built, tmp_path / "run", progress=stopper(4, KeyboardInterrupt()))
    with pytest.raises(sw.InputError, match="built in Python"):
        sw.resume(tmp_path / "run")
    assert sw.resume(tmp_path / "run", scenario=built).history.rows == SLABS + 1


def test_no_two_write_to_one_folder(tmp_path):
    folder = stopped(tmp_path / "run", 3, KeyboardInterrupt())
    with locked(folder), pytest.raises(sw.InputError, match="still writing"):
        sw.resume(folder)
    with locked(folder), pytest.raises(sw.InputError, match="still writing"):
        sw.run(loads(BAR), folder, overwrite=True)
    with pytest.raises(sw.InputError, match="no run folder"):
        sw.resume(tmp_path)


def test_records_that_lack_something_are_named(tmp_path):
    folder = stopped(tmp_path / "run", 20, KeyboardInterrupt())
    (folder / "history.csv").write_text("time [s]\n")
    with pytest.raises(sw.InputError, match="at the checkpoint"):
        sw.resume(folder)


def command(*arguments: str, **options) -> subprocess.Popen:
    """A process ``python -m softway``, of the package under test."""
    here = str(Path(softway.__file__).parents[1])
    return subprocess.Popen(
        [sys.executable, "-m", "softway", *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        env={**os.environ, "PYTHONPATH": here}, **options,
    )  # fmt: skip


def test_killed_twice(skid, tmp_path):
    """SIGKILL in the run and in what goes on with it; the bits are those of a run in this process."""
    (tmp_path / "block.toml").write_text(BLOCK)
    folder = tmp_path / "run"
    for verb, rows in ((("run", "block.toml", "--out", "run"), 8), (("resume", "run"), 20)):
        process = command(*verb, "--quiet", cwd=tmp_path)
        while process.poll() is None:
            if (folder / "history.csv").is_file() and (folder / "history.csv").read_bytes().count(b"\n") > rows:
                process.send_signal(signal.SIGKILL)
                break
            time.sleep(0.002)
        process.communicate()
        assert process.returncode == -signal.SIGKILL and sw.Run(folder).stop.reason == "interrupted"
    run = sw.resume(folder)
    assert len(run.provenance["resumed"]) == 2 and differences(folder, skid) == []


def limited(size: int):
    """What a process does first that can write no file longer than this [bytes]: it stands for a disk that is full."""

    def limit() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return limit


def test_no_room_for_a_frame(tmp_path):
    """The fields cannot grow: the place is named, what was recorded can be read, and later the run goes on."""
    (tmp_path / "bar.toml").write_text(BAR.replace("0.7 s", "0.1 s"))
    process = command("run", "bar.toml", "--out", "run", "--quiet", cwd=tmp_path, preexec_fn=limited(98000))
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 3 and "Traceback" not in errors
    assert "run: cannot be written: File too large" in errors and "softway resume run" in errors
    run = sw.Run(tmp_path / "run")
    frames = run.fields
    assert 10 < run.history.rows <= SLABS and frames.times[-1] == frames[-1].time and len(frames) > 10
    assert not list(run.path.glob(".*")) and run.stop.reason == "failed" and "cannot be written" in run.stop.message
    sw.resume(run.path)
    assert differences(run.path, sw.run(loads(BAR.replace("0.7 s", "0.1 s")), tmp_path / "whole").path) == []


def test_a_full_disk(whole, tmp_path):
    """File systems in memory that fill up: before the first slab, with a line of a table, with a checkpoint."""
    alone = ["unshare", "--user", "--map-root-user", "--mount"]
    if shutil.which("unshare") is None or subprocess.run([*alone, "true"], capture_output=True).returncode:
        pytest.skip("no file system of one's own here")
    (tmp_path / "bar.toml").write_text(BAR)
    (tmp_path / "disk").mkdir()
    script, sizes = Path(__file__).parents[3] / "robustness" / "full_disk.py", ("60", "132")
    given = [tmp_path / "bar.toml", whole, tmp_path / "disk", *sizes]
    here = os.pathsep.join([str(Path(softway.__file__).parents[1]), str(script.parent)])
    done = subprocess.run(
        [*alone, sys.executable, script, *given], capture_output=True, text=True, timeout=200,
        env={**os.environ, "PYTHONPATH": here},
    )  # fmt: skip
    lines = [line.split(" ", 4) for line in done.stdout.splitlines()]
    assert [line[0] for line in lines] == list(sizes), done.stderr
    assert all(line[1:3] == ["3", "0"] and line[4] == "[]" for line in lines), done.stdout
    assert done.stderr.count("No space left on device") == len(sizes) and "Traceback" not in done.stderr
