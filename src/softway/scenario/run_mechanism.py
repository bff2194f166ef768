"""Execution of a scenario of rigid bodies: march of the mechanism, recorded in a run folder."""

from collections.abc import Mapping
from pathlib import Path

from softway.errors import Cancel, InputError
from softway.mechanisms.march import march
from softway.record.conduct_mechanism import MechanismRun, record_mechanism
from softway.record.run import SCENARIO, Run
from softway.record.storage.run_folder import RunFolder
from softway.record.write.progress import MechanismWatch, Tell
from softway.scenario.checks.mechanism import CheckedMechanism


def run_mechanism(
    checked: CheckedMechanism,
    place: RunFolder,
    texts: Mapping[str, str],
    *,
    progress: MechanismWatch | None,
    cancel: Cancel | None,
    tell: Tell,
) -> Run:
    """March a checked mechanism to its end and record it; ``texts`` are the resolved scenario by file name.

    Raises
    ------
    InputError, NumericsError, Cancelled, KeyboardInterrupt, StorageError
        As for :func:`softway.run`.
    """
    given = checked.scenario
    step = given.time.step if isinstance(given.time.step, float | int) else checked.step
    steps = march(checked.mechanism, until=given.time.end, step=step, every=checked.every)
    opening = MechanismRun(
        mechanism=checked.mechanism,
        readings=checked.readings,
        until=given.time.end,
        slabs=checked.slabs,
        every=checked.every,
        title=given.title,
        texts=texts,
        notes=checked.notes,
    )
    return record_mechanism(steps, opening, place, progress=progress, cancel=cancel, tell=tell)


def not_resumed(folder: Path) -> InputError:
    """Error for a run of a mechanism that is to be resumed."""
    remedy = f"compute it again: softway run {folder / SCENARIO} --out {folder} --overwrite"
    return InputError(str(folder), "is the run of a mechanism, which cannot be resumed", remedy)
