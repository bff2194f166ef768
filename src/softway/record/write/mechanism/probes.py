"""Probes of a mechanism: one number of a body, or of one of its points."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.mechanisms.members.mechanism import Mechanism
from softway.mechanisms.step import BodyState, MechanismStep
from softway.record.write.mechanism.columns import NEEDED, rotation_vector
from softway.record.write.probes import COMPONENTS, Probe, require_names

UNITS = {"displacement": "m", "position": "m", "velocity": "m/s", "rotation": "rad", "spin": "rad/s"}
TURNING = ("rotation", "spin")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BodyReading:
    """Probe resolved on a mechanism.

    Parameters
    ----------
    name, unit
        Name and unit of the column in the history.
    body
        Name of the body.
    start, centre
        (d,) places of the point and of the centre of the body at the start [m].
    quantity, component
        Recorded quantity and its component.
    """

    name: str
    unit: str
    body: str
    start: Array
    centre: Array
    quantity: str
    component: str

    def value(self, step: MechanismStep) -> float:
        """Value after a step."""
        return self.at(step.bodies)

    def at(self, bodies: Mapping[str, BodyState]) -> float:
        """Value with the bodies in these states."""
        vector = self._vector(bodies[self.body])
        if self.component == "norm":
            return float(np.linalg.norm(vector))
        return float(vector[0 if len(vector) == 1 else "xyz".index(self.component)])

    def _vector(self, state: BodyState) -> Array:
        match self.quantity:
            case "rotation":
                return rotation_vector(state.rotation)
            case "spin":
                return state.spin
            case "velocity":
                arm = state.rotation @ (self.start - self.centre)
                turning = np.array([-arm[1], arm[0]]) * state.spin if len(arm) == 2 else np.cross(state.spin, arm)
                return np.asarray(state.velocity + turning)
            case "displacement":
                return np.asarray(state.point(self.start, self.centre) - self.start)
            case _:
                return state.point(self.start, self.centre)


def body_readings(probes: Sequence[Probe], mechanism: Mechanism) -> tuple[BodyReading, ...]:
    """Resolve the declared probes.

    Raises
    ------
    InputError
        For an unknown body, a tag, a point of another dimension, or a quantity or component that a rigid body does not
        have; the path is ``output.probes[k]``.
    """
    require_names(probes)
    known = [name for name, _ in (("time", "s"), *NEEDED)]
    for k, probe in enumerate(probes):
        if probe.name in known:
            raise InputError(f"output.probes[{k}].name", f"'{probe.name}' is a column already", "another name")
    return tuple(body_reading(f"output.probes[{k}]", probe, mechanism) for k, probe in enumerate(probes))


def body_reading(path: str, probe: Probe, mechanism: Mechanism) -> BodyReading:
    """Resolve one probe, whose path in the scenario is given.

    Raises
    ------
    InputError
        As for :func:`body_readings`.
    """
    body, dim = mechanism.bodies.get(probe.of), mechanism.dim
    if body is None:
        raise InputError(f"{path}.of", f"no rigid body '{probe.of}'", f"one of {list(mechanism.bodies)}")
    if probe.tag is not None:
        raise InputError(f"{path}.tag", f"'{probe.tag}': a rigid body has no tags", "'at', a point at the start")
    if probe.quantity not in UNITS:
        raise InputError(
            f"{path}.quantity", f"'{probe.quantity}' is not recorded of a rigid body", f"one of {list(UNITS)}"
        )
    allowed: tuple[str, ...] = (*COMPONENTS[:dim], "norm")
    if probe.quantity in TURNING:
        allowed = ("z",) if dim == 2 else COMPONENTS
        if probe.at is not None:
            raise InputError(f"{path}.at", f"{probe.at}: all points share the {probe.quantity}", "omit 'at'")
    if probe.component not in allowed:
        problem = f"'{probe.component}' is no component of a {probe.quantity} in {dim}D"
        raise InputError(f"{path}.component", problem, f"one of {list(allowed)}")
    centre = np.asarray(body.centre, float)
    start = centre if probe.at is None else np.atleast_1d(np.asarray(probe.at, float))
    if start.shape != (dim,):
        raise InputError(f"{path}.at", f"{start.size} coordinates in {dim}D", f"{dim} coordinates")
    return BodyReading(
        name=probe.name,
        unit=UNITS[probe.quantity],
        body=probe.of,
        start=start,
        centre=centre,
        quantity=probe.quantity,
        component=probe.component,
    )
