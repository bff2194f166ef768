"""Joints between two rigid bodies, or a body and the ground; places and directions are those of the scene at the start.

A joint is a list of rows, equations at most bilinear in places and directions (docs/theory/mechanisms.md).
"""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.kernels.multibody.joint_rows import ALONG, ANGLE, DISTANCE
from softway.mechanisms.members.rows import Direction as Direction
from softway.mechanisms.members.rows import JointRow as JointRow
from softway.mechanisms.members.rows import axes, directions, not_turning, perpendicular, pinned, sliding, unit
from softway.mechanisms.members.rows import in_space as in_space
from softway.units import Metre

GROUND = "ground"
"""Name of the body that does not move, in ``between``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BallJoint:
    """Joint that keeps a point of one body on a point of the other.

    Parameters
    ----------
    between
        Names of the two bodies; one may be ``ground``.
    at
        Common point at the start [m].
    """

    between: tuple[str, str]
    at: tuple[Metre, ...]

    def rows(self) -> list[JointRow]:
        """Rows of the joint."""
        return pinned(self.at)


@dataclass(frozen=True, slots=True, kw_only=True)
class Hinge:
    """Joint that lets one body turn about an axis of the other (revolute joint).

    Parameters
    ----------
    between
        Names of the two bodies; one may be ``ground``.
    at
        Point on the axis at the start [m].
    axis
        Direction of the axis at the start; in the plane it is the normal.  Angles are those of the second body against
        the first, zero at the start, and positive by the right-hand rule.
    """

    between: tuple[str, str]
    at: tuple[Metre, ...]
    axis: Direction | None = None

    def rows(self) -> list[JointRow]:
        """Rows of the joint."""
        if len(self.at) == 2:
            return pinned(self.at)
        axis, first, second = axes(self.axis, self)
        return [*pinned(self.at), directions(first, axis), directions(second, axis)]


@dataclass(frozen=True, slots=True, kw_only=True)
class Weld:
    """Joint without any motion: the bodies become one.

    Parameters
    ----------
    between
        Names of the two bodies; one may be ``ground``.
    at
        A point of both bodies at the start [m].
    """

    between: tuple[str, str]
    at: tuple[Metre, ...]

    def rows(self) -> list[JointRow]:
        """No rows: welded bodies are one."""
        return []


@dataclass(frozen=True, slots=True, kw_only=True)
class Slider:
    """Joint that lets one body slide along an axis of the other, without turning (prismatic joint).

    Parameters
    ----------
    between
        Names of the two bodies; one may be ``ground``.  The axis belongs to the first.
    at
        Point on the axis at the start [m].
    axis
        Direction of the axis at the start.
    """

    between: tuple[str, str]
    at: tuple[Metre, ...]
    axis: Direction

    def rows(self) -> list[JointRow]:
        """Rows of the joint."""
        return [*sliding(self.at, self.axis, self), *not_turning(len(self.at))]


@dataclass(frozen=True, slots=True, kw_only=True)
class Cylindrical:
    """Joint in space that lets one body slide along an axis of the other and turn about it.

    Parameters
    ----------
    between
        Names of the two bodies; one may be ``ground``.  The axis belongs to the first.
    at
        Point on the axis at the start [m].
    axis
        Direction of the axis at the start.
    """

    between: tuple[str, str]
    at: tuple[Metre, Metre, Metre]
    axis: Direction

    def rows(self) -> list[JointRow]:
        """Rows of the joint."""
        axis, first, second = axes(self.axis, self)
        return [*sliding(self.at, self.axis, self), directions(first, axis), directions(second, axis)]


@dataclass(frozen=True, slots=True, kw_only=True)
class Screw:
    """Joint in space that lets one body turn about an axis of the other and slide along it by a pitch for each turn.

    Parameters
    ----------
    between
        Names of the two bodies; one may be ``ground``.  The axis belongs to the first.
    at
        Point on the axis at the start [m].
    axis
        Direction of the axis at the start.
    pitch
        Travel of a full turn [m], negative for a left-handed thread.

    Examples
    --------
    >>> Screw(between=("ground", "nut"), at=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0), pitch=0.002).pitch
    0.002
    """

    between: tuple[str, str]
    at: tuple[Metre, Metre, Metre]
    axis: Direction
    pitch: Metre

    def rows(self) -> list[JointRow]:
        """Rows of the joint."""
        if not (np.isfinite(self.pitch) and self.pitch != 0.0):
            raise InputError("pitch", f"{self.pitch:g} m", "the travel of a full turn; a Hinge has none")
        point, axis = in_space(self.at), axes(self.axis, self)[0]
        ratio = -self.pitch / (2.0 * np.pi)
        thread = JointRow(kind=ALONG, first=point, second=point, n=axis, m=np.zeros(3), ratio=ratio)
        return [*Cylindrical(between=self.between, at=self.at, axis=self.axis).rows(), thread]


@dataclass(frozen=True, slots=True, kw_only=True)
class PinSlot:
    """Joint in the plane that lets a pin of the second body slide along an axis of the first, and turn in it.

    Parameters
    ----------
    between
        Names of the two bodies; one may be ``ground``.  The axis belongs to the first.
    at
        Place of the pin at the start [m].
    axis
        Direction of the axis at the start.
    """

    between: tuple[str, str]
    at: tuple[Metre, Metre]
    axis: Direction

    def rows(self) -> list[JointRow]:
        """Rows of the joint."""
        return sliding(self.at, self.axis, self)


@dataclass(frozen=True, slots=True, kw_only=True)
class Universal:
    """Joint in space of two crossed axes that stay perpendicular, each fixed in one body (Cardan joint).

    Parameters
    ----------
    between
        Names of the two bodies; one may be ``ground``.
    at
        Crossing of the axes at the start [m].
    axes
        Directions of the axis of the first body and of that of the second at the start, perpendicular to each other.
    """

    between: tuple[str, str]
    at: tuple[Metre, Metre, Metre]
    axes: tuple[Direction, Direction]

    def rows(self) -> list[JointRow]:
        """Rows of the joint."""
        return [*pinned(self.at), directions(*perpendicular(self.axes, "axes"))]


@dataclass(frozen=True, slots=True, kw_only=True)
class Rod:
    """Massless rod with a ball joint at each end: the distance of two points stays.

    Parameters
    ----------
    between
        Names of the two bodies; one may be ``ground``.
    ends
        End on the first body and end on the second at the start [m].
    """

    between: tuple[str, str]
    ends: tuple[tuple[Metre, ...], tuple[Metre, ...]]

    def rows(self) -> list[JointRow]:
        """Rows of the joint."""
        first, second = (in_space(end) for end in self.ends)
        length = float(np.linalg.norm(second - first))
        if not length > 0.0:
            raise InputError("ends", f"both at {self.ends[0]}", "two places, or a BallJoint")
        zero = np.zeros(3)
        return [JointRow(kind=DISTANCE, first=first, second=second, n=zero, m=zero, value=length)]


Joint = BallJoint | Hinge | Weld | Slider | Cylindrical | Screw | PinSlot | Universal | Rod


def turning_axis(joint: Joint) -> Array | None:
    """Unit axis (3,) at the start about which a joint lets its second body turn; None if it has no such axis."""
    if isinstance(joint, Hinge | Cylindrical | Screw):
        return np.array([0.0, 0.0, 1.0]) if len(joint.at) == 2 else axes(joint.axis, joint)[0]
    return None


def travel_axis(joint: Joint) -> Array | None:
    """Unit axis (3,) at the start along which a joint lets its second body slide; None if there is none."""
    if isinstance(joint, Slider | PinSlot):
        return unit(joint.axis, len(joint.at), "axis")
    return None


def motor_row(joint: Joint) -> JointRow | None:
    """Row of the motion that a joint leaves, an angle or a travel; None if it leaves none or more than one."""
    zero, along = np.zeros(3), travel_axis(joint)
    if along is not None:
        point = in_space(joint.at) if isinstance(joint, Slider | PinSlot) else zero
        return JointRow(kind=ALONG, first=point, second=point, n=along, m=zero)
    if isinstance(joint, Hinge | Screw):
        return JointRow(kind=ANGLE, first=zero, second=zero, n=zero, m=zero, ratio=1.0)
    return None
