"""Execution of a scenario: check, march and record in one call, and resumption of a stopped run."""

import logging
import tomllib
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack
from dataclasses import replace
from functools import cache, lru_cache, partial
from pathlib import Path
from typing import cast

from softway.arrays import Array
from softway.bodies.discretised import DiscreteSolid
from softway.contact.surfaces.nodal_tractions import traction_map
from softway.errors import Cancel, InputError
from softway.heat.coupled.solid_temperature import temperatures_of
from softway.marching.audit.balances import balances, contact_forces
from softway.marching.audit.ledger import initial_ledger as audit
from softway.marching.march import march, march_in_groups
from softway.marching.results.step import Ledger, Step
from softway.marching.slab.step_group import StepGroup
from softway.marching.state.march_state import MarchState
from softway.marching.state.model_state import split_states
from softway.model.model import Model
from softway.model.scene import State
from softway.ranks.interface import Ranks
from softway.ranks.launch import agreed, together
from softway.record.conduct import continue_run, record_run
from softway.record.run import SCENARIO, Run
from softway.record.storage import provenance
from softway.record.storage.checkpoint import Checkpoint
from softway.record.storage.gate.own_files import require_own
from softway.record.storage.lock import locked
from softway.record.storage.provenance import DONE
from softway.record.storage.run_folder import RunFolder
from softway.record.write.progress import Heartbeat, MechanismWatch, Occasional, Tell, Watch
from softway.record.write.recorder import RunStart
from softway.scenario.checks.check import Checked, check
from softway.scenario.checks.probes import probe_readings
from softway.scenario.checks.stored_run import last_checkpoint
from softway.scenario.files import dumps, load
from softway.scenario.run_ranks import ranks_of, require_ranks, steps_of_ranks
from softway.scenario.run_rigid import CheckedRigid, resume_rigid, run_rigid
from softway.scenario.scenario import Scenario
from softway.scenario.text.user_modules import own_sources

LOG = logging.getLogger(__name__)
FRAMES = 100
"""Number of stored frames when the scenario does not prescribe it."""


def run(
    scenario: Scenario | Checked | CheckedRigid,
    out: str | Path | None = None,
    *,
    progress: Watch | MechanismWatch | None = None,
    cancel: Cancel | None = None,
    tell: Tell = LOG.info,
    overwrite: bool = False,
    ranks: Ranks | None = None,
) -> Run:
    """Run a scenario to its end and record it.

    Parameters
    ----------
    scenario
        Scenario to compute, or what :func:`softway.check` has made of it.
    out
        Folder of the records.  Without it the records are in a temporary folder that lives as long as the returned
        object.
    progress
        Callback with a :class:`Progress` after each accepted time step (slab), or with a
        :class:`~softway.record.write.progress.MechanismProgress` after each stored instant of a mechanism or a pile.
    cancel
        Function called in every iteration, and at every stored instant of a mechanism or a pile, such as
        ``threading.Event().is_set``; the run stops when it returns True.
    tell
        Function that receives a line if one attempt at a slab takes five seconds, and every five seconds from then on:
        what is being tried, and how far it is.  By default the line is logged.
    overwrite
        True if ``out`` may replace an earlier run.
    ranks
        Ranks that march together, of which this is rank 0; the others call
        ``softway.scenario.run_ranks.assist``.

    Raises
    ------
    InputError
        If the scenario is wrong; no folder is left.
    NumericsError, Cancelled, KeyboardInterrupt, StorageError
        The folder ``out`` contains all results up to the stop, and :func:`resume` can continue the run.  No folder
        exists if the run is cancelled during the first equilibrium.  Exceptions of ``progress`` propagate in
        the same way.
    """
    place = RunFolder(out=None if out is None else Path(out), overwrite=overwrite)
    if ranks is None:
        place.check()
    checked = check(scenario, cancel=cancel) if isinstance(scenario, Scenario) else scenario
    if ranks is not None:
        require_ranks(checked, ranks.size)
        agreed(ranks, place.check)
    if isinstance(checked, CheckedRigid):
        watch = cast(MechanismWatch | None, progress)
        return run_rigid(checked, place, _texts(checked.scenario), progress=watch, cancel=cancel, tell=tell)
    given, opening = checked.scenario, _opening(checked)
    steps = _steps(checked, opening.initial, cancel, tell, progress, ranks)
    return record_run(
        steps, opening, place, title=given.title, texts=_texts(given), notes=checked.notes,
        plan=given.output.checkpoints, progress=cast(Watch | None, progress), ranks=0 if ranks is None else ranks.size,
    )  # fmt: skip


