"""One run of a sweep: begun, resumed or left as it is, in whatever process it is asked for."""

from dataclasses import dataclass
from pathlib import Path

from softway.errors import InputError
from softway.execute import of_same_input, resume, run
from softway.record.provenance import DONE, FILE, Stop
from softway.record.run import Run
from softway.scenario.check import check
from softway.scenario.codec import load
from softway.study.plan import Trial


@dataclass(frozen=True, slots=True, kw_only=True)
class Attempt:
    """What a process has to know to compute a run; it can be pickled.

    Parameters
    ----------
    trial
        The values.
    file, changes
        The scenario, and what is changed in it besides the values.
    folder
        Of the run.
    allow_python
        As for :func:`softway.load`.
    """

    trial: Trial
    file: Path
    changes: tuple[str, ...]
    folder: Path
    allow_python: bool = False

    @property
    def stop(self) -> Stop | None:
        """Why the run in the folder stopped; ``None`` where there is none."""
        return Run(self.folder).stop if (self.folder / FILE).is_file() else None

    def require(self) -> None:
        """Look for everything that can be found wrong before computing.

        Raises
        ------
        InputError
            In the scenario with these values, or because the folder holds a run of another one.
        """
        given, before = load(self.file, self.every_change, allow_python=self.allow_python), self.stop
        if before is not None and not of_same_input(self.folder, given):
            remedy = "another folder: --out DIR, or the scenario as it was"
            raise InputError("--out", f"'{self.folder}' was computed from another scenario", remedy)
        if before != DONE:
            check(given)

    @property
    def every_change(self) -> tuple[str, ...]:
        """Those of the sweep, then the values."""
        return self.changes + self.trial.changes


def carried_out(attempt: Attempt) -> None:
    """Compute the run, or what is left of it; one that failed begins again.

    Raises
    ------
    InputError, NumericsError, KeyboardInterrupt, StorageError
        As of :func:`softway.run`.
    """
    checked = check(load(attempt.file, attempt.every_change, allow_python=attempt.allow_python))
    stop = attempt.stop
    if stop is None or stop.reason == "failed":
        run(checked, attempt.folder, overwrite=True)
    else:
        resume(attempt.folder, scenario=checked)
