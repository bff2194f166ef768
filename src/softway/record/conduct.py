"""Recording of a march: each step is recorded, and the run folder stays readable however the march ends."""

import logging
import shutil
from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack, suppress
from functools import partial
from pathlib import Path
from types import MappingProxyType

from softway.errors import Note
from softway.marching.results.step import Step
from softway.marching.slab.step_group import StepGroup
from softway.record.audit.watch import watcher
from softway.record.first_step import chained, first_step
from softway.record.read import summary
from softway.record.run import Run
from softway.record.storage import checkpoint, provenance
from softway.record.storage.checkpoint import NO_CHECKPOINTS, Checkpoint, Checkpoints
from softway.record.storage.ending import ending, recording
from softway.record.storage.provenance import DONE, Stop
from softway.record.storage.run_folder import RunFolder
from softway.record.write import events, fields, history
from softway.record.write.checkpoint_schedule import CheckpointWriter
from softway.record.write.mechanism import rigid_table
from softway.record.write.progress import Meter, Watch
from softway.record.write.recorder import Opener, Recorder, RunStart

LOG = logging.getLogger(__name__)
STANDARD: Mapping[str, Opener] = MappingProxyType(
    {
        history.FILE: history.open_history,
        events.FILE: events.open_events,
        fields.FILE: fields.open_fields,
        rigid_table.FILE: rigid_table.open_rigid_table,
    }
)
"""Openers of the records of a run, by file name; the last one only with rigid bodies."""


def record_run(
    steps: Iterator[Step | StepGroup],
    opening: RunStart,
    place: RunFolder,
    *,
    title: str = "",
    texts: Mapping[str, str] | None = None,
    notes: Sequence[Note] = (),
    plan: Checkpoints = NO_CHECKPOINTS,
    progress: Watch | None = None,
    ranks: int = 0,
) -> Run:
    """Record every step of ``steps``; the folder is created when the first time step (slab) is accepted or fails.

    Parameters
    ----------
    steps
        Steps of a march, or groups of slabs that were compiled together.
    opening
        Start of the run.
    place
        Folder to create.
    title, texts
        Title, and texts of further files by name: the resolved scenario and the modules that it needs.
    notes
        Notes on the scenario, which the summary repeats.
    plan
        Schedule of the checkpoints; a temporary folder has none.
    progress
        Callback after each recorded step, or group.
    ranks
        Number of ranks that march; 0 for one process without ranks.

    Raises
    ------
    InputError
        For wrong input, found before the first slab; no folder is left.
    NumericsError, Cancelled, KeyboardInterrupt, StorageError, and any exception of ``progress``
        After the records have been closed; a named folder stays, with the reason in ``provenance.json``.
    """
    steps = _parts(steps, opening)
    steps = watcher(opening).watched(steps) if opening.audit else steps
    first, early = first_step(steps)
    given = texts or {}

    def fill(folder: Path) -> None:
        for name, text in given.items():
            (folder / name).write_text(text, encoding="utf-8")
        provenance.begin(folder, title, given, notes, ranks)

    with ExitStack() as held:
        with recording(place.out):
            folder = held.enter_context(place.made(fill))
        run = Run(folder.path, folder if place.out is None else None)
        kept = NO_CHECKPOINTS if place.out is None else plan
        try:
            with recording(place.out):
                recorders = _opened(folder.path, opening, {})
        except BaseException:
            shutil.rmtree(folder.path, ignore_errors=True)
            raise
        keeper = CheckpointWriter(folder.path, kept, recorders, 0.0)
        meter = None if progress is None else Meter(progress, opening.until, opening.initial.time)
        return _carried_on(chained(first, early, steps), run, recorders, keeper, run.provenance, meter)


