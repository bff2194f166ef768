"""Check of a scenario of rigid bodies, which are marched as a mechanism."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields

import numpy as np

from softway.arrays import Array
from softway.bodies.setup.amplitude import Ramp
from softway.bodies.setup.loads import Gravity
from softway.bodies.solid import Tool
from softway.errors import InputError, Note, within
from softway.kernels.rigid_contact.closed_stops import NEAR
from softway.mechanisms.arrays import arrays
from softway.mechanisms.driven import check_motions
from softway.mechanisms.members.joints import GROUND
from softway.mechanisms.members.mechanism import Mechanism
from softway.mechanisms.members.rigid import Rigid
from softway.mechanisms.members.springs import Spring, Torque
from softway.mechanisms.members.stops import AngleStop, Stop
from softway.mechanisms.welds import welded
from softway.record.write.mechanism.probes import BodyReading, body_readings
from softway.scenario.hints.type_hints import nearest
from softway.scenario.scenario import Output, Scenario, Time

MOST = 1_000_000_000
"""Maximum number of time steps (slabs) in a run."""
ROWS = 1000
"""Number of stored instants when the scenario does not prescribe it, at most."""
PARTS = ("joints", "stops", "springs", "torques", "forces", "gears", "motors", "impacts", "restitution", "heat_links")
"""Keys that only a mechanism has."""
FOREIGN = {
    "contacts": "[stops.NAME] with a PlaneStop or a DistanceStop: rigid bodies touch at declared stops only",
    "ties": 'a joint of kind = "Weld": ties glue the surfaces of solids',
    "start": "omit it: a mechanism starts with the places and velocities of its bodies",
    "inertia": "omit it: rigid bodies always have their full mass",
    "solver": "omit it: the march of a mechanism has its own solution method",
}
"""Keys that a mechanism does not have, and remedies."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RigidScales:
    """Scales of a rigid body: its mass [kg], and the magnitudes of its velocity [m/s] and spin [rad/s] at the start."""

    mass: float
    speed: float
    spin: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CheckedMechanism:
    """Scenario of rigid bodies that has passed all checks.

    Parameters
    ----------
    scenario
        Scenario as given.
    mechanism
        Mechanism of the scenario, ready to march.
    bodies
        Scales of the bodies by name.
    readings
        Resolved probes.
    step, slabs
        Length of a time step (slab) [s] and number of slabs.
    every
        Number of slabs between two stored instants.
    notes
        Notes on parts of the scenario that are computed, although their results may be wrong.
    """

    scenario: Scenario
    mechanism: Mechanism
    bodies: Mapping[str, RigidScales]
    readings: tuple[BodyReading, ...]
    step: float
    slabs: int
    every: int
    notes: tuple[Note, ...] = ()


def is_mechanism(scenario: Scenario) -> bool:
    """True if all bodies of a scenario are rigid.

    Raises
    ------
    InputError
        If rigid bodies are together with tools only, or parts of a mechanism are given without a Rigid.
    """
    rigid = [name for name, body in scenario.bodies.items() if isinstance(body, Rigid)]
    tools = [name for name, body in scenario.bodies.items() if isinstance(body, Tool)]
    if not rigid:
        require_no_parts(scenario)
    elif tools and len(rigid) + len(tools) == len(scenario.bodies):
        problem = f"the Tool {tools[0]!r} with rigid bodies only: no solid would touch it"
        remedy = '[stops.NAME] against ground, or a body of kind = "Solid"'
        raise InputError(f"bodies.{tools[0]}.kind", problem, remedy)
    return bool(rigid) and not tools and len(rigid) == len(scenario.bodies)


def mechanism_among_solids(scenario: Scenario) -> Mechanism | None:
    """Rigid bodies of a scenario of solids, with their joints; None without.

    Raises
    ------
    InputError
        With the path in the scenario, the value, and a remedy.
    """
    if not any(isinstance(body, Rigid) for body in scenario.bodies.values()):
        return None
    found = mechanism_of(scenario)
    check_motions(arrays(welded(found).mechanism), found.stops)
    return found


def require_no_parts(scenario: Scenario) -> None:
    """Refuse joints, stops, springs and torques in a scenario without rigid bodies."""
    remedy = 'bodies of kind = "Rigid" only; solids have supports, contacts and loads instead'
    for key in PARTS:
        given = getattr(scenario, key)
        if isinstance(given, str):
            if given not in ("simultaneous", "Newton"):
                raise InputError(key, f"{given!r} without a Rigid among the bodies", remedy)
        elif given:
            first = f"{key}.{next(iter(given))}" if isinstance(given, Mapping) else f"{key}[0]"
            raise InputError(first, f"no body among {list(scenario.bodies)} is a Rigid", remedy)


def check_mechanism(scenario: Scenario) -> CheckedMechanism:
    """Build the mechanism of a scenario and check all that a run refuses before its first slab (time step).

    Raises
    ------
    InputError
        With the path in the scenario, the value, and a remedy.
    """
    require_default(scenario, FOREIGN, "rigid bodies")
    for k, load in enumerate(scenario.loads):
        if not isinstance(load, Gravity):
            problem = f"{type(load).__name__} on {load.on!r} in a scenario of rigid bodies"
            raise InputError(f"loads[{k}]", problem, "Gravity, [[forces]], [[springs]] or [[torques]]")
    mechanism = mechanism_of(scenario)
    mechanism.require_cold()
    joined = welded(mechanism)
    tables = arrays(joined.mechanism)
    check_motions(tables, mechanism.stops)
    extent = tables.extent
    for name, stop in mechanism.stops.items():
        _require_open(name, stop, extent)
    span, slabs = slabs_of(scenario.time, "rigid bodies")
    return CheckedMechanism(
        scenario=scenario,
        mechanism=mechanism,
        bodies=rigid_scales(mechanism),
        readings=body_readings(scenario.output.probes, mechanism),
        step=span,
        slabs=slabs,
        every=rows_between(scenario.output, span, slabs, ROWS),
    )