def resume(
    folder: str | Path,
    *,
    scenario: Scenario | Checked | CheckedRigid | None = None,
    progress: Watch | MechanismWatch | None = None,
    cancel: Cancel | None = None,
    tell: Tell = LOG.info,
    allow_python: bool = False,
    ranks: Ranks | None = None,
) -> Run:
    """Resume a run that was killed, interrupted, cancelled or failed, from its last checkpoint.

    On the same machine with the same number of threads, the results are bitwise identical to those of an uninterrupted
    run.  A completed run is left unchanged.

    Parameters
    ----------
    folder
        Folder of the run.
    scenario
        Scenario of the run, needed if parts of it were built in Python; by default the scenario in the folder.
    progress, cancel, tell
        As for :func:`run`.
    allow_python
        True if ``module:name`` in the scenario may also name an installed module.
    ranks
        As for :func:`run`, of any number; by default a run over ranks continues on one rank, with the same bits.

    Raises
    ------
    InputError
        If ``folder`` contains no run, a run that is still going on, a changed scenario, or incomplete records.
    NumericsError, Cancelled, KeyboardInterrupt, StorageError
        As for :func:`run`.
    """
    stopped = Run(Path(folder))
    if stopped.stop == DONE:
        LOG.info("'%s' is complete: nothing to compute", stopped.path)
        return stopped
    ranks = ranks_of(stopped.provenance, ranks)
    with ExitStack() as held:

        def ready() -> tuple[Checked | CheckedRigid, Checkpoint | None]:
            held.enter_context(locked(stopped.path))
            require_own(stopped.path)
            given = stored(stopped.path, allow_python) if scenario is None else scenario
            checked = check(given, cancel=cancel) if isinstance(given, Scenario) else given
            provenance.require_same(stopped.path, stopped.provenance, _texts(checked.scenario))
            return checked, None if isinstance(checked, CheckedRigid) else last_checkpoint(stopped.path, checked)

        checked, found = together(ranks, ready)
        if isinstance(checked, CheckedRigid):
            heard, texts = cast(MechanismWatch | None, progress), _texts(checked.scenario)
            return resume_rigid(checked, stopped, texts, progress=heard, cancel=cancel, tell=tell)
        opening, plan = _opening(checked), checked.scenario.output.checkpoints
        begin = opening.initial if found is None else cast(MarchState, found.march_state)
        steps = _steps(checked, begin, cancel, tell, progress, ranks)
        return continue_run(steps, opening, stopped, found, plan=plan, progress=cast(Watch | None, progress))


def of_same_input(folder: Path, scenario: Scenario) -> bool:
    """Check whether the run in a folder was started with this scenario and the same files named in it."""
    return bool(Run(folder).provenance.get("input") == provenance.digest(_texts(scenario)))


