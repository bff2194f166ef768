"""Conduct: take the steps of a march one by one, record each, and leave a readable folder however it ends."""

import shutil
import time as clock
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from softway.errors import InputError, NumericsError
from softway.march.step import Step
from softway.record import provenance, summary
from softway.record.events import open_events
from softway.record.fields import open_fields
from softway.record.history import open_history
from softway.record.provenance import DONE, INTERRUPTED, Stop
from softway.record.recorder import Opener, Opening, Recorder
from softway.record.run import Run, Scratch, scratch

Progress = Callable[[Step], None]
STANDARD: tuple[Opener, ...] = (open_history, open_events, open_fields)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Place:
    """Where the records go.

    Parameters
    ----------
    out
        Folder to be made; ``None`` for a temporary one that lives as long as its :class:`Run`.
    overwrite
        Whether a run folder of that name may be replaced.
    """

    out: Path | None = None
    overwrite: bool = False

    def check(self) -> None:
        """Refuse a folder that holds something else, before anything is computed."""
        if self.out is None or not self.out.exists():
            return
        if not self.out.is_dir():
            raise InputError("out", f"'{self.out}' is a file", "the name of a folder")
        ours = (self.out / provenance.FILE).is_file()
        if any(self.out.iterdir()) and not (ours and self.overwrite):
            known = "already holds a run" if ours else "is not empty"
            raise InputError("out", f"'{self.out}' {known}", "another folder" + (", or --overwrite" if ours else ""))

    def make(self) -> Scratch:
        """Make the folder, empty."""
        if self.out is None:
            return scratch()
        self.check()
        if self.out.exists():
            shutil.rmtree(self.out)
        self.out.mkdir(parents=True)
        return Scratch(self.out)


def conduct(
    steps: Iterator[Step],
    opening: Opening,
    place: Place,
    *,
    title: str = "",
    texts: Mapping[str, str] | None = None,
    progress: Progress | None = None,
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
    progress
        Called with each step after it has been recorded.

    Raises
    ------
    InputError
        Found before the first slab; no folder is left.
    NumericsError, KeyboardInterrupt
        After the records have been closed; a named folder stays, with the reason in ``provenance.json``.
    """
    begun = clock.perf_counter()
    first, early = _first(steps)
    folder = place.make()
    recorders: list[Recorder] = []
    try:
        record = provenance.begin(folder.path, title)
        for name, text in (texts or {}).items():
            (folder.path / name).write_text(text, encoding="utf-8")
        recorders.extend(start(folder.path, opening) for start in STANDARD)
    except BaseException:
        shutil.rmtree(folder.path, ignore_errors=True)
        raise
    run = Run(folder.path, folder if place.out is None else None)
    stop = Stop("failed", "unexpected error")
    try:
        if early is not None:
            raise early
        for step in _chain(first, steps):
            _take(recorders, step)
            if progress is not None:
                progress(step)
        stop = DONE
    except KeyboardInterrupt:
        stop = INTERRUPTED
        raise
    except NumericsError as error:
        stop = Stop("failed", str(error))
        raise
    finally:
        _finish(run, recorders, record, stop, clock.perf_counter() - begun)
    return run


def _first(steps: Iterator[Step]) -> tuple[Step | None, BaseException | None]:
    """The first step, or what prevented it; wrong input is raised at once."""
    try:
        return next(steps, None), None
    except (KeyboardInterrupt, NumericsError) as error:
        return None, error


def _chain(first: Step | None, rest: Iterator[Step]) -> Iterator[Step]:
    if first is not None:
        yield first
        yield from rest


def _take(recorders: list[Recorder], step: Step) -> None:
    for recorder in recorders:
        recorder.take(step)


def _finish(run: Run, recorders: list[Recorder], record: object, stop: Stop, wall: float) -> None:
    """Close the records, then the summary, then the provenance that says it is over."""
    with ExitStack() as closing:
        for recorder in recorders:
            closing.callback(recorder.close)
    numbers = summary.summarise(run.history, run.events)
    provenance.save_json(run.path / summary.FILE, {**numbers, "wall_time": wall, "stop_reason": stop.reason})
    provenance.end(run.path, record, stop)  # type: ignore[arg-type]
