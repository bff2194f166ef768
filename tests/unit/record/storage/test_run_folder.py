"""Run folders under races: one run gets a new folder, and readers tell a run that goes on from one that was killed."""

import json
import os
import signal
import subprocess
import sys
import threading
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

import softway
from softway.apps.cli import main
from softway.errors import InputError, StorageError
from softway.record.conduct import record_run
from softway.record.run import Run
from softway.record.storage import provenance
from softway.record.storage.lock import locked, written_now
from softway.record.storage.provenance import Stop
from softway.record.storage.run_folder import LONGEST, RunFolder

MAKER = """
import sys
from pathlib import Path
from softway.errors import InputError
from softway.record.storage.run_folder import RunFolder
out = Path(sys.argv[1])
print("ready", flush=True)
sys.stdin.readline()
try:
    with RunFolder(out=out, overwrite=sys.argv[2] == "yes").made(lambda folder: (folder / "provenance.json").touch()):
        print("mine", flush=True)
        sys.stdin.readline()
except InputError as error:
    print(str(error).splitlines()[0], flush=True)
"""
"""Process that makes a run folder and holds it until a line comes in."""


def process(code: str, *arguments: object) -> subprocess.Popen:
    here = str(Path(softway.__file__).parents[1])
    return subprocess.Popen(
        [sys.executable, "-c", code, *map(str, arguments)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        env={**os.environ, "PYTHONPATH": here},
    )  # fmt: skip


@pytest.mark.parametrize("number", [2, 5])
@pytest.mark.parametrize("overwrite", [False, True])
def test_of_the_threads_that_run_into_one_new_folder_one_runs(bar, tmp_path, number, overwrite):
    """All others are refused, with a message that names the folder; nothing else is left."""
    for attempt in range(4):
        out, begun = tmp_path / f"run{attempt}", threading.Barrier(number)

        def computed(_: int, out: Path = out, begun: threading.Barrier = begun) -> str:
            waited = []

            def rest(progress: object) -> None:
                if not waited:
                    waited.append(begun.wait(60))

            try:
                run = record_run(bar.steps(), bar.opening(), RunFolder(out=out, overwrite=overwrite), progress=rest)
            except InputError as error:
                begun.wait(60)
                return str(error)
            return run.stop.reason

        with ThreadPoolExecutor(number) as pool:
            told = Counter(pool.map(computed, range(number)))
        assert told.pop("done") == 1
        assert all(str(out) in one and ("still writing" in one or "already holds a run" in one) for one in told)
        assert Run(out).history.rows == 21 and Run(out).stop == Stop("done")
    assert sorted(p.name for p in tmp_path.iterdir()) == [f"run{attempt}" for attempt in range(4)]


@pytest.mark.slow
@pytest.mark.parametrize("overwrite", ["no", "yes"])
def test_of_the_processes_that_run_into_one_new_folder_one_runs(tmp_path, overwrite):
    out = tmp_path / "run"
    makers = [process(MAKER, out, overwrite) for _ in range(3)]
    assert [maker.stdout.readline() for maker in makers] == ["ready\n"] * 3
    for maker in makers:
        maker.stdin.write("go\n")
        maker.stdin.flush()
    told = [maker.stdout.readline().strip() for maker in makers]
    assert told.count("mine") == 1 and written_now(out) is True
    assert all("still writing" in one or "already holds a run" in one for one in told if one != "mine")
    for maker in makers:
        maker.communicate()
    assert written_now(out) is False and [p.name for p in tmp_path.iterdir()] == ["run"]


def test_what_a_killed_process_left_is_made_again(bar, tmp_path):
    partial = tmp_path / ".run.partial"
    (partial / "checkpoints").mkdir(parents=True)
    (partial / "my_law.py").touch()
    run = record_run(bar.steps(), bar.opening(), RunFolder(out=tmp_path / "run"))
    assert [p.name for p in tmp_path.iterdir()] == ["run"] and not (run.path / "my_law.py").exists()


def test_readers_do_not_hinder_a_writer(tmp_path):
    """The look of a reader never keeps a run from its folder."""
    over = threading.Event()

    def look() -> None:
        while not over.is_set():
            written_now(tmp_path)

    with ThreadPoolExecutor(3) as pool:
        for _ in range(3):
            pool.submit(look)
        try:
            for _ in range(200):
                with locked(tmp_path) as ours:
                    assert ours and written_now(tmp_path) is True
        finally:
            over.set()
    assert written_now(tmp_path) is False


KILLED = """
import sys
from pathlib import Path
from softway.record.storage import provenance
from softway.record.storage.run_folder import RunFolder
with RunFolder(out=Path(sys.argv[1])).made(lambda folder: provenance.begin(folder, "", {})):
    print("mine", flush=True)
    sys.stdin.readline()
"""


def test_a_killed_run_is_interrupted_and_a_living_one_runs(bar, tmp_path, capsys):
    record_run(bar.steps(), bar.opening(), RunFolder(out=tmp_path / "whole"))
    writer = process(KILLED, tmp_path / "run")
    assert writer.stdout.readline() == "mine\n"
    for name in ("history.csv", "events.csv", "fields.vtkhdf"):
        (tmp_path / "run" / name).write_bytes((tmp_path / "whole" / name).read_bytes())
    assert Run(tmp_path / "run").stop == Stop("running")
    writer.send_signal(signal.SIGKILL)
    writer.communicate()
    assert Run(tmp_path / "run").stop == Stop("interrupted")
    assert main(["show", str(tmp_path / "run")]) == 0
    told = capsys.readouterr().out
    assert "interrupted" in told and f"resume with: softway resume {tmp_path / 'run'}" in told


def test_what_runs_on_another_machine_cannot_be_told(tmp_path):
    with RunFolder(out=tmp_path / "run").made(lambda folder: provenance.begin(folder, "", {})):
        pass
    file = tmp_path / "run" / provenance.FILE
    file.write_text(json.dumps({**json.loads(file.read_text()), "host": "faraway"}))
    assert Run(tmp_path / "run").stop == Stop("running", "on faraway, as far as can be told from here")


def test_a_run_that_ends_while_it_is_looked_at_is_done():
    """The record said that it runs, and the lock was free a moment later."""
    records = iter(["running", "done"])
    found = provenance.stop_of(Path(__file__).parent, lambda: {"stop_reason": next(records), "message": ""})
    assert found == Stop("done")


@pytest.mark.parametrize("length", [LONGEST + 1, 300, 5000])
def test_a_name_that_is_too_long_is_refused_before_anything_is_computed(tmp_path, length):
    for out in (tmp_path / ("x" * length), tmp_path / ("x" * length) / "run"):
        if out.name == "run" and length <= 255:
            continue
        with pytest.raises(InputError, match="out: '.*'") as error:
            RunFolder(out=out).check()
        assert "shorter name" in error.value.remedy
    RunFolder(out=tmp_path / ("x" * LONGEST)).check()


def test_the_present_folder_is_refused(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for out in (Path(), tmp_path):
        with pytest.raises(InputError, match="present folder"):
            RunFolder(out=out).check()


def test_a_folder_that_cannot_be_filled_leaves_nothing(bar, tmp_path):
    def full(folder: Path) -> None:
        raise OSError(28, "No space left on device")

    with pytest.raises(OSError, match="space"), RunFolder(out=tmp_path / "run").made(full):
        pytest.fail("it was made")
    assert not list(tmp_path.iterdir())
    with pytest.raises(StorageError):
        record_run(bar.steps(), bar.opening(), RunFolder(out=tmp_path / "run"), texts={"no/folder": ""})
