"""Execution of a scenario of rigid bodies, balls or conductors: their march, recorded in a run folder."""

from collections.abc import Iterator, Mapping
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any, cast

from softway.errors import Cancel, InputError
from softway.heat.march import HeatState, HeatStep, heat_at_start, march_heat
from softway.mechanisms.arrays import MechanismState
from softway.mechanisms.march import march as march_mechanism
from softway.mechanisms.march import march_groups
from softway.mechanisms.members.mechanism import Mechanism
from softway.piles.march import march as march_pile
from softway.piles.state import PileState
from softway.record.conduct_rigid import One, RigidRun, continue_rigid, record_rigid
from softway.record.pile import outline as pile_outline
from softway.record.pile.recorder import open_pile
from softway.record.run import Run
from softway.record.storage.checkpoint import last
from softway.record.storage.line_files import LineFiles
from softway.record.storage.run_folder import RunFolder
from softway.record.write.heat import outline as heat_outline
from softway.record.write.heat.recorder import HeatOpening, open_heat
from softway.record.write.mechanism import outline
from softway.record.write.mechanism.probes import BodyReading
from softway.record.write.mechanism.recorder import open_mechanism
from softway.record.write.progress import MechanismWatch, Occasional, Tell
from softway.scenario.checks.heat import CheckedHeat
from softway.scenario.checks.mechanism import CheckedMechanism
from softway.scenario.checks.pile import CheckedPile

CheckedRigid = CheckedMechanism | CheckedPile | CheckedHeat
"""Scenario of rigid bodies, of balls or of conductors that has passed all checks: all but solids."""
RigidState = MechanismState | PileState | HeatState


def run_rigid(
    checked: CheckedRigid,
    place: RunFolder,
    texts: Mapping[str, str],
    *,
    progress: MechanismWatch | None,
    cancel: Cancel | None,
    tell: Tell,
) -> Run:
    """March a checked scenario to its end and record it; ``texts`` are the resolved scenario by file name.

    Raises
    ------
    InputError, NumericsError, Cancelled, KeyboardInterrupt, StorageError
        As for :func:`softway.run`.
    """
    steps = _steps(checked, None, cancel, grouped=_grouped(progress, cancel))
    return record_rigid(steps, _opening(checked, texts), place, progress=progress, cancel=cancel, tell=tell)


def resume_rigid(
    checked: CheckedRigid,
    stopped: Run,
    texts: Mapping[str, str],
    *,
    progress: MechanismWatch | None,
    cancel: Cancel | None,
    tell: Tell,
) -> Run:
    """Continue the stopped run of a checked scenario from its last checkpoint.

    Raises
    ------
    InputError, NumericsError, Cancelled, KeyboardInterrupt, StorageError
        As for :func:`softway.resume`.
    """
    opening = _opening(checked, texts)
    found = last(stopped.path, partial(_require_state, checked))
    begin = None if found is None else cast(RigidState, found.march_state)
    steps = _steps(checked, begin, cancel, grouped=_grouped(progress, cancel))
    return continue_rigid(steps, opening, stopped, found, progress=progress, cancel=cancel, tell=tell)


def _grouped(progress: MechanismWatch | None, cancel: Cancel | None) -> bool:
    """Whether nobody has to be told of each step."""
    return (progress is None or isinstance(progress, Occasional)) and cancel is None


def _steps(
    checked: CheckedRigid, state: RigidState | None, cancel: Cancel | None = None, *, grouped: bool = False
) -> Iterator[One]:
    """March of a checked scenario, from a state of it on; the states of a mechanism may be ``grouped``."""
    time = checked.scenario.time
    step = time.step if isinstance(time.step, float | int) else checked.step
    if isinstance(checked, CheckedHeat):
        return _heat_steps(checked, cast(HeatState | None, state), cancel)
    if isinstance(checked, CheckedPile):
        given, sweeps = cast(PileState | None, state), checked.scenario.pile.sweeps
        return march_pile(checked.pile, until=time.end, step=step, every=checked.every, sweeps=sweeps, state=given)
    begin = cast(MechanismState | None, state)
    march = march_groups if grouped else march_mechanism
    return march(checked.mechanism, until=time.end, step=step, every=checked.every, state=begin)


def _heat_steps(checked: CheckedHeat, state: HeatState | None, cancel: Cancel | None) -> Iterator[HeatStep]:
    """March of conductors, which begins with the state at the start."""
    rest = march_heat(checked.model, until=checked.scenario.time.end, step=checked.step, state=state, cancel=cancel)
    return rest if state is not None else chain([heat_at_start(checked.model)], rest)


def _require_state(checked: CheckedRigid, state: object) -> None:
    """Refuse a state from which the march cannot go on."""
    if isinstance(checked, CheckedPile) and not isinstance(state, PileState):
        raise InputError("state", f"is a {type(state).__name__}", "the checkpoint of a pile")
    if isinstance(checked, CheckedMechanism) and not isinstance(state, MechanismState):
        raise InputError("state", f"is a {type(state).__name__}", "the checkpoint of a mechanism")
    if isinstance(checked, CheckedHeat) and not isinstance(state, HeatState):
        raise InputError("state", f"is a {type(state).__name__}", "the checkpoint of conductors")
    _steps(checked, cast(RigidState, state))


def _opening(checked: CheckedRigid, texts: Mapping[str, str]) -> RigidRun:
    """What the records of a checked scenario need to know."""
    given = checked.scenario
    common: dict[str, Any] = {
        "until": given.time.end,
        "slabs": checked.slabs,
        "every": 1 if isinstance(checked, CheckedHeat) else checked.every,
        "title": given.title,
        "texts": texts,
        "notes": checked.notes,
        "plan": given.output.checkpoints,
    }
    if isinstance(checked, CheckedHeat):
        end, every = given.time.end, checked.fields_every
        opening = HeatOpening(model=checked.model, readings=checked.readings, until=end, fields_every=every)
        told = (heat_outline.FILE, heat_outline.outline(checked.model))
        return RigidRun(what="conductors", opened=partial(open_heat, opening), outline=told, **common)
    if isinstance(checked, CheckedPile):
        parts = pile_outline.outline(checked.pile, {name: group.balls for name, group in checked.bodies.items()})
        return RigidRun(what="pile", opened=open_pile, outline=(pile_outline.FILE, parts), **common)
    return RigidRun(**mechanism_records(checked.mechanism, checked.readings), **common)


def mechanism_records(mechanism: Mechanism, readings: tuple[BodyReading, ...]) -> dict[str, Any]:
    """What belongs to the records of a mechanism with probes: their files, and the parts at the start."""

    def opened(folder: Path, marks: Mapping[str, int]) -> LineFiles:
        return open_mechanism(folder, tuple(mechanism.bodies), mechanism.dim, readings, marks)

    told = (outline.FILE, outline.outline(mechanism, readings))
    return {"what": "mechanism", "opened": opened, "outline": told}
