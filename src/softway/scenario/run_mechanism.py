"""Execution of a scenario of rigid bodies: march of the mechanism, recorded in a run folder."""

from collections.abc import Iterator, Mapping
from functools import partial
from typing import cast

from softway.errors import Cancel, InputError
from softway.mechanisms.arrays import MechanismState
from softway.mechanisms.march import MechanismStep, march
from softway.record.conduct_mechanism import MechanismRun, continue_mechanism, record_mechanism
from softway.record.run import Run
from softway.record.storage.checkpoint import last
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
    return record_mechanism(
        _steps(checked, None), _opening(checked, texts), place, progress=progress, cancel=cancel, tell=tell
    )


def resume_mechanism(
    checked: CheckedMechanism,
    stopped: Run,
    texts: Mapping[str, str],
    *,
    progress: MechanismWatch | None,
    cancel: Cancel | None,
    tell: Tell,
) -> Run:
    """Continue the stopped run of a checked mechanism from its last checkpoint.

    Raises
    ------
    InputError, NumericsError, Cancelled, KeyboardInterrupt, StorageError
        As for :func:`softway.resume`.
    """
    opening = _opening(checked, texts)
    found = last(stopped.path, partial(_require_state, checked))
    steps = _steps(checked, None if found is None else cast(MechanismState, found.march_state))
    return continue_mechanism(steps, opening, stopped, found, progress=progress, cancel=cancel, tell=tell)


def _steps(checked: CheckedMechanism, state: MechanismState | None) -> Iterator[MechanismStep]:
    """March of a checked mechanism, from a state of it on."""
    time = checked.scenario.time
    step = time.step if isinstance(time.step, float | int) else checked.step
    return march(checked.mechanism, until=time.end, step=step, every=checked.every, state=state)


def _require_state(checked: CheckedMechanism, state: object) -> None:
    """Refuse a state from which the march cannot go on."""
    if not isinstance(state, MechanismState):
        raise InputError("state", f"is a {type(state).__name__}", "the checkpoint of a mechanism")
    _steps(checked, state)


def _opening(checked: CheckedMechanism, texts: Mapping[str, str]) -> MechanismRun:
    """What the records of a checked mechanism need to know."""
    given = checked.scenario
    return MechanismRun(
        mechanism=checked.mechanism,
        readings=checked.readings,
        until=given.time.end,
        slabs=checked.slabs,
        every=checked.every,
        title=given.title,
        texts=texts,
        notes=checked.notes,
        plan=given.output.checkpoints,
    )
