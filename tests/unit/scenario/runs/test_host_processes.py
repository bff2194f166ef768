"""A host program calls off what goes on in processes, and begins it in a thread."""

import multiprocessing
import threading
import time

import pytest

import softway as sw
from softway.apps.verify import chosen, verified
from softway.record.run import Run
from softway.scenario.text.templates import templates
from softway.studies.processes import answers

pytestmark = pytest.mark.slow

CELLS = "bodies.bar.mesh.cells"


@pytest.fixture
def file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bar.toml").write_text(templates()["bar"])
    return tmp_path / "bar.toml"


def test_a_sweep_cancelled_during_a_run_is_continued(file):
    """From another thread, while the second of three runs, a long one, is going on; its folder is in order."""
    off, seen, raised = threading.Event(), [], []
    values, changes = {"time.end": ["0.1 s", "2000 s", "0.2 s"]}, ("output.checkpoints.every=0 s",)

    def work() -> None:
        try:
            sw.sweep(file, values, changes=changes, watch=lambda row, left: seen.append(row), cancel=off.is_set)
        except sw.Cancelled as error:
            raised.append(str(error))

    thread = threading.Thread(target=work)
    thread.start()
    long = file.parent / "sweeps" / "bar"
    while not [f for f in long.glob("*/history.csv") if seen and f.read_bytes().count(b"\n") > 20]:
        assert thread.is_alive()
        time.sleep(0.05)
    off.set()
    thread.join(60)
    assert not thread.is_alive() and raised == ["cancelled with 2 left"]
    stops = sorted(Run(f).stop.reason for f in long.iterdir() if f.is_dir())
    assert stops == ["done", "interrupted"]
    rows = sw.sweep(file, {"time.end": ["0.1 s", "0.2 s"]}, changes=changes).rows
    assert [row.stop.reason for row in rows] == ["done"] * 2


@pytest.mark.filterwarnings("ignore")
def test_workers_of_dask_are_left_to_what_they_have_begun(file):
    distributed = pytest.importorskip("distributed")
    seen, values = [], {"time.end": ["0.1 s", "0.2 s", "0.3 s"]}
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None) as there:
        asked = {"scheduler": there.scheduler_address, "cancel": lambda: bool(seen)}
        with pytest.raises(sw.Cancelled):
            sw.sweep(file, values, watch=lambda row, left: seen.append(left), **asked)
    assert 1 <= len(seen) < 3


def test_the_suite_is_cancelled():
    seen = []
    with pytest.raises(sw.Cancelled, match="1 left"):
        verified(chosen(("A01", "A02")), watch=seen.append, cancel=lambda: bool(seen))
    assert len(seen) == 1


def test_no_worker_process_remains():
    before = time.perf_counter()
    with pytest.raises(sw.Cancelled, match="2 left"):
        list(answers([30.0, 30.0], time.sleep, 2, cancel=lambda: time.perf_counter() - before > 0.5))
    assert not multiprocessing.active_children()
