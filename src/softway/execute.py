"""Execute: a scenario checked, marched and recorded, in one call."""

import tomllib
from collections.abc import Mapping
from functools import partial
from pathlib import Path

from softway.bodies.part import Part
from softway.bodies.past import remembered_scalars
from softway.contact.tractions import Spread, spread
from softway.errors import InputError
from softway.march.begin import begin
from softway.march.ledger import opening as audit
from softway.march.march import march, proposed
from softway.march.situation import parted
from softway.model import Model
from softway.record.conduct import Place, Progress, conduct
from softway.record.probes import readings
from softway.record.recorder import Opening
from softway.record.run import SCENARIO, Run
from softway.scenario.check import Checked, check
from softway.scenario.codec import resolved
from softway.scenario.modules import own_sources
from softway.scenario.scenario import Scenario
from softway.scene import State
from softway.typing import Array

FRAMES = 100
"""Number of stored fields when the scenario leaves it open."""


def run(
    scenario: Scenario | Checked,
    out: str | Path | None = None,
    *,
    progress: Progress | None = None,
    overwrite: bool = False,
) -> Run:
    """March a scenario to its end and record it.

    Parameters
    ----------
    scenario
        What to compute; as :class:`Checked` if it has been checked before.
    out
        Folder of the records; without one they live in a temporary folder as long as the returned object.
    progress
        Called with each accepted step.
    overwrite
        Whether ``out`` may replace an earlier run.

    Raises
    ------
    InputError
        Something in the scenario is wrong; no folder is left.
    NumericsError, KeyboardInterrupt
        The folder ``out`` holds what was computed until then.
    """
    place = Place(out=None if out is None else Path(out), overwrite=overwrite)
    place.check()
    checked = scenario if isinstance(scenario, Checked) else check(scenario)
    given = checked.scenario
    model = checked.model
    start = begin(model, proposed(model, checked.step, given.time.weight, given.time.end, given.solver))
    initial, met = parted(model, start), model.encounters
    opening = Opening(
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
    time = given.time
    steps = march(
        model,
        until=time.end,
        step=checked.step,
        weight=time.weight,
        method=given.solver,
        state=initial,
        control=time.control,
    )
    text = _text(given)
    texts = {SCENARIO: text, **own_sources(tomllib.loads(text))}
    return conduct(steps, opening, place, title=given.title, texts=texts, progress=progress)


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
