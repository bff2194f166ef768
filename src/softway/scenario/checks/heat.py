"""Check of a scenario of conductors, whose heat is marched."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from softway.bodies.conductor import Conductor
from softway.bodies.setup.heat_loads import HeatLoad
from softway.bodies.solid import Solid
from softway.errors import InputError, Note
from softway.heat.build_heat import build_heat
from softway.heat.heat_model import HeatModel, HeatPart, HeatScene
from softway.heat.loads.heat_plan import heat_slabs
from softway.record.write.heat.probes import HeatReading, heat_readings
from softway.scenario.checks.mechanism import require_default, require_no_parts, slabs_of
from softway.scenario.scenario import Scenario

FRAMES = 100
"""Number of stored frames when the scenario does not prescribe it."""
FOREIGN = {
    "contacts": "[[heat_contacts]] with a conductance: conductors do not move",
    "ties": "[[heat_contacts]] with a large conductance",
    "start": "bodies.NAME.temperature, the temperature at the start",
    "inertia": "omit it: conductors do not move",
    "solver": "omit it: the march of heat has its own solution method",
}
"""Keys that conductors do not have, and remedies."""
ALONE = "a scenario of conductors only; solids that move have heat by their key thermal"
"""Remedy where conductors are together with others."""
HEATED = "a scenario of conductors, or a solid with the key thermal"
"""Remedy for loads of heat on bodies without a temperature."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HeatScales:
    """Scales of a conductor: nodes, cells, smallest edge [m], mass [kg], lowest and highest temperature at the start
    [K].
    """

    nodes: int
    cells: int
    edge: float
    mass: float
    temperature_least: float
    temperature_greatest: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CheckedHeat:
    """Scenario of conductors that has passed all checks.

    Parameters
    ----------
    scenario
        Scenario as given.
    model
        Conductors as arrays, ready to march.
    bodies
        Scales of the conductors by name.
    readings
        Resolved probes.
    step, slabs
        Greatest length of a time step (slab) [s] and number of slabs.
    fields_every
        Time between two stored frames [s].
    notes
        Notes on parts of the scenario that are computed, although their results may be wrong.
    """

    scenario: Scenario
    model: HeatModel
    bodies: Mapping[str, HeatScales]
    readings: tuple[HeatReading, ...]
    step: float
    slabs: int
    fields_every: float
    notes: tuple[Note, ...] = ()


def is_heat(scenario: Scenario) -> bool:
    """True if the bodies of a scenario are conductors.

    Raises
    ------
    InputError
        If conductors are together with other bodies, or loads of heat are given without a body with heat.
    """
    conductors = [name for name, body in scenario.bodies.items() if isinstance(body, Conductor)]
    others = [name for name in scenario.bodies if name not in conductors]
    if conductors and others:
        problem = f"the {type(scenario.bodies[others[0]]).__name__} {others[0]!r} with the Conductor {conductors[0]!r}"
        raise InputError(f"bodies.{others[0]}.kind", problem, ALONE)
    if scenario.heat_contacts and not conductors:
        raise InputError("heat_contacts[0]", f"{list(scenario.heat_contacts[0].between)} without a Conductor", ALONE)
    heated = conductors or any(isinstance(b, Solid) and b.thermal is not None for b in scenario.bodies.values())
    for k, load in enumerate(scenario.loads):
        if isinstance(load, HeatLoad) and not heated:
            raise InputError(f"loads[{k}]", f"{type(load).__name__} on {load.on!r}, which is no Conductor", HEATED)
    return bool(conductors)


def check_heat(scenario: Scenario) -> CheckedHeat:
    """Build the conductors of a scenario and check all that a run refuses before its first slab (time step).

    Raises
    ------
    InputError
        With the path in the scenario, the value, and a remedy.
    """
    require_default(scenario, FOREIGN, "conductors")
    require_no_parts(scenario)
    loads = []
    for k, load in enumerate(scenario.loads):
        if not isinstance(load, HeatLoad):
            raise InputError(f"loads[{k}]", f"{type(load).__name__} in a scenario of conductors", ALONE)
        loads.append(load)
    bodies = {name: body for name, body in scenario.bodies.items() if isinstance(body, Conductor)}
    model = _built(HeatScene(bodies=bodies, loads=tuple(loads), contacts=scenario.heat_contacts))
    readings = heat_readings(scenario.output.probes, {part.name: part.mesh for part in model.parts})
    span, _ = slabs_of(scenario.time, "conductors")
    every = scenario.output.fields_every
    return CheckedHeat(
        scenario=scenario,
        model=model,
        bodies={part.name: _scales(model, part) for part in model.parts},
        readings=readings,
        step=span,
        slabs=heat_slabs(model, scenario.time.end, span),
        fields_every=scenario.time.end / FRAMES if isinstance(every, str) else every,
        notes=tuple(_notes(model)),
    )


def _built(scene: HeatScene) -> HeatModel:
    """Model of a scene; an error in a contact has its place in the scenario."""
    try:
        return build_heat(scene)
    except InputError as error:
        where = f"heat_{error.where}" if error.where.startswith("contacts[") else error.where
        raise InputError(where, error.problem, error.remedy) from None


def _scales(model: HeatModel, part: HeatPart) -> HeatScales:
    """Scales of a conductor."""
    start = model.initial[part.nodes]
    return HeatScales(
        nodes=part.mesh.n_nodes,
        cells=part.mesh.n_cells,
        edge=part.mesh.edge(),
        mass=float(model.mass[part.nodes].sum()),
        temperature_least=float(start.min()),
        temperature_greatest=float(start.max()),
    )


def _notes(model: HeatModel) -> Iterator[Note]:
    """Notes on conductors without any load, whose heat only spreads."""
    loaded = {load.on.partition(".")[0] for load in model.loads}
    loaded |= {part.name for part in model.parts if model.exchanges}
    for part in model.parts:
        start = model.initial[part.nodes]
        if part.name not in loaded and start.min() == start.max():
            problem = "no load, and one temperature at the start: nothing will happen"
            yield Note(where=f"bodies.{part.name}", problem=problem, remedy="[[loads]] of heat on its surfaces")
