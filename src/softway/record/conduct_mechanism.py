"""Recording of the march of a mechanism: the run folder stays readable however the march ends."""

import json
import logging
import shutil
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from threading import Timer
from time import perf_counter
from typing import Any

from softway.errors import Cancel, Cancelled, Note, NumericsError, heed
from softway.mechanisms.march import MechanismStep
from softway.mechanisms.members.mechanism import Mechanism
from softway.record.read import summary
from softway.record.run import Run
from softway.record.storage import provenance
from softway.record.storage.ending import ending, stored
from softway.record.storage.provenance import DONE, Stop
from softway.record.storage.run_folder import RunFolder
from softway.record.write.mechanism import outline
from softway.record.write.mechanism.probes import BodyReading
from softway.record.write.mechanism.recorder import MechanismRecorder, open_mechanism
from softway.record.write.progress import MechanismProgress, MechanismWatch, Pace, Tell

LOG = logging.getLogger(__name__)
PATIENCE = 2.0
"""Seconds of the first step after which a line tells that it is being compiled."""
COMPILING = "compiling the march of the mechanism: about 15 s, once on this machine"
REMEDY = "free some disk space, then run the scenario again"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MechanismRun:
    """What the records of a mechanism need to know.

    Parameters
    ----------
    mechanism
        The mechanism at the start.
    readings
        Resolved probes.
    until, slabs, every
        End of the march [s], number of slabs (time steps) until then, and between two steps.
    title, texts
        Title, and texts of further files by name: the resolved scenario.
    notes
        Notes on the scenario, which the summary repeats.
    """

    mechanism: Mechanism
    readings: tuple[BodyReading, ...]
    until: float
    slabs: int
    every: int
    title: str
    texts: Mapping[str, str]
    notes: Sequence[Note] = ()


def record_mechanism(
    steps: Iterator[MechanismStep],
    opening: MechanismRun,
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
        Steps of :func:`softway.mechanisms.march`.
    opening
        What the records need to know.
    place
        Folder to create.
    progress
        Callback after each recorded step.
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
    first, early = _first(steps, tell)

    def fill(folder: Path) -> None:
        for name, text in opening.texts.items():
            (folder / name).write_text(text, encoding="utf-8")
        shape = json.dumps(outline.outline(opening.mechanism, opening.readings), indent=1)
        (folder / outline.FILE).write_text(shape + "\n", encoding="utf-8")
        provenance.begin(folder, opening.title, opening.texts, opening.notes)

    with ExitStack() as held:
        with stored(place.out, REMEDY):
            folder = held.enter_context(place.made(fill))
        run = Run(folder.path, folder if place.out is None else None)
        mechanism = opening.mechanism
        try:
            with stored(place.out, REMEDY):
                recorder = open_mechanism(folder.path, tuple(mechanism.bodies), mechanism.dim, opening.readings)
        except BaseException:
            shutil.rmtree(folder.path, ignore_errors=True)
            raise
        begun, pace = perf_counter(), Pace(0.0)
        with ending(partial(_finish, run, recorder, begun, opening)):
            for k, step in enumerate(_chain(first, early, steps)):
                slabs = min(k * opening.every, opening.slabs)
                with stored(run.path, REMEDY):
                    recorder.take(step, slabs)
                if progress is not None:
                    wall, speed = pace.at(step.time)
                    progress(MechanismProgress(step=step, until=opening.until, slabs=slabs, wall=wall, pace=speed))
                heed(cancel, step.time)
    return run


def _first(steps: Iterator[MechanismStep], tell: Tell) -> tuple[MechanismStep | None, BaseException | None]:
    """Compute the state at the start, or return the exception that prevented it; an InputError is raised at once."""
    timer = Timer(PATIENCE, tell, (COMPILING,))
    timer.daemon = True
    timer.start()
    try:
        return next(steps, None), None
    except (KeyboardInterrupt, Cancelled, NumericsError) as error:
        return None, error
    finally:
        timer.cancel()


def _chain(
    first: MechanismStep | None, early: BaseException | None, rest: Iterator[MechanismStep]
) -> Iterator[MechanismStep]:
    if early is not None:
        raise early
    if first is not None:
        yield first
        yield from rest


def _finish(run: Run, recorder: MechanismRecorder, begun: float, opening: MechanismRun, stop: Stop) -> None:
    """Close the records; write summary and provenance."""

    def storing() -> Any:  # after a failure the first exception is the one that is raised
        return stored(run.path, REMEDY) if stop is DONE else suppress(OSError)

    with storing():
        recorder.close()
    numbers, wall = run.numbers, perf_counter() - begun
    with storing():
        record = run.provenance
        ended = {"wall_time": wall, "notes": record.get("notes", []), "stop_reason": stop.reason, "status": stop.reason}
        provenance.save_json(run.path / summary.FILE, {**numbers, **ended})
        provenance.end(run.path, record, stop)
    LOG.info("run '%s' %s after %d slabs, %.3g s wall time", run.path, stop.reason, numbers["slabs"], wall)
