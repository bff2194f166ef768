"""Recording of the march of a mechanism, a pile or conductors: the run folder stays readable however it ends."""

import json
import logging
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack, suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from threading import Timer
from typing import Any, Literal, Protocol

from softway.errors import Cancel, Note, heed
from softway.heat.march import HeatStep
from softway.mechanisms.step import MechanismGroup, MechanismStep
from softway.piles.march import PileStep
from softway.record.first_step import chained, first_step
from softway.record.read import summary
from softway.record.run import Run
from softway.record.storage import checkpoint, provenance
from softway.record.storage.checkpoint import NO_CHECKPOINTS, Checkpoint, Checkpoints
from softway.record.storage.ending import ending, recording
from softway.record.storage.provenance import DONE, Stop
from softway.record.storage.run_folder import RunFolder
from softway.record.write.checkpoint_schedule import CheckpointWriter, Marked
from softway.record.write.progress import MechanismProgress, MechanismWatch, Pace, Tell

LOG = logging.getLogger(__name__)
PATIENCE = 2.0
"""Seconds of the first step after which a line tells that it is being compiled."""
COMPILING = "compiling the march of the {}: about 15 s, once on this machine"
Step = MechanismStep | PileStep | HeatStep
One = Step | MechanismGroup
"""A step, or states of a mechanism that were compiled together."""


