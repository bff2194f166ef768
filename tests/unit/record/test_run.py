"""Runs: how they end, what they leave, how they are read back."""

import gc
import json

import numpy as np
import pytest

from softway.errors import InputError, NumericsError
from softway.record.conduct import record_run
from softway.record.read.summary import summarise
from softway.record.run import Run
from softway.record.storage.provenance import Stop
from softway.record.storage.run_folder import RunFolder
from softway.record.storage.table import Table, parse
from softway.record.write.history_columns import CERTIFICATE, COLUMNS


def broken(fake, after, error):
    """Steps that end with an error."""
    for k, step in enumerate(fake.steps()):
        if k == after:
            raise error
        yield step


def test_a_whole_run(fake, tmp_path):
    seen = []
    run = record_run(
        fake.steps(),
        fake.opening(),
        RunFolder(out=tmp_path / "a" / "run"),
        title="Drop",
        texts={"scenario.toml": "title = 'Drop'\n"},
        progress=seen.append,
    )
    assert len(seen) == fake.slabs and run.history.rows == fake.slabs + 1
    assert run.stop == Stop("done") and run.scenario == "title = 'Drop'\n"
    assert sorted(p.name for p in run.path.iterdir()) == [
        "events.csv", "fields.vtkhdf", "history.csv", "provenance.json", "scenario.toml", "summary.json",
    ]  # fmt: skip
    summary, contact = run.summary, run.summary["contacts"]["part.surface-floor"]
    assert summary["slabs"] == fake.slabs and summary["wall_time"] > 0.0
    spans = run.history["h"][1:]
    assert (summary["slab_shortest"], summary["slab_longest"]) == (spans.min(), spans.max())  # as given
    assert summary["energy_error_worst"] == 1e-12  # as given
    assert contact["first_touch"] == 0.4 and contact["last_release"] == 0.6 and contact["touches"] == 1  # as given
    force = run.history["contact.part.surface-floor.force_n"]
    assert contact["peak_force"] == force.max() and contact["impulse"] == pytest.approx(0.05 * force.sum(), rel=1e-12)
    assert contact["penetration_worst"] == -run.history["contact.part.surface-floor.min_gap"].min() > 0.0
    assert run.provenance["versions"]["numpy"] == np.__version__ and run.provenance["stop"] >= run.provenance["start"]


def test_wrong_input_leaves_no_folder(bar, tmp_path):
    with pytest.raises(InputError):
        record_run(broken(bar, 0, InputError("time.step", "too long")), bar.opening(), RunFolder(out=tmp_path / "run"))
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("after", [0, 5])
@pytest.mark.parametrize(
    ("error", "reason"), [(KeyboardInterrupt(), "interrupted"), (NumericsError("no convergence", 0.25), "failed")]
)
def test_a_run_cut_short_keeps_what_was_computed(bar, tmp_path, after, error, reason):
    with pytest.raises(type(error)):
        record_run(broken(bar, after, error), bar.opening(), RunFolder(out=tmp_path / "run"))
    run = Run(tmp_path / "run")
    assert run.history.rows == after + 1 and run.stop.reason == reason and run.stop.message == str(error)
    assert run.summary["slabs"] == after and len(run.fields) == 1 + after // 2


def test_an_interrupt_while_recording_leaves_a_readable_folder(bar, tmp_path):
    def pressed(progress):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        record_run(bar.steps(), bar.opening(), RunFolder(out=tmp_path / "run"), progress=pressed)
    assert Run(tmp_path / "run").history.rows == 2


def test_a_running_folder_is_readable(bar, tmp_path):
    lengths = []

    def look(progress):
        run = Run(tmp_path / "run")
        assert run.stop.reason == "running" and run.summary["time_end"] == progress.time
        lengths.append((run.history.rows, len(run.fields), run.events.rows))

    record_run(bar.steps(), bar.opening(), RunFolder(out=tmp_path / "run"), progress=look)
    assert lengths[0] == (2, 1, 0) and lengths[-1] == (21, 11, 2)


def test_without_a_name_the_records_live_as_long_as_what_reads_them(bar):
    run = record_run(bar.steps(), bar.opening(), RunFolder())
    path, fields = run.path, run.fields
    del run
    gc.collect()
    assert len(fields) == 11
    del fields
    gc.collect()
    assert not path.exists()


def test_an_earlier_run_is_not_overwritten_by_accident(bar, tmp_path):
    place = RunFolder(out=tmp_path / "run")
    record_run(bar.steps(), bar.opening(), place)
    with pytest.raises(InputError, match="already holds a run"):
        record_run(bar.steps(), bar.opening(), place)
    again = RunFolder(out=place.out, overwrite=True)
    with pytest.raises(InputError, match="wrong"):
        record_run(broken(bar, 0, InputError("x", "wrong")), bar.opening(), again)
    assert Run(place.out).history.rows == 21
    (place.out / "old").touch()
    assert not (record_run(bar.steps(), bar.opening(), again).path / "old").exists()


def test_other_folders_are_never_overwritten(bar, tmp_path):
    (tmp_path / "precious").touch()
    for place in (RunFolder(out=tmp_path, overwrite=True), RunFolder(out=tmp_path / "precious")):
        with pytest.raises(InputError):
            place.check()
    assert (tmp_path / "precious").exists()


def test_no_run_folder(tmp_path):
    with pytest.raises(InputError, match="no run folder"):
        Run(tmp_path)


def test_a_scene_without_contacts_and_nothing_yet():
    columns = [(c.name, c.unit) for c in (*COLUMNS, *CERTIFICATE)]
    head = ",".join(f"{name} [{unit}]" for name, unit in columns) + "\n"
    assert summarise(Table({}), Table({})) == {"slabs": 0, "contacts": {}, "findings": []}
    found = summarise(parse(head + ",".join("0" * len(columns)) + "\n"), Table({}))
    assert found["energy_error_relative"] is None and found["contacts"] == {} and json.dumps(found)
