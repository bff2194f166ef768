"""Execute: a scenario checked, marched and recorded, in one call; and a run that stopped, resumed."""

import logging
import tomllib
from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path

from softway.bodies.part import Part
from softway.bodies.past import remembered_scalars
from softway.contact.tractions import Spread, spread
from softway.errors import Cancel, InputError
from softway.march.begin import begin
from softway.march.ledger import opening as audit
from softway.march.march import march, proposed
from softway.march.situation import parted
from softway.march.standing import Standing
from softway.march.step import Step
from softway.model import Model
from softway.record import provenance
from softway.record.checkpoint import last
from softway.record.conduct import conduct, proceed
from softway.record.lock import held
from softway.record.place import Place
from softway.record.probes import readings
from softway.record.progress import Watch
from softway.record.provenance import DONE
from softway.record.recorder import Opening
from softway.record.run import SCENARIO, Run
from softway.scenario.check import Checked, check
from softway.scenario.codec import load, resolved
from softway.scenario.modules import own_sources
from softway.scenario.scenario import Scenario
from softway.scene import State
from softway.typing import Array

LOG = logging.getLogger(__name__)
FRAMES = 100
"""Number of stored fields when the scenario leaves it open."""


def run(
    scenario: Scenario | Checked,
    out: str | Path | None = None,
    *,
    progress: Watch | None = None,
    cancel: Cancel | None = None,
    overwrite: bool = False,
) -> Run:
    """March a scenario to its end and record it.

    Parameters
    ----------
    scenario
        What to compute; as :class:`~softway.scenario.check.Checked` if it has been checked before.
    out
        Folder of the records; without one they live in a temporary folder as long as the returned object.
    progress
        Called with a :class:`Progress` after each accepted slab.
    cancel
        Asked at every iteration whether the caller wants no more, as ``threading.Event().is_set``.
    overwrite
        Whether ``out`` may replace an earlier run.

    Raises
    ------
    InputError
        Something in the scenario is wrong; no folder is left.
    NumericsError, Cancelled, KeyboardInterrupt, StorageError
        The folder ``out`` holds what was computed until then, and :func:`resume` goes on; there is none yet when the
        first equilibrium is called off.  What ``progress`` raises comes out likewise.
    """
    place = Place(out=None if out is None else Path(out), overwrite=overwrite)
    place.check()
    checked = scenario if isinstance(scenario, Checked) else check(scenario)
    given, opening = checked.scenario, _opening(checked, cancel)
    steps = _steps(checked, opening.initial, cancel)
    plan = given.output.checkpoints
    return conduct(steps, opening, place, title=given.title, texts=_texts(given), plan=plan, progress=progress)


def resume(
    folder: str | Path,
    *,
    scenario: Scenario | Checked | None = None,
    progress: Watch | None = None,
    cancel: Cancel | None = None,
    allow_python: bool = False,
) -> Run:
    """Go on with a run that was killed, interrupted, cancelled or failed, from its last checkpoint.

    What comes out has the same bits as that of a run that was never stopped, on the same machine with the same number
    of threads.  A run that is done is left as it is.

    Parameters
    ----------
    folder
        Of the run.
    scenario
        The scenario, where parts of it were built in Python; by default that in the folder.
    progress, cancel
        As of :func:`run`.
    allow_python
        Whether ``module:name`` in the scenario may also name an installed module.

    Raises
    ------
    InputError
        ``folder`` holds no run, one that is still going on, another scenario than it began with, or records that lack
        something.
    NumericsError, Cancelled, KeyboardInterrupt, StorageError
        As of :func:`run`.
    """
    stopped = Run(Path(folder))
    if stopped.stop == DONE:
        LOG.info("'%s' is done: nothing is left to compute", stopped.path)
        return stopped
    with held(stopped.path):
        given = stored(stopped.path, allow_python) if scenario is None else scenario
        checked = given if isinstance(given, Checked) else check(given)
        provenance.require_same(stopped.path, stopped.provenance, _texts(checked.scenario))
        opening, found = _opening(checked, cancel), last(stopped.path)
        steps = _steps(checked, opening.initial if found is None else found.standing, cancel)
        return proceed(steps, opening, stopped, found, plan=checked.scenario.output.checkpoints, progress=progress)


def of_same_input(folder: Path, scenario: Scenario) -> bool:
    """Whether the run in a folder began with this scenario and the files that it names."""
    return bool(Run(folder).provenance.get("input") == provenance.digest(_texts(scenario)))


def stored(folder: Path, allow_python: bool = False) -> Scenario:
    """The scenario in a run folder.

    Raises
    ------
    InputError
        If parts of it were built in Python.
    """
    file = folder / SCENARIO
    if file.is_file() and not tomllib.loads(file.read_text(encoding="utf-8")):
        remedy = "softway.resume(folder, scenario=...) with the same scenario"
        raise InputError(str(file), "parts of the scenario were built in Python", remedy)
    return load(file, allow_python=allow_python)


def _opening(checked: Checked, cancel: Cancel | None) -> Opening:
    """The start of the run of a scenario."""
    given, model = checked.scenario, checked.model
    start = begin(model, proposed(model, checked.step, given.time.weight, given.time.end, given.solver), cancel)
    initial, met = parted(model, start), model.encounters
    return Opening(
        scene=model.scene,
        meshes=model.meshes,
        stresses={name: partial(_stress, model, name) for name in model.meshes},
        remembered={part.name: partial(_remembered, part) for part in model.parts},
        spread=partial(_spread, model, spread(model.scene.contacts, model.parts)) if model.scene.contacts else None,
        touching={label: met.node[met.of(k)] for k, label in enumerate(met.labels)},
        initial=initial,
        ledger=audit(model, start),
        until=given.time.end,
        fields_every=_every(given),
        readings=readings(given.output.probes, model.meshes),
    )


def _steps(checked: Checked, state: State | Standing, cancel: Cancel | None) -> Iterator[Step]:
    """The march of a scenario."""
    time = checked.scenario.time
    return march(
        checked.model,
        until=time.end,
        step=checked.step,
        weight=time.weight,
        method=checked.scenario.solver,
        state=state,
        control=time.control,
        cancel=cancel,
    )


def _texts(scenario: Scenario) -> dict[str, str]:
    """The resolved scenario and what it needs beside it, by the names of the files."""
    text = _text(scenario)
    return {SCENARIO: text, **own_sources(tomllib.loads(text), scenario)}


def _stress(model: Model, name: str, state: State) -> Array:
    """Mean Cauchy stress (cells, 3, 3) of a solid [Pa]."""
    return model.stress(name, state.displacement[name], state.memory.get(name))


def _remembered(part: Part, state: State) -> Mapping[str, Array]:
    """What the cells of a solid remember, arrays (cells,) by name."""
    return remembered_scalars(part, state.memory.get(part.name))


def _spread(model: Model, surfaces: Spread, state: State, force: Array) -> Array:
    """Contact forces (n, k) of the nodes [N] per present area, (n, k) [Pa]."""
    return surfaces.at(model.join(state.displacement), force)


def _every(scenario: Scenario) -> float:
    """Time between stored fields [s]."""
    every = scenario.output.fields_every
    return scenario.time.end / FRAMES if isinstance(every, str) else every


def _text(scenario: Scenario) -> str:
    """The resolved scenario; a comment when parts of it were built in Python."""
    try:
        return resolved(scenario)
    except InputError as error:
        return f"# {error.where}: {error.problem}\n"