class StepFiles(Protocol):
    """Recorder that takes the steps of a march in order, with its open files by name."""

    @property
    def files(self) -> Mapping[str, Marked]:
        """Open files by name."""
        ...

    def take(self, step: Any, slabs: int) -> None:
        """Write a step after a number of slabs (time steps)."""
        ...

    def close(self) -> None:
        """Close the files."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RigidRun:
    """What the records of a mechanism, a pile or conductors need to know.

    Parameters
    ----------
    what
        ``mechanism``, ``pile`` or ``conductors``.
    opened
        Function that opens the records in a folder, truncated to their marks.
    until, slabs, every
        End of the march [s], number of slabs (time steps) until then, and between two steps.
    title, texts
        Title, and texts of further files by name: the resolved scenario.
    outline
        Name and content of the file that tells the parts at the start.
    notes
        Notes on the scenario, which the summary repeats.
    plan
        Schedule of the checkpoints; a temporary folder has none.
    """

    what: Literal["mechanism", "pile", "conductors"]
    opened: Callable[[Path, Mapping[str, int]], StepFiles]
    until: float
    slabs: int
    every: int
    title: str
    texts: Mapping[str, str]
    outline: tuple[str, Mapping[str, Any]]
    notes: Sequence[Note] = ()
    plan: Checkpoints = NO_CHECKPOINTS


def record_rigid(
    steps: Iterator[One],
    opening: RigidRun,
    place: RunFolder,
    *,
    progress: MechanismWatch | None = None,
    cancel: Cancel | None = None,
    tell: Tell = LOG.info,
) -> Run:
    """Record every step of ``steps``; the folder is created when the state at the start is known.

    Parameters
    ----------
    steps
        Steps of :func:`softway.mechanisms.march`, which may be grouped, :func:`softway.piles.march` or
        :func:`softway.heat.march_heat`.
    opening
        What the records need to know.
    place
        Folder to create.
    progress
        Callback after each recorded step, or group.
    cancel
        Function called after each step; the run stops when it returns True.
    tell
        Function that receives a line while the march is compiled.

    Raises
    ------
    InputError
        For wrong input; no folder is left.
    NumericsError, Cancelled, KeyboardInterrupt, StorageError, and any exception of ``progress``
        After the records have been closed; a named folder stays, with the reason in ``provenance.json``.
    """
    first, early = _first(steps, opening.what, tell)

    def fill(folder: Path) -> None:
        for name, text in opening.texts.items():
            (folder / name).write_text(text, encoding="utf-8")
        name, parts = opening.outline
        (folder / name).write_text(json.dumps(parts, indent=1) + "\n", encoding="utf-8")
        provenance.begin(folder, opening.title, opening.texts, opening.notes)

    with ExitStack() as held:
        with recording(place.out):
            folder = held.enter_context(place.made(fill))
        run = Run(folder.path, folder if place.out is None else None)
        try:
            recorder = _opened(run, opening, {})
        except BaseException:
            shutil.rmtree(folder.path, ignore_errors=True)
            raise
        plan = NO_CHECKPOINTS if place.out is None else opening.plan
        keeper = CheckpointWriter(folder.path, plan, recorder.files, 0.0)
        chain = chained(first, early, steps)
        return _carried_on(chain, opening, run, recorder, keeper, run.provenance, (0, 0.0), progress, cancel)


def continue_rigid(
    steps: Iterator[One],
    opening: RigidRun,
    run: Run,
    found: Checkpoint | None,
    *,
    progress: MechanismWatch | None = None,
    cancel: Cancel | None = None,
    tell: Tell = LOG.info,
) -> Run:
    """Continue the records of a stopped run from its checkpoint, or from the start if there is no checkpoint.

    The records are truncated to their lengths at the checkpoint.  The caller holds the lock of the folder.

    Parameters
    ----------
    steps
        Steps of the march from the checkpoint on.
    opening
        What the records need to know.
    run
        The stopped run.
    found
        Its last checkpoint, if any.
    progress, cancel, tell
        As for :func:`record_rigid`.

    Raises
    ------
    InputError
        If a record is shorter than it was at the checkpoint.
    NumericsError, Cancelled, KeyboardInterrupt, StorageError, and any exception of ``progress``
        As for :func:`record_rigid`.
    """
    recorder = _opened(run, opening, {} if found is None else found.marks)
    at = (0, 0.0) if found is None else (found.march_state.slabs + opening.every, found.time)
    with recording(run.path):
        record = provenance.resume(run.path, run.provenance, 0 if found is None else found.march_state.slabs, at[1])
        (run.path / summary.FILE).unlink(missing_ok=True)
    keeper = CheckpointWriter(run.path, opening.plan, recorder.files, 0.0 if found is None else found.wall)
    chain = chained(*_first(steps, opening.what, tell), steps)
    return _carried_on(chain, opening, run, recorder, keeper, record, at, progress, cancel)


def _opened(run: Run, opening: RigidRun, marks: Mapping[str, int]) -> StepFiles:
    """Open the records, truncated to their marks."""
    with recording(run.path):
        return opening.opened(run.path, marks)


def _carried_on(
    steps: Iterator[One],
    opening: RigidRun,
    run: Run,
    recorder: StepFiles,
    keeper: CheckpointWriter,
    record: Mapping[str, Any],
    at: tuple[int, float],
    progress: MechanismWatch | None,
    cancel: Cancel | None,
) -> Run:
    """Record all steps, the first of them ``at`` a number of slabs, and finish the run."""
    first, time = at
    pace = Pace(time)
    with ending(partial(_finish, run, recorder, keeper, record)):
        for k, one in enumerate(steps):
            step = one.step(len(one) - 1) if isinstance(one, MechanismGroup) else one
            slabs = min(first + k * opening.every, opening.slabs)
            if isinstance(one, MechanismGroup):
                slabs = int(one.slabs[-1])
            with recording(run.path):
                recorder.take(one, slabs)
                if keeper.plan.keep:  # only mechanisms keep states of before
                    keeper.took(step.march_state if isinstance(step, MechanismStep) else step.march_state())
            if progress is not None:
                wall, speed = pace.at(step.time)
                progress(MechanismProgress(step=step, until=opening.until, slabs=slabs, wall=wall, pace=speed))
            heed(cancel, step.time)
    return run


def _first(steps: Iterator[One], what: str, tell: Tell) -> tuple[One | None, BaseException | None]:
    """The state at the start, see :func:`first_step`; a line tells if it is being compiled."""
    timer = Timer(PATIENCE, tell, (COMPILING.format(what),))
    timer.daemon = True
    timer.start()
    try:
        return first_step(steps)
    finally:
        timer.cancel()


def _finish(run: Run, recorder: StepFiles, keeper: CheckpointWriter, record: Mapping[str, Any], stop: Stop) -> None:
    """Write a last checkpoint, or remove all of them after success; close the records; write summary and provenance."""

    def storing() -> AbstractContextManager[None]:  # after a failure the first exception is the one that is raised
        return recording(run.path) if stop is DONE else suppress(OSError)

    with storing(), ExitStack() as closing:
        closing.callback(recorder.close)
        if stop is not DONE:
            keeper.write()
    numbers = run.numbers
    with storing():
        ended = {"wall_time": keeper.wall, "notes": record.get("notes", [])}
        provenance.save_json(
            run.path / summary.FILE, {**numbers, **ended, "stop_reason": stop.reason, "status": stop.reason}
        )
        provenance.end(run.path, record, stop)
        if stop is DONE:
            checkpoint.forget(run.path)
    LOG.info("run '%s' %s after %d slabs, %.3g s wall time", run.path, stop.reason, numbers["slabs"], keeper.wall)