def continue_run(
    steps: Iterator[Step | StepGroup],
    opening: RunStart,
    run: Run,
    found: Checkpoint | None,
    *,
    plan: Checkpoints,
    progress: Watch | None = None,
) -> Run:
    """Continue the records of a stopped run from its checkpoint, or from the start if there is no checkpoint.

    The records are truncated to their lengths at the checkpoint.  The caller holds the lock of the folder.

    Parameters
    ----------
    steps
        Steps of the march from the checkpoint on.
    opening
        Start of the run.
    run
        The stopped run.
    found
        Its last checkpoint, if any.
    plan, progress
        As for :func:`record_run`.

    Raises
    ------
    InputError
        If a record is shorter than it was at the checkpoint.
    NumericsError, Cancelled, KeyboardInterrupt, StorageError, and any exception of ``progress``
        As for :func:`record_run`.
    """
    with recording(run.path):
        recorders = _opened(run.path, opening, {} if found is None else found.marks)
        slabs, time = (0, 0.0) if found is None else (found.march_state.slabs, found.time)
        record = provenance.resume(run.path, run.provenance, slabs, time)
        (run.path / summary.FILE).unlink(missing_ok=True)
    keeper = CheckpointWriter(run.path, plan, recorders, 0.0 if found is None else found.wall)
    meter = None if progress is None else Meter(progress, opening.until, time, slabs)
    steps = _parts(steps, opening)
    if opening.audit:
        audit = watcher(opening)
        audit.past(run.history)
        steps = audit.watched(steps)
    return _carried_on(steps, run, recorders, keeper, record, meter)


def _parts(steps: Iterator[Step | StepGroup], opening: RunStart) -> Iterator[Step | StepGroup]:
    """Steps and groups of slabs, with a step of each slab at whose end a frame is stored."""
    for one in steps:
        if isinstance(one, StepGroup):
            yield from opening.parts(one)
        else:
            yield one


def _carried_on(
    steps: Iterator[Step | StepGroup],
    run: Run,
    recorders: Mapping[str, Recorder],
    keeper: CheckpointWriter,
    record: Mapping[str, object],
    meter: Meter | None,
) -> Run:
    """Record all steps and finish the run."""
    with ending(partial(_finish, run, recorders, keeper, record)):
        for one in steps:
            with recording(run.path):
                _take(recorders, keeper, one)
            if meter is not None:
                meter.took(one)
    return run


def _opened(folder: Path, opening: RunStart, marks: Mapping[str, int]) -> dict[str, Recorder]:
    """Open all records, truncated to their marks; if one fails, close the others."""
    found: dict[str, Recorder] = {}
    with ExitStack() as failing:
        for name, start in STANDARD.items():
            if name == rigid_table.FILE and opening.scene.mechanism is None:
                continue
            found[name] = start(folder, opening, marks.get(name))
            failing.callback(found[name].close)
        failing.pop_all()
    return found


def _take(recorders: Mapping[str, Recorder], keeper: CheckpointWriter, one: Step | StepGroup) -> None:
    for recorder in recorders.values():
        if isinstance(one, StepGroup):
            recorder.take_group(one)
        else:
            recorder.take(one)
    keeper.took(lambda: one.march_state)


def _finish(
    run: Run, recorders: Mapping[str, Recorder], keeper: CheckpointWriter, record: Mapping[str, object], stop: Stop
) -> None:
    """Write a last checkpoint, or remove all of them after success; close the records; write summary and provenance."""

    def storing() -> AbstractContextManager[None]:  # after a failure the first exception is the one that is raised
        return recording(run.path) if stop is DONE else suppress(OSError)

    with storing(), ExitStack() as closing:
        for recorder in recorders.values():
            closing.callback(recorder.close)
        if stop is not DONE:
            keeper.write()
    numbers = summary.summarise(run.history, run.events)
    with storing():
        notes, status = record.get("notes", []), summary.status(stop.reason, numbers)
        ended = {"wall_time": keeper.wall, "notes": notes, "stop_reason": stop.reason, "status": status}
        provenance.save_json(run.path / summary.FILE, {**numbers, **ended})
        provenance.end(run.path, record, stop)
        if stop is DONE:
            checkpoint.forget(run.path)
    LOG.info("run '%s' %s after %d slabs, %.3g s wall time", run.path, stop.reason, numbers["slabs"], keeper.wall)
