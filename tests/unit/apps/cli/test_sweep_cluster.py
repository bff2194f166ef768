"""A sweep on a Dask scheduler of its own processes: a worker that is lost, and a scheduler that has none."""

import json
import logging
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path

import pytest

import softway as sw
from softway.record.run import Run
from softway.scenario.text.templates import templates
from softway.studies.sweep.cluster import answers_from, connected

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore")]
distributed = pytest.importorskip("distributed")

VALUES = {"bodies.bar.mesh.cells": [120, 121]}
CHANGES = ("time.end=0.6 s", "solver.kind=Newton", "output.checkpoints.every=0 s")
SECONDS, LOOK = 300.0, 0.05


class Cluster:
    """A scheduler and workers in processes of their own, as two commands start them."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.started = [self._dask("scheduler", "--port", "0", "--no-dashboard")]
        waited(self._written)  # the file exists before it has its content

    @property
    def _file(self) -> Path:
        return self.folder / "scheduler.json"

    def _written(self) -> bool:
        return self._file.exists() and self._file.read_text().rstrip().endswith("}")

    def _dask(self, *words: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", "dask", *words, "--host", "127.0.0.1", "--scheduler-file", str(self._file)]
        with (self.folder / f"{words[0]}.log").open("ab") as log:
            return subprocess.Popen(command, cwd=self.folder, stdout=log, stderr=log)

    @property
    def address(self) -> str:
        """Address of the scheduler."""
        return str(json.loads(self._file.read_text())["address"])

    def worker(self) -> subprocess.Popen[bytes]:
        """Start a worker that computes one run at a time and does not start again when it dies."""
        self.started.append(self._dask("worker", "--nthreads", "1", "--no-nanny", "--no-dashboard"))
        return self.started[-1]

    def end(self) -> None:
        """End all processes."""
        for process in reversed(self.started):
            process.kill()
            process.wait()


def waited(until: Callable[[], bool]) -> None:
    """Wait until something holds."""
    for _ in range(round(SECONDS / LOOK)):
        if until():
            return
        time.sleep(LOOK)
    pytest.fail(f"it does not hold after {SECONDS:g} s")


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Cluster]:
    """A scheduler without a worker."""
    made = Cluster(tmp_path)
    yield made
    made.end()


def test_the_run_of_a_lost_worker_goes_on_with_another(cluster: Cluster, tmp_path: Path) -> None:
    file = tmp_path / "bar.toml"
    file.write_text(templates()["bar"])
    found: list[sw.studies.Sweep] = []
    asked = {"changes": CHANGES, "scheduler": cluster.address, "out": tmp_path / "there"}
    thread = threading.Thread(target=lambda: found.append(sw.sweep(file, VALUES, **asked)))
    first = cluster.worker()
    thread.start()
    waited(lambda: any(h.read_bytes().count(b"\n") > 20 for h in tmp_path.glob("there/*/history.csv")))
    first.kill()
    cluster.worker()
    thread.join(SECONDS)
    assert not thread.is_alive() and [row.stop.reason for row in found[0].rows] == ["done"] * 2
    begun = next(row for row in found[0].rows if Run(row.folder).provenance.get("resumed"))
    cells = begun.values["bodies.bar.mesh.cells"]
    whole = sw.run(sw.load(file, [*CHANGES, f"bodies.bar.mesh.cells={cells}"]), tmp_path / "whole")
    for name in ("time", "energy_kinetic", "contact.wall.force_n"):
        assert (Run(begun.folder).history[name] == whole.history[name]).all()


def test_a_scheduler_without_workers_is_told(
    cluster: Cluster, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(import_module(answers_from.__module__), "PATIENCE", 0.5)
    caplog.set_level(logging.WARNING, "softway")

    def cancel() -> bool:
        return "no worker" in caplog.text

    with pytest.raises(sw.Cancelled, match="1 left"):
        list(answers_from(connected(cluster.address), [1.0], time.sleep, cancel))
    assert f"dask worker {cluster.address}" in caplog.text
