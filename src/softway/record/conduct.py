"""Conduct: take the steps of a march one by one, record each, and leave a readable folder however it ends."""

import logging
import shutil
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, ExitStack, contextmanager, suppress
from pathlib import Path
from types import MappingProxyType

from softway.errors import Cancelled, NumericsError, StorageError
from softway.march.step import Step
from softway.record import checkpoint, events, fields, history, provenance, summary
from softway.record.checkpoint import Checkpoint, Checkpoints
from softway.record.keeper import Keeper
from softway.record.lock import held
from softway.record.place import Place
from softway.record.progress import Meter, Watch
from softway.record.provenance import CANCELLED, DONE, INTERRUPTED, Stop
from softway.record.recorder import Opener, Opening, Recorder
from softway.record.run import Run

LOG = logging.getLogger(__name__)
STANDARD: Mapping[str, Opener] = MappingProxyType(
    {history.FILE: history.open_history, events.FILE: events.open_events, fields.FILE: fields.open_fields}
)
"""The records of every run, by the name of their file."""
NO_CHECKPOINTS = Checkpoints(keep=0)


def conduct(
    steps: Iterator[Step],
    opening: Opening,
    place: Place,
    *,
    title: str = "",
    texts: Mapping[str, str] | None = None,
    plan: Checkpoints = NO_CHECKPOINTS,
    progress: Watch | None = None,
) -> Run:
    """Record every step of ``steps``; the folder appears when the first slab is accepted or fails.

    Parameters
    ----------
    steps
        A march.
    opening
        The start of the run.
    place
        Where to.
    title, texts
        For the records: a line, and files by name: the resolved scenario and what it needs beside it.
    plan
        Checkpoints to write; a folder without a name has none.
    progress
        Told of each step after it has been recorded.

    Raises
    ------
    InputError
        Found before the first slab; no folder is left.
    NumericsError, Cancelled, KeyboardInterrupt, StorageError, and what ``progress`` raises
        After the records have been closed; a named folder stays, with the reason in ``provenance.json``.
    """
    first, early = _first(steps)
    given = texts or {}

    def fill(folder: Path) -> None:
        for name, text in given.items():
            (folder / name).write_text(text, encoding="utf-8")
        provenance.begin(folder, title, given)

    with _stored(place.out):
        folder = place.make(fill)
    run = Run(folder.path, folder if place.out is None else None)
    kept = NO_CHECKPOINTS if place.out is None else plan
    with held(folder.path):
        try:
            with _stored(place.out):
                recorders = _opened(folder.path, opening, {})
        except BaseException:
            shutil.rmtree(folder.path, ignore_errors=True)
            raise
        keeper = Keeper(folder.path, kept, recorders, 0.0)
        meter = None if progress is None else Meter(progress, opening.until, opening.initial.time)
        return _carried_on(_chain(first, early, steps), run, keeper, run.provenance, meter)


def proceed(
    steps: Iterator[Step],
    opening: Opening,
    run: Run,
    found: Checkpoint | None,
    *,
    plan: Checkpoints,
    progress: Watch | None = None,
) -> Run:
    """Go on with the records of a run that stopped, cut back to the checkpoint, or from the start where there is none.

    The caller holds the folder.

    Parameters
    ----------
    steps
        The march from the checkpoint on.
    opening
        The start of the run.
    run
        The run that stopped.
    found
        Where it stood.
    plan, progress
        As for :func:`conduct`.

    Raises
    ------
    InputError
        If a record is shorter than it was at the checkpoint.
    NumericsError, Cancelled, KeyboardInterrupt, StorageError, and what ``progress`` raises
        As for :func:`conduct`.
    """
    with _stored(run.path):
        recorders = _opened(run.path, opening, {} if found is None else found.marks)
        slabs, time = (0, 0.0) if found is None else (found.standing.slabs, found.standing.situation.time)
        record = provenance.resume(run.path, run.provenance, slabs, time)
        (run.path / summary.FILE).unlink(missing_ok=True)
    keeper = Keeper(run.path, plan, recorders, 0.0 if found is None else found.wall)
    meter = None if progress is None else Meter(progress, opening.until, time, slabs)
    return _carried_on(steps, run, keeper, record, meter)


def _carried_on(
    steps: Iterator[Step], run: Run, keeper: Keeper, record: Mapping[str, object], meter: Meter | None
) -> Run:
    """Record the steps and finish."""
    stop = Stop("failed", "unexpected error")
    try:
        for step in steps:
            with _stored(run.path):
                _take(keeper, step)
            if meter is not None:
                meter.took(step)
        stop = DONE
    except KeyboardInterrupt:
        stop = INTERRUPTED
        raise
    except Cancelled:
        stop = CANCELLED
        raise
    except (NumericsError, StorageError) as error:
        stop = Stop("failed", str(error))
        raise
    except Exception as error:  # of whoever watches, or a fault of ours: it comes out as it is
        stop = Stop("failed", f"{type(error).__name__}: {error}")
        raise
    finally:
        _finish(run, keeper, record, stop)
    return run


def _opened(folder: Path, opening: Opening, marks: Mapping[str, int]) -> dict[str, Recorder]:
    """The records, all of them or none, cut back to their marks."""
    found: dict[str, Recorder] = {}
    with ExitStack() as failing:
        for name, start in STANDARD.items():
            found[name] = start(folder, opening, marks.get(name))
            failing.callback(found[name].close)
        failing.pop_all()
    return found


def _first(steps: Iterator[Step]) -> tuple[Step | None, BaseException | None]:
    """The first step, or what prevented it; wrong input is raised at once."""
    try:
        return next(steps, None), None
    except (KeyboardInterrupt, Cancelled, NumericsError) as error:
        return None, error


def _chain(first: Step | None, early: BaseException | None, rest: Iterator[Step]) -> Iterator[Step]:
    if early is not None:
        raise early
    if first is not None:
        yield first
        yield from rest


def _take(keeper: Keeper, step: Step) -> None:
    for recorder in keeper.recorders.values():
        recorder.take(step)
    keeper.took(step.standing)


@contextmanager
def _stored(place: Path | None) -> Iterator[None]:
    """Say where there was no room, and that the run can go on once there is."""
    try:
        yield
    except OSError as error:
        name = str(place or "temporary folder")
        problem = f"cannot be written: {error.strerror or error}"
        raise StorageError(name, problem, f"make room, then softway resume {name}") from error


def _finish(run: Run, keeper: Keeper, record: Mapping[str, object], stop: Stop) -> None:
    """Write a last checkpoint or forget them all, close the records, then the summary, then the provenance that says
    it is over.
    """

    def storing() -> AbstractContextManager[None]:  # of a run that went wrong, what did so first is what is raised
        return _stored(run.path) if stop is DONE else suppress(OSError)

    with storing(), ExitStack() as closing:
        for recorder in keeper.recorders.values():
            closing.callback(recorder.close)
        if stop is not DONE:
            keeper.write()
    numbers = summary.summarise(run.history, run.events)
    with storing():
        provenance.save_json(run.path / summary.FILE, {**numbers, "wall_time": keeper.wall, "stop_reason": stop.reason})
        provenance.end(run.path, record, stop)
        if stop is DONE:
            checkpoint.forget(run.path)
    LOG.info("run '%s' %s after %d slabs, %.3g s on the clock", run.path, stop.reason, numbers["slabs"], keeper.wall)
