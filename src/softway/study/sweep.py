"""Sweep: the runs of a scenario over the product of some values, and one table of them."""

from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

from softway.crew import Complaint, answers
from softway.errors import Cancel, InputError
from softway.record import provenance
from softway.record.provenance import DONE
from softway.study.attempt import Attempt, carried_out
from softway.study.cluster import answers_from, connected
from softway.study.plan import trials
from softway.study.rows import Row, Sweep, ordered, row_of, save

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
    """Compute a scenario with every combination of some values, each in a process of its own, and write one table.

    Called again it leaves runs that are done as they are, goes on with those that stopped, and computes new ones.
    A run that fails is a row with its reason; it does not reach another.

    Parameters
    ----------
    file
        Scenario in TOML.
    over
        Values by path, as ``{"bodies.bar.velocity": ["1 m/s", "2 m/s"]}``.
    out
        Folder with a folder for each run; by default ``sweeps/`` and the name of the file.
    changes
        ``path=value`` each, for all runs.
    jobs
        Processes beside each other.  They are started anew: a script calls this under ``if __name__ == "__main__":``.
    scheduler
        Address of a Dask scheduler, whose workers compute instead; they have to see the same files.
    again
        Whether runs that failed before are computed again.
    allow_python
        Whether ``module:name`` in the scenario may also name an installed module.
    watch
        Called with each run that ends, and the number of those left.
    cancel
        Asked a few times a second whether the caller wants no more; workers of Dask end what they have begun.

    Raises
    ------
    InputError
        Something is wrong with one of the combinations; nothing has been computed.
    Cancelled, KeyboardInterrupt
        The same call goes on from there.
    """
    if not isinstance(file, str | Path):
        raise InputError("file", f"{file!r:.60} is no path", "a scenario file: its text is what each run changes")
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
        raise InputError("--out", f"cannot make '{place}': {error.strerror}", "a folder that can be written") from None
    return _collected(attempts, coming, len(todo), place, watch)


def _collected(
    attempts: Sequence[Attempt],
    coming: Generator[tuple[Attempt, Any, float], None, None],
    left: int,
    place: Path,
    watch: Watch | None,
) -> Sweep:
    """The sweep, whose table is written after each run."""
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
    """Who computes."""
    if jobs < 1:
        raise InputError("--jobs", f"{jobs}", "1 or more")
    if scheduler is None:
        return answers(todo, carried_out, jobs, cancel)
    return answers_from(connected(scheduler), todo, carried_out, cancel)


def _left(attempt: Attempt, again: bool) -> bool:
    """Whether something of a run is left to compute."""
    stop = attempt.stop
    return stop is None or (stop.reason == "failed" and again) or (stop.reason != "failed" and stop != DONE)


def _place(file: str | Path, out: str | Path | None) -> Path:
    """The folder of the sweep, which is not that of a run."""
    place = (Path("sweeps") / Path(file).stem if out is None else Path(out)).resolve()
    if place.exists() and not place.is_dir():
        raise InputError("--out", f"'{place}' is a file", "the name of a folder")
    if (place / provenance.FILE).is_file():
        raise InputError("--out", f"'{place}' holds a run", "another folder")
    return place
