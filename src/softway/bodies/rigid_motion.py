"""Motion of a rigid body over a slab (time step), as that of a tool: its shape at any time of the slab."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.prescribed_motion import PlacedShape, Pose
from softway.obstacles.primitives import Shape


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RigidMotion:
    """Motion of a rigid body from one place to another.

    In between, the velocity of its centre and the rate of its rotation vector are linear in time.  If ``end`` is
    ``begin``, the body coasts.

    Parameters
    ----------
    begin, end
        Start and end of the motion [s].
    centre
        (3,) centre at the start of the scene [m]; the shape is described in the places of then.
    place, rotation
        (3,) centre and (3, 3) rotation at ``begin``.
    moved
        (6,) displacement of the centre [m] and rotation vector of Cayley's map, up to ``end``.
    rate
        (6,) velocity [m/s] and angular velocity [rad/s] at ``begin``.
    dim
        Dimension of space.

    Examples
    --------
    A wheel that rolls by a quarter of a turn:

    >>> moved = np.array([np.pi / 2, 0.0, 0.0, 0.0, 0.0, -2.0])
    >>> wheel = RigidMotion(begin=0.0, end=1.0, centre=np.zeros(3), place=np.zeros(3), rotation=np.eye(3),
    ...                     moved=moved, rate=moved, dim=2)
    >>> wheel.at(1.0).place(np.array([0.0, -1.0])).round(6).tolist()
    [0.570796, 0.0]
    """

    begin: float
    end: float
    centre: Array
    place: Array
    rotation: Array
    moved: Array
    rate: Array
    dim: int

    def at(self, time: float) -> Pose:
        """Pose of the shape at a time [s]."""
        moved = self.moved if time == self.end > self.begin else self._moved(time)
        rotation = cayley(moved[3:]) @ self.rotation
        shift, d = self.place + moved[:3] - rotation @ self.centre, self.dim
        return Pose(rotation=rotation[:d, :d], shift=shift[:d])

    def _moved(self, time: float) -> Array:
        """Displacement and rotation vector (6,) up to a time."""
        span = self.end - self.begin
        coasted = (time - self.begin) * self.rate
        bent = self.moved - span * self.rate
        return np.asarray(coasted + ((time - self.begin) / span) ** 2 * bent if span > 0.0 else coasted)

    def turned(self, time: float) -> Array:
        """Rotation (3, 3) from the start of the scene, at the begin or at the end [s]."""
        return self.rotation if time == self.begin else cayley(self.moved[3:]) @ self.rotation

    def arms(self, y: Array) -> Array:
        """Points (m, 3) of the body, relative to its centre, that are points y (m, d) of its shape."""
        out = np.zeros((len(y), 3))
        out[:, : self.dim] = y
        return np.asarray(out - self.centre)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RigidShape:
    """Shape of a rigid body in its motion over a slab: an obstacle like a :class:`~softway.bodies.Tool`."""

    shape: Shape
    motion: RigidMotion

    def at(self, time: float) -> PlacedShape:
        """Shape at its place at a time [s]."""
        return PlacedShape(shape=self.shape, pose=self.motion.at(time))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CarriedNodes:
    """Nodes of a solid that a rigid body carries.

    Parameters
    ----------
    by
        Name of the rigid body.
    nodes
        (k,) nodes of the model.
    place
        (k, d) their places at the start of the scene [m].
    motion
        Motion of the body over the slab.
    """

    by: str
    nodes: IntArray
    place: Array
    motion: RigidMotion

    @property
    def greatest_speed(self) -> float:
        """Greatest speed of a component [m/s]."""
        return float(np.abs(self.at(0.0)).max(initial=0.0))

    def at(self, time: float) -> Array:
        """Mean velocities (k d,) of the components over the slab [m/s], at any time of it; where the body coasts,
        those of the start.
        """
        motion, d = self.motion, self.motion.dim
        if motion.end == motion.begin:
            arms = motion.arms(self.place) @ motion.rotation.T
            return np.asarray((motion.rate[:3] + np.cross(motion.rate[3:], arms))[:, :d].ravel())
        first, last = (motion.at(t) for t in (motion.begin, motion.end))
        moved = np.dot(self.place, (last.rotation - first.rotation).T) + (last.shift - first.shift)
        return np.asarray(moved.ravel() / (motion.end - motion.begin))

    def bends(self, start: float, end: float) -> tuple[tuple[float, Array], ...]:
        """No bends."""
        return ()


def cayley(turn: Array) -> Array:
    """Rotation (3, 3) by Cayley's map of a rotation vector (3,), of the magnitude 2 tan(angle/2).

    Examples
    --------
    >>> cayley(np.array([0.0, 0.0, 2.0])).round(12).tolist()
    [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    """
    x, y, z = 0.5 * turn
    half = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + 2.0 / (1.0 + x * x + y * y + z * z) * (half + half @ half))


def rotation_vector(rotation: Array) -> Array:
    """Rotation vector (3,) of Cayley's map that belongs to a rotation (3, 3) by less than half a turn.

    Examples
    --------
    >>> rotation_vector(cayley(np.array([0.1, -0.2, 0.3]))).round(12).tolist()
    [0.1, -0.2, 0.3]
    """
    skew = rotation - rotation.T
    return np.array([skew[2, 1], skew[0, 2], skew[1, 0]]) * (2.0 / (1.0 + np.trace(rotation)))


def rotations(turn: Array) -> Array:
    """Rotation matrices (n, 3, 3) of quaternions (n, 4).

    Examples
    --------
    >>> rotations(np.array([[0.0, 0.0, 0.0, 1.0]]))[0].diagonal().tolist()
    [-1.0, -1.0, 1.0]
    """
    a, b, c, d = turn.T
    rows = [
        [1.0 - 2.0 * (c * c + d * d), 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)],
        [2.0 * (b * c + a * d), 1.0 - 2.0 * (b * b + d * d), 2.0 * (c * d - a * b)],
        [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), 1.0 - 2.0 * (b * b + c * c)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def quaternion(r: Array) -> Array:
    """Unit quaternion (4,) of a rotation (3, 3), with its scalar first and not negative.

    Examples
    --------
    >>> quaternion(np.diag([-1.0, -1.0, 1.0])).tolist()
    [0.0, 0.0, 0.0, 1.0]
    """
    trace = float(np.trace(r))
    full = np.array(
        [
            [1.0 + trace, r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]],
            [0.0, 1.0 - trace + 2.0 * r[0, 0], r[0, 1] + r[1, 0], r[0, 2] + r[2, 0]],
            [0.0, 0.0, 1.0 - trace + 2.0 * r[1, 1], r[1, 2] + r[2, 1]],
            [0.0, 0.0, 0.0, 1.0 - trace + 2.0 * r[2, 2]],
        ]
    )
    full = full + np.triu(full, 1).T
    row = full[int(np.argmax(np.diag(full)))]
    found: Array = row / float(np.linalg.norm(row)) * (1.0 if row[0] >= 0.0 else -1.0)
    return found
