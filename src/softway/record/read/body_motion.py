"""Motion of the rigid bodies of a run as arrays."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.bodies.rigid_motion import quaternion
from softway.record.read.records import Records
from softway.record.storage.table import Table
from softway.record.write.mechanism.columns import placed


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BodyMotion:
    """Motion of a rigid body at the stored instants t, in space; that of one in the plane has z = 0.

    Parameters
    ----------
    place
        (t, 3) places of the centre of mass [m].
    quaternion
        (t, 4) unit quaternions of the rotation since the start, scalar first and not negative.
    rotation
        (t, 3, 3) matrices of this rotation: a point X of the body at the start is at ``place + rotation @ (X - C)``
        with the centre C at the start.
    velocity
        (t, 3) velocities of the centre [m/s].
    spin
        (t, 3) angular velocities in the axes of the scene [rad/s].
    """

    place: Array
    quaternion: Array
    rotation: Array
    velocity: Array
    spin: Array


def body_motions(run: Records) -> dict[str, BodyMotion]:
    """Motion of each body of the run of a mechanism.

    Raises
    ------
    InputError
        If the run is not one of a mechanism.
    """
    return motions_in(run.motion, run.outline["bodies"])


def motions_in(motion: Table, bodies: Iterable[str]) -> dict[str, BodyMotion]:
    """Motion of each of the ``bodies`` from the columns of a table."""
    return {name: _motion(motion, name) for name in bodies}


def _motion(motion: Table, name: str) -> BodyMotion:
    """Motion of a body from the columns of the table."""
    plane = f"{name}.z" not in motion
    place, rotation = np.zeros((motion.rows, 3)), np.tile(np.eye(3), (motion.rows, 1, 1))
    velocity, spin = np.zeros((motion.rows, 3)), np.zeros((motion.rows, 3))
    for row in range(motion.rows):
        centre, turned = placed(motion, name, row)
        place[row, : len(centre)], rotation[row, : len(centre), : len(centre)] = centre, turned
    for k, axis in enumerate("xy" if plane else "xyz"):
        velocity[:, k] = motion[f"{name}.velocity_{axis}"]
    for k, key in ((2, "spin"),) if plane else enumerate(("spin_x", "spin_y", "spin_z")):
        spin[:, k] = motion[f"{name}.{key}"]
    turns = np.array([quaternion(one) for one in rotation]).reshape(-1, 4)
    return BodyMotion(place=place, quaternion=turns, rotation=rotation, velocity=velocity, spin=spin)
