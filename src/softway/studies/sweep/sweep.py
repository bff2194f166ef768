"""Sweep: runs of a scenario for all combinations of some values, with one table."""

from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

from softway.errors import Cancel, InputError
from softway.record.storage import provenance
from softway.record.storage.provenance import DONE
from softway.studies.processes import Complaint, answers
from softway.studies.sweep.attempt import Attempt, carried_out
from softway.studies.sweep.cluster import answers_from, connected
from softway.studies.sweep.plan import trials
from softway.studies.sweep.rows import Row, Sweep, ordered, row_of, save

Watch = Callable[[Row, int], None]


def sweep(
    file: str | Path,
    over: Mapping[str, Sequence[object]],
    *,
    out: str | Path | None = None,
    changes: Iterable[str] = (),
    jobs: int = 1,
    scheduler: str | None = None,
    again: bool = False,
    allow_python: bool = False,
    watch: Watch | None = None,
    cancel: Cancel | None = None,
) -> Sweep:
    """Compute a scenario with every combination of some values, in separate processes, and write one table.

    A repeated call keeps the runs that are done, resumes the runs that stopped, and computes new ones.
    A run that fails has a row with the reason; it does not affect the other runs.

    Parameters
    ----------
    file
        Scenario in TOML.
    over
        Values by path, such as ``{"bodies.bar.velocity": ["1 m/s", "2 m/s"]}``.
    out
        Folder of the sweep, with a folder for each run; by default ``sweeps/`` and the name of the file.
    changes
        Changes ``path=value`` for all runs.
    jobs
        Number of parallel processes. They are spawned: in a script, call this under ``if __name__ == "__main__":``.
    scheduler
        Address of a Dask scheduler whose workers compute instead; they must have access to the same files.
    again
        Compute runs that failed before again.
    allow_python
        Allow ``module:name`` in the scenario to name an installed module.
    watch
        Called after each run, with its row and the number of runs left.
    cancel
        Called several times per second; returns True to stop. Dask workers finish the runs that they have begun.

    Raises
    ------
    InputError
        If one of the combinations is wrong; nothing has been computed.
    Cancelled, KeyboardInterrupt
        If the sweep was stopped; the same call resumes it.
    """
    if not isinstance(file, str | Path):
        raise InputError("file", f"{file!r:.60} is not a path", "the path of a scenario file")
    source, place = Path(file), _place(file, out)
    attempts = [
        Attempt(
            trial=trial,
            file=source.resolve(),
            changes=tuple(changes),
            folder=place / trial.name,
            allow_python=allow_python,
        )
        for trial in trials(over)
    ]
    for attempt in attempts:
        attempt.require()
    todo = [a for a in attempts if _left(a, again)]
    coming = _answers(todo, jobs, scheduler, cancel)
    try:
        place.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(
            "--out", f"cannot create '{place}': {error.strerror}", "a folder that can be written"
        ) from None
    return _collected(attempts, coming, len(todo), place, watch)


def _collected(
    attempts: Sequence[Attempt],
    coming: Generator[tuple[Attempt, Any, float], None, None],
    left: int,
    place: Path,
    watch: Watch | None,
) -> Sweep:
    """Collect the results; the table is written after each run."""
    rows: dict[str, Row] = {}
    try:
        with closing(coming):
            for attempt, answer, wall in coming:
                complaint = answer.text if isinstance(answer, Complaint) else ""
                row = rows[attempt.trial.name] = row_of(attempt, complaint, wall)
                save(Sweep(path=place, rows=ordered(attempts, rows)))
                left -= 1
                if watch is not None:
                    watch(row, left)
    finally:
        done = Sweep(path=place, rows=ordered(attempts, rows))
        save(done)
    return done


def _answers(
    todo: Sequence[Attempt], jobs: int, scheduler: str | None, cancel: Cancel | None
) -> Generator[tuple[Attempt, Any, float], None, None]:
    """Compute in processes, or on the Dask scheduler if one is given."""
    if jobs < 1:
        raise InputError("--jobs", f"{jobs}", "1 or more")
    if scheduler is None:
        return answers(todo, carried_out, jobs, cancel)
    return answers_from(connected(scheduler), todo, carried_out, cancel)


def _left(attempt: Attempt, again: bool) -> bool:
    """True if the run is not finished."""
    stop = attempt.stop
    return stop is None or (stop.reason == "failed" and again) or (stop.reason != "failed" and stop != DONE)


def _place(file: str | Path, out: str | Path | None) -> Path:
    """Folder of the sweep; it must not be a run folder."""
    place = (Path("sweeps") / Path(file).stem if out is None else Path(out)).resolve()
    if place.exists() and not place.is_dir():
        raise InputError("--out", f"'{place}' is a file", "the name of a folder")
    if (place / provenance.FILE).is_file():
        raise InputError("--out", f"'{place}' holds a run", "another folder")
    return place
