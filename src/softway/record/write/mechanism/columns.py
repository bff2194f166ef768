"""Columns of the tables of a mechanism: its history, and the motion of its bodies."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from math import atan2
from typing import Any

import numpy as np

from softway.arrays import Array
from softway.bodies.rigid_motion import quaternion
from softway.mechanisms.step import BodyState, MechanismGroup
from softway.record.storage import table

MOTION = "motion.csv"
"""File with the motion of the bodies; only the folder of a mechanism holds one."""


@dataclass(frozen=True, slots=True, eq=False)
class StepColumn:
    """Column of the history of a mechanism: name, unit, and value after a step, or values (k,) of a group."""

    name: str
    unit: str
    value: Callable[[Any], Any]


HISTORY = (
    StepColumn("time", "s", lambda step: step.time),
    StepColumn("iterations", table.COUNT, lambda step: step.iterations),
    StepColumn("energy_kinetic", "J", lambda step: step.energy_kinetic),
    StepColumn("energy_potential", "J", lambda step: step.energy_potential),
    StepColumn("work_external", "J", lambda step: step.work),
    StepColumn("dissipation", "J", lambda step: step.dissipation),
    StepColumn("energy_error", "J", lambda step: step.energy_error),
    StepColumn("momentum_x", "kg m/s", lambda step: step.momentum[0]),
    StepColumn("momentum_y", "kg m/s", lambda step: step.momentum[1]),
    StepColumn("momentum_z", "kg m/s", lambda step: step.momentum[2]),
    StepColumn("spin_x", "kg m^2/s", lambda step: step.spin[0]),
    StepColumn("spin_y", "kg m^2/s", lambda step: step.spin[1]),
    StepColumn("spin_z", "kg m^2/s", lambda step: step.spin[2]),
    StepColumn("joint_error", "m", lambda step: step.joints),
    StepColumn("joint_velocity_error", "m/s", lambda step: step.joint_velocity),
    StepColumn("closed_stops", table.COUNT, lambda step: step.closed_stops),
)
"""Columns of every history after that of the slabs (time steps) marched so far."""
SLABS = ("slabs", table.COUNT)
"""Column with the number of slabs since the start."""
NEEDED = (SLABS, *((column.name, column.unit) for column in HISTORY))
"""Names and units of the columns of every history, without its probes."""


def motion_columns(name: str, dim: int) -> tuple[tuple[str, str], ...]:
    """Names and units of the columns of a body.

    Examples
    --------
    >>> [column for column, _ in motion_columns("rod", 2)]
    ['rod.x', 'rod.y', 'rod.angle', 'rod.velocity_x', 'rod.velocity_y', 'rod.spin']
    """
    axes = "xyz"[:dim]
    turned = (("angle", "rad"),) if dim == 2 else tuple((f"rotation_{a}", "rad") for a in axes)
    spin = (("spin", "rad/s"),) if dim == 2 else tuple((f"spin_{a}", "rad/s") for a in axes)
    each = (*((a, "m") for a in axes), *turned, *((f"velocity_{a}", "m/s") for a in axes), *spin)
    return tuple((f"{name}.{column}", unit) for column, unit in each)


def motion_values(state: BodyState) -> Iterator[float]:
    """Values of the columns of a body."""
    for vector in (state.centre, rotation_vector(state.rotation), state.velocity, state.spin):
        yield from np.asarray(vector, float).tolist()


def group_motion(group: MechanismGroup) -> Array:
    """Values (k, columns) of all bodies in the states of a group."""
    it, d, found = group.course, group.dim, list[Array]()
    for b in range(len(group.names)):
        turned = [rotation_vector(rotation) for rotation in it.rotation[:, b, :d, :d]]
        spin = it.spin[:, b, 2:] if d == 2 else it.spin[:, b]
        found += [it.centre[:, b, :d], np.array(turned), it.velocity[:, b, :d], spin]
    return np.concatenate(found, axis=1)


def rotation_vector(rotation: Array) -> Array:
    """Angle times axis (3,) of a rotation (3, 3), or angle (1,) of one in the plane (2, 2), up to half a turn [rad].

    Examples
    --------
    >>> rotation_vector(np.array([[0.0, -1.0], [1.0, 0.0]])).round(4).tolist()
    [1.5708]
    """
    if len(rotation) == 2:
        return np.array([atan2(rotation[1, 0], rotation[0, 0])])
    turn = quaternion(rotation)
    length = float(np.linalg.norm(turn[1:]))
    if length == 0.0:
        return np.zeros(3)
    return np.asarray(2.0 * np.arctan2(length, turn[0]) / length * turn[1:])


def rotation_of(vector: Array) -> Array:
    """Rotation (d, d) of a rotation vector, the inverse of :func:`rotation_vector`.

    Examples
    --------
    >>> rotation_of(rotation_vector(np.diag([-1.0, 1.0, -1.0]))).round(12).tolist() == np.diag([-1, 1, -1]).tolist()
    True
    """
    angle = float(np.linalg.norm(vector))
    if len(vector) == 1:
        c, s = np.cos(vector[0]), np.sin(vector[0])
        return np.array([[c, -s], [s, c]])
    x, y, z = vector / (angle or 1.0)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * (cross @ cross))


def placed(table: Mapping[str, Array], name: str, row: int) -> tuple[Array, Array]:
    """Centre (d,) [m] and rotation (d, d) of a body in a row of the table of the motion."""
    dim = 3 if f"{name}.z" in table else 2
    turned = [f"{name}.angle"] if dim == 2 else [f"{name}.rotation_{a}" for a in "xyz"]
    centre = np.array([table[f"{name}.{a}"][row] for a in "xyz"[:dim]])
    return centre, rotation_of(np.array([table[key][row] for key in turned]))
