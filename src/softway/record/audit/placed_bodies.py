"""Bodies of a mechanism at the stored instants of its run: places of their points, and directions."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array
from softway.mechanisms.members.joints import GROUND, Rod
from softway.mechanisms.members.mechanism import Mechanism
from softway.mechanisms.members.rows import across, in_space
from softway.record.read.body_motion import BodyMotion


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PlacedBodies:
    """Bodies of a mechanism at the stored instants t.

    Parameters
    ----------
    mechanism
        The mechanism.
    motions
        Motion of each body.
    """

    mechanism: Mechanism
    motions: Mapping[str, BodyMotion]

    @property
    def instants(self) -> int:
        """Number of instants."""
        return len(next(iter(self.motions.values())).place)

    @property
    def size(self) -> float:
        """Size of the box around all places of the centres and of the joints [m]."""
        joints = self.mechanism.joints.values()
        ends = [end for joint in joints for end in (joint.ends if isinstance(joint, Rod) else (joint.at,))]
        ends += [end for stop in self.mechanism.stops.values() for end in getattr(stop, "places", ())]
        fixed = np.array([in_space(end) for end in ends]).reshape(-1, 3)
        every = np.vstack([*(motion.place for motion in self.motions.values()), fixed])
        return float(np.linalg.norm(np.ptp(every, axis=0)))

    @property
    def speed(self) -> float:
        """Greatest speed of a centre, and of a point at the size of the mechanism from it [m/s]."""
        every = self.motions.values()
        still = max(float(np.linalg.norm(motion.velocity, axis=1).max()) for motion in every)
        return max(still, self.size * max(float(np.linalg.norm(motion.spin, axis=1).max()) for motion in every))

    def moved(self, time: float) -> "PlacedBodies":
        """Bodies after a short ``time`` [s] with the velocities that they have, to first order."""
        motions = {}
        for name, motion in self.motions.items():
            turning = np.cross(motion.spin[:, :, None], motion.rotation, axis=1)
            place, rotation = motion.place + time * motion.velocity, motion.rotation + time * turning
            motions[name] = replace(motion, place=place, rotation=rotation)
        return replace(self, motions=motions)

    def point(self, body: str, start: Sequence[float]) -> Array:
        """Places (t, 3) of the point of a body that is at ``start`` at the start [m]."""
        place = in_space(start)
        if body == GROUND:
            return np.tile(place, (self.instants, 1))
        motion = self.motions[body]
        return motion.place + motion.rotation @ (place - in_space(self.mechanism.bodies[body].centre))

    def direction(self, body: str, start: Sequence[float] | Array) -> Array:
        """Direction (t, 3) of a body that is ``start`` at the start."""
        return np.asarray(self.turned(body) @ in_space(list(start)))

    def unit(self, body: str, start: Sequence[float]) -> Array:
        """Unit vector (t, 3) along a direction of a body."""
        found = self.direction(body, start)
        return found / np.linalg.norm(found, axis=1, keepdims=True)

    def turned(self, body: str) -> Array:
        """Rotations (t, 3, 3) of a body since the start."""
        return np.tile(np.eye(3), (self.instants, 1, 1)) if body == GROUND else self.motions[body].rotation

    def spin(self, body: str) -> Array:
        """Angular velocities (t, 3) of a body [rad/s]."""
        return np.zeros((self.instants, 3)) if body == GROUND else self.motions[body].spin

    def angle(self, between: tuple[str, str], axis: Array) -> Array:
        """Angles (t,) by which the second body has turned against the first about an axis, up to half a turn [rad]."""
        one, other = across(axis / float(np.linalg.norm(axis)))
        first, last = self.direction(between[0], one), self.direction(between[0], other)
        turned = self.direction(between[1], one)
        return np.arctan2((turned * last).sum(axis=1), (turned * first).sum(axis=1))
