"""Run of a sweep: started, resumed, or left as it is if done."""

from dataclasses import dataclass
from pathlib import Path

from softway.errors import InputError
from softway.record.run import Run
from softway.record.storage.provenance import DONE, FILE, Stop
from softway.scenario.checks.check import check
from softway.scenario.files import load
from softway.scenario.run import of_same_input, resume, run
from softway.studies.sweep.plan import Trial


@dataclass(frozen=True, slots=True, kw_only=True)
class Attempt:
    """Data that a process needs to compute a run; they can be pickled.

    Parameters
    ----------
    trial
        Values of the run.
    file, changes
        Scenario file, and changes to it besides the values.
    folder
        Run folder.
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
        """Reason why the run in the folder stopped; ``None`` if there is no run."""
        return Run(self.folder).stop if (self.folder / FILE).is_file() else None

    def require(self) -> None:
        """Check the run before anything is computed.

        Raises
        ------
        InputError
            If the scenario is wrong with these values, or the folder holds a run of another scenario.
        """
        given, before = load(self.file, self.every_change, allow_python=self.allow_python), self.stop
        if before is not None and not of_same_input(self.folder, given):
            remedy = "another folder (--out DIR), or the scenario of that run"
            raise InputError("--out", f"'{self.folder}' was computed from another scenario", remedy)
        if before != DONE:
            check(given)

    @property
    def every_change(self) -> tuple[str, ...]:
        """Changes of the sweep, then the values of the run."""
        return self.changes + self.trial.changes


def carried_out(attempt: Attempt) -> None:
    """Compute the run or resume it; a failed run starts again.

    Raises
    ------
    InputError, NumericsError, KeyboardInterrupt, StorageError
        As raised by :func:`softway.run`.
    """
    checked = check(load(attempt.file, attempt.every_change, allow_python=attempt.allow_python))
    stop = attempt.stop
    if stop is None or stop.reason == "failed":
        run(checked, attempt.folder, overwrite=True)
    else:
        resume(attempt.folder, scenario=checked)