def stored(folder: Path, allow_python: bool = False) -> Scenario:
    """Load the scenario in a run folder.

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


def _opening(checked: Checked) -> RunStart:
    """Start of the run of a checked scenario."""
    model, start = checked.model, checked.march_state.state
    given, initial, ledger = checked.scenario, split_states(model, start), audit(model, start)
    if not (model.adapted or model.remeshed):
        return _start(given, initial, ledger, model)
    on_meshes = lru_cache(maxsize=1)(partial(_start, given, initial, ledger))
    return replace(_start(given, initial, ledger, model), on_meshes=on_meshes)


def _start(given: Scenario, initial: State, ledger: Ledger, model: Model) -> RunStart:
    """Start of the run of a scenario, with what is read from states on the meshes of a model."""
    met = model.contacts
    return RunStart(
        scene=model.scene,
        meshes=model.meshes,
        stresses={name: partial(_stress, model, name) for name in model.meshes},
        remembered={part.name: partial(_remembered, model, part) for part in model.parts},
        spread=_spreading(model) if model.scene.contacts else None,
        touching={label: met.node[met.rows_of(k)] for k, label in enumerate(met.labels)},
        initial=initial,
        ledger=ledger,
        until=given.time.end,
        fields_every=_every(given),
        readings=probe_readings(given, model.meshes, model.scene.mechanism, {**model.adapted, **model.remeshed}),
        fields=model.fields,
        audit=given.output.audit,
        balances=partial(balances, model),
        pushed=partial(contact_forces, model),
        rounding=float(model.floor.sum()),
        model=model,
    )


def _steps(
    checked: Checked,
    state: State | MarchState,
    cancel: Cancel | None,
    tell: Tell,
    progress: object,
    ranks: Ranks | None,
) -> Iterator[Step | StepGroup]:
    """March of a checked scenario, over ranks if there are any; steps of each slab only for a callback that asks for
    them.
    """
    if ranks is not None:
        return steps_of_ranks(ranks, checked, state, cancel, Heartbeat(tell))
    time = checked.scenario.time
    if cancel is None and (progress is None or isinstance(progress, Occasional)):
        settings = replace(checked.march_state.settings, step=checked.step, tolerance=checked.tolerance)
        return march_in_groups(checked.model, settings, state=state, trying=Heartbeat(tell))
    return march(
        checked.model,
        until=time.end,
        step=checked.step,
        weight=time.weight,
        method=checked.scenario.solver,
        state=state,
        control=time.control,
        tolerance=checked.tolerance or "off",
        cancel=cancel,
        trying=Heartbeat(tell),
    )


def _texts(scenario: Scenario) -> dict[str, str]:
    """Texts of the resolved scenario and of the modules that it needs, by file name."""
    text = _text(scenario)
    return {SCENARIO: text, **own_sources(tomllib.loads(text), scenario)}


def _stress(model: Model, name: str, state: State) -> Array:
    """Mean Cauchy stress (cells, 3, 3) of a solid, with that of its temperature [Pa]."""
    stress = model.stress(name, state.displacement[name], state.memory.get(name))
    states = tuple(state.memory.get(part.name) for part in model.parts)
    for _, of_heat in temperatures_of(model.companions):
        u, temperature = (model.join(field) for field in (state.displacement, state.fields[of_heat.field.name]))
        stress = stress + of_heat.in_states(states).stress(name, len(stress), temperature, u)
    return stress


def _remembered(model: Model, part: DiscreteSolid, state: State) -> Mapping[str, Array]:
    """History variables of the cells of a solid, arrays (cells, ...) by name, with its heat flux and liquid share."""
    found = dict(part.internal.stored_scalars(state.memory.get(part.name)))
    for _, of_heat in temperatures_of(model.companions):
        found.update(of_heat.in_cells(part.name, model.join(state.fields[of_heat.field.name])))
    return found


def _spreading(model: Model) -> Callable[[State, Array], Array]:
    """Nodal contact forces (n, k) [N] per current area, (n, k) [Pa], as a function of state and forces."""
    surfaces = cache(partial(traction_map, model.scene.contacts, model.parts))
    return lambda state, force: surfaces().at(model.join(state.displacement), force)


def _every(scenario: Scenario) -> float:
    """Time between two stored frames of the fields [s]."""
    every = scenario.output.fields_every
    return scenario.time.end / FRAMES if isinstance(every, str) else every


def _text(scenario: Scenario) -> str:
    """Text of the resolved scenario; only a comment if parts were built in Python."""
    try:
        return dumps(scenario)
    except InputError as error:
        return f"# {error.where}: {error.problem}\n"
