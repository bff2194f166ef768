"""State of the rigid bodies of a model, and the arrays of a compiled slab (time step) that start from it."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.kernels.multibody.slab import begin
from softway.kernels.multibody.tables import Motion, Space, space
from softway.mechanisms.arrays import Arrays
from softway.mechanisms.contacts.impacts import StopMarch
from softway.mechanisms.contacts.stop_start import stop_march
from softway.mechanisms.members.mechanism import Mechanism
from softway.model.field import StopsInSlab


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RigidState:
    """State of the rigid bodies of a model, the ground being the last of the n.

    Parameters
    ----------
    place, turn
        (n, 3) places of the centres [m], and (n, 4) unit quaternions.
    velocity, spin
        (n, 3) velocities [m/s], and angular velocities in the axes of the bodies [rad/s].
    angle
        (q,) angles of joints with all turns [rad].
    impulse
        (r,) impulses through joints and stops in the slab before.
    energy
        (g,) energies that the groups of connected bodies have to have [J].
    work
        (2,) work of forces, torques and motors, and energy dissipated by dampers and stops [J].
    time
        (2,) time, with the rounding error of its sum [s].
    given
        (n - 1, 4, 3) mean forces by solids in the slab before, see
        :class:`~softway.kernels.multibody.tables.Space`.
    joints
        (2,) greatest error of the joints and of their velocities in the slab before [m], [m/s].
    stops
        Arrays of the march of the stops by name; none without stops.
    """

    place: Array
    turn: Array
    velocity: Array
    spin: Array
    angle: Array
    impulse: Array
    energy: Array
    work: Array
    time: Array
    given: Array
    joints: Array
    stops: Mapping[str, Array]

    def motion(self) -> Motion:
        """Copy of the state for the compiled slabs."""
        return Motion(*(getattr(self, name).copy() for name in Motion._fields))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RigidWork:
    """Arrays of a slab that starts from a state: tables with a motion of their own, work space, and stops."""

    it: Arrays
    room: Space
    stops: StopMarch | None

    @property
    def changing(self) -> dict[str, Array | IntArray | BoolArray]:
        """Arrays of the stops that a slab changes."""
        if self.stops is None:
            return {}
        return {**self.stops.changing, "supported": self.it.bodies.supported}

    def stops_in_slab(self, span: float) -> StopsInSlab:
        """What the stops did in the slab of this length [s]."""
        if self.stops is None:
            return StopsInSlab(closed={}, spent={})
        found = self.stops.stops
        closed = dict(zip(found.names, np.minimum(found.shut / span, 1.0).tolist(), strict=True))
        return StopsInSlab(closed=closed, spent=dict(zip(found.names, found.spent.tolist(), strict=True)))

    def prepare(self) -> None:
        """Prepare the work space for the state, without changing its energies."""
        energy = self.it.motion.energy.copy()
        begin(self.it.bodies, self.it.joints, self.it.springs, self.it.motion, self.room)
        self.it.motion.energy[:] = energy

    def state(self, joints: Array) -> RigidState:
        """State that has been reached; ``joints`` (2,) are the greatest errors of the joints."""
        stops = {name: array.astype(np.float64) for name, array in self.changing.items()}
        return RigidState(**self.it.motion._asdict(), given=self.room.given, joints=joints, stops=stops)


def at_work(mechanism: Mechanism, tables: Arrays, state: RigidState | None = None) -> RigidWork:
    """Arrays for a slab from a state, by default the start of the mechanism."""
    motion = Motion(*(array.copy() for array in tables.motion)) if state is None else state.motion()
    it = replace(tables, motion=motion, bodies=tables.bodies._replace(supported=tables.bodies.supported.copy()))
    room = space(it.joints, len(it.names), len(it.bodies.jointed), given=True)
    found = RigidWork(it=it, room=room, stops=stop_march(it, room, mechanism) if mechanism.stops else None)
    if state is not None:
        for name, array in found.changing.items():
            array[:] = state.stops[name]
        found.prepare()
    return found