def rows_between(output: Output, span: float, slabs: int, rows: int) -> int:
    """Number of slabs between two stored instants, of which there are at most ``rows`` by default."""
    every = output.fields_every
    return int(np.ceil(slabs / rows)) if isinstance(every, str) else max(1, round(every / span))


def require_default(scenario: Scenario, foreign: Mapping[str, str], what: str) -> None:
    """Refuse ``foreign`` keys, which mean nothing for ``what``, with their remedies."""
    default = {f.name: f.default for f in fields(Scenario)}
    for key, remedy in foreign.items():
        given = getattr(scenario, key)
        if given != default[key]:
            where, kind = (
                (f"{key}[0]", list(given[0].between)) if key in ("contacts", "ties") else (key, type(given).__name__)
            )
            raise InputError(where, f"{kind} in a scenario of {what}", remedy)
    standard = Time(end=1.0)
    for key in ("weight", "control", "tolerance"):
        value = getattr(scenario.time, key)
        if value != getattr(standard, key):
            problem = f"{value if isinstance(value, float | str) else type(value).__name__} in a scenario of {what}"
            raise InputError(f"time.{key}", problem, "omit it: only solids use it")


def mechanism_of(scenario: Scenario) -> Mechanism:
    """Mechanism of the rigid bodies of a scenario."""
    bodies = {name: body for name, body in scenario.bodies.items() if isinstance(body, Rigid)}
    named: list[tuple[str, Iterable[str]]] = [(f"joints.{n}.between", j.between) for n, j in scenario.joints.items()]
    named += [(f"stops.{n}.between", s.between) for n, s in scenario.stops.items() if not isinstance(s, AngleStop)]
    named += [(f"springs[{k}].between", s.between) for k, s in enumerate(scenario.springs) if isinstance(s, Spring)]
    for where, names in named:
        for name in names:
            if name not in bodies and name != GROUND:
                raise InputError(where, f"there is no body {name!r}", nearest(name, [*bodies, GROUND]))
    pushed = [(f"torques[{k}].on", t.on) for k, t in enumerate(scenario.torques) if isinstance(t, Torque)]
    pushed += [(f"forces[{k}].on", force.on) for k, force in enumerate(scenario.forces)]
    for where, on in pushed:
        if on not in bodies:
            raise InputError(where, f"there is no body {on!r}", nearest(on, bodies))
    return Mechanism(
        bodies=bodies,
        joints=scenario.joints,
        stops=scenario.stops,
        impacts=scenario.impacts,
        restitution=scenario.restitution,
        springs=scenario.springs,
        torques=scenario.torques,
        forces=scenario.forces,
        gears=scenario.gears,
        motors=scenario.motors,
        heat_links=scenario.heat_links,
        gravity=gravity_of(scenario, next(iter(bodies.values())).dim),
    )


def gravity_of(scenario: Scenario, dim: int) -> tuple[float, ...] | None:
    """Sum of the accelerations of gravity [m/s^2]; None without any."""
    found: list[Array] = []
    for k, load in enumerate(scenario.loads):
        if not isinstance(load, Gravity):
            continue
        if load.ramp != Ramp():
            problem = "gravity that changes with time in a scenario with rigid bodies"
            raise InputError(f"loads[{k}].ramp", problem, "omit it: gravity is constant there")
        with within(f"loads[{k}]"):
            found.append(load.vector(dim))
    return tuple(np.sum(found, axis=0).tolist()) if found else None


def _require_open(name: str, stop: Stop, extent: float) -> None:
    """Refuse a stop that is overlapped at the start."""
    if stop.gap < -NEAR * extent:
        unit = "rad" if isinstance(stop, AngleStop) else "m"
        problem = f"is overlapped by {-stop.gap:.3g} {unit} at the start"
        raise InputError(f"stops.{name}", problem, "places with a gap of zero or more")


def slabs_of(time: Time, what: str) -> tuple[float, int]:
    """Length [s] and number of the slabs."""
    if isinstance(time.step, str):
        remedy = f'a time such as "{time.end / 1000:.3g} s"; half of it tells how accurate the motion is'
        raise InputError("time.step", f"'auto' in a scenario of {what}", remedy)
    if time.step > time.end:
        raise InputError("time.step", f"{time.step:g} s is longer than time.end = {time.end:g} s", "a shorter step")
    count = time.end / time.step
    if count > MOST:
        raise InputError("time.end", f"needs {count:.3g} slabs of {time.step:.3g} s", "an earlier end, or longer slabs")
    slabs = int(np.ceil(count * (1.0 - 1e-12)))
    return time.end / slabs, slabs


def rigid_scales(mechanism: Mechanism | None) -> dict[str, RigidScales]:
    """Scales of the rigid bodies; none without a mechanism."""
    found = {}
    for name, body in ({} if mechanism is None else mechanism.bodies).items():
        speed, spin = (float(np.linalg.norm(part)) for part in body.motion)
        found[name] = RigidScales(mass=body.mass, speed=speed, spin=spin)
    return found
