"""Ctrl-C at any instant ends a run with exit code 130 and a folder that can be resumed; no interruption is lost."""

import os
import random
import signal
import subprocess
import sys
import threading
import time
import weakref
from pathlib import Path

import pytest

import softway as sw
from softway.apps.cli import main
from softway.interrupts import raised_again
from softway.record.storage import checkpoint
from softway.record.storage.journal import JournaledFile
from softway.record.storage.uninterrupted import uninterrupted
from softway.scenario.files import loads

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
end = "END s"
step = "0.1 s"

[output]
fields_every = "0.1 s"
checkpoints = { every = "0 s", keep = 2 }
"""


@pytest.fixture(autouse=True)
def interruptible():
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def pressed(*_: object) -> None:
    """Ctrl-C, as the system sends it to the process."""
    os.kill(os.getpid(), signal.SIGINT)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # a file that was just being opened
def test_ctrl_c_at_many_instants(tmp_path, capsys):
    """A long run with a frame and a checkpoint after every slab, interrupted after random waits."""
    (tmp_path / "bar.toml").write_text(BAR.replace("END", "100000"))
    chance = random.Random(8)
    for number in range(25):
        folder, over = tmp_path / f"run{number}", threading.Event()
        wait = chance.uniform(0.0, 0.1)

        def press(folder: Path = folder, wait: float = wait, over: threading.Event = over) -> None:
            while not (folder / "history.csv").is_file() and not over.is_set():
                time.sleep(1e-3)
            time.sleep(wait)
            pressed()

        thread = threading.Thread(target=press)
        thread.start()
        code = main(["run", str(tmp_path / "bar.toml"), "--out", str(folder), "--quiet"])
        over.set()
        thread.join()
        told = capsys.readouterr().err
        assert code == 130 and "interrupted" in told and "Traceback" not in told and "ignored" not in told, told
        if folder.exists():
            run = sw.Run(folder)
            assert run.stop.reason == "interrupted"  # a journal may stay, as after a kill: the next writer undoes it
            times = run.fields.times
            assert [f.time for f in run.fields] == list(times) and run.history.rows >= len(times)
            assert checkpoint.last(folder) is not None or run.history.rows <= 2
    assert sum((tmp_path / f"run{number}").exists() for number in range(25)) > 1


def test_work_in_progress_is_done_before_the_interruption_is_raised():
    done = []

    def work() -> None:
        pressed()
        time.sleep(0.05)
        done.append(True)

    with pytest.raises(KeyboardInterrupt):
        uninterrupted(work)
    assert done == [True]


def test_errors_and_results_come_out_of_the_work():
    assert uninterrupted(lambda: threading.current_thread() is threading.main_thread()) is False
    with pytest.raises(ZeroDivisionError):
        uninterrupted(lambda: 1 / 0)


@pytest.mark.parametrize("call", ["seek", "write"])
def test_an_interruption_inside_of_hdf5_is_not_lost(tmp_path, monkeypatch, call):
    """HDF5 calls back into Python, where an exception is printed and lost, with the data that were to be written."""
    plain, calls = getattr(JournaledFile, call), []

    def interrupting(self: JournaledFile, *given: object) -> object:
        calls.append(call)
        if len(calls) == 600:
            pressed()
        return plain(self, *given)

    monkeypatch.setattr(JournaledFile, call, interrupting)
    with pytest.raises(KeyboardInterrupt):
        sw.run(loads(BAR.replace("END", "1000")), tmp_path / "run")
    monkeypatch.undo()
    run = sw.Run(tmp_path / "run")
    assert run.stop.reason == "interrupted" and 1 <= len(run.fields) <= run.history.rows
    assert [frame.time for frame in run.fields] == list(run.fields.times)


def test_an_interrupted_checkpoint_is_complete(tmp_path, monkeypatch):
    plain = checkpoint.packed_arrays

    def interrupting(arrays: dict) -> bytes:
        pressed()
        return plain(arrays)

    monkeypatch.setattr(checkpoint, "packed_arrays", interrupting)
    with pytest.raises(KeyboardInterrupt):
        sw.run(loads(BAR.replace("END", "1000")), tmp_path / "run")
    monkeypatch.undo()
    assert checkpoint.last(tmp_path / "run").march_state.slabs >= 1


def test_an_interruption_that_a_clean_up_replaces_is_one(tmp_path):
    """As the archives of Python do when they are closed."""

    def watch(progress: sw.Progress) -> None:
        try:
            raise KeyboardInterrupt
        finally:
            raise ValueError("cannot be closed now")

    with pytest.raises(KeyboardInterrupt):
        sw.run(loads(BAR.replace("END", "3")), tmp_path / "run", progress=watch)
    assert sw.Run(tmp_path / "run").stop.reason == "interrupted"


class Thing:
    """What a weak reference may point to."""


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="no timers that interrupt")
def test_an_interruption_that_a_finaliser_swallows_comes_again(capfd):
    before = signal.getsignal(signal.SIGALRM)
    with pytest.raises(KeyboardInterrupt):
        swallowed()
    signal.signal(signal.SIGALRM, before)
    assert "Traceback" not in capfd.readouterr().err


def swallowed() -> None:
    """Lose an interruption in the callback of a weak reference."""
    with raised_again():
        thing = Thing()
        reference = weakref.ref(thing, lambda _: signal.default_int_handler(signal.SIGINT, None))
        del thing
        assert reference() is None
        time.sleep(20.0)


WORKER = """
import os, signal, sys, time
from softway.studies import processes

if __name__ == "__main__":
    started = processes.SpawnProcess.start
    def interrupted(process):
        started(process)
        for _ in range(3):
            os.kill(process.pid, signal.SIGINT)  # while it loads its modules
    processes.SpawnProcess.start = interrupted
    print([a for _, a, _ in processes.answers(["a", "bb"], len, 1)])
"""


@pytest.mark.slow
def test_workers_that_are_interrupted_while_they_start_are_quiet(tmp_path):
    (tmp_path / "script.py").write_text(WORKER)
    here = str(Path(sw.__file__).parents[1])
    done = subprocess.run(
        [sys.executable, tmp_path / "script.py"], capture_output=True, text=True, timeout=300, check=False,
        env={**os.environ, "PYTHONPATH": here},
    )  # fmt: skip
    assert done.stdout == "[1, 2]\n" and "Traceback" not in done.stderr, done.stderr
