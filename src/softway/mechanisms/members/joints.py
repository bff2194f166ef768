"""Joints between two rigid bodies, or a body and the ground; places and directions are those of the scene at the start.

A joint is a list of rows, equations at most bilinear in places and directions (docs/theory/mechanisms.md).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.kernels.multibody.joint_rows import ALONG, DIRECTION, DISTANCE, POINT
from softway.units import Metre

GROUND = "ground"
"""Name of the body that does not move, in ``between``."""
Direction = tuple[float, ...]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class JointRow:
    """Row of a joint at the start: points ``first`` and ``second`` (3,) of the bodies, directions ``n`` and ``m`` (3,).

    See :mod:`~softway.kernels.multibody.joint_rows` for the kinds.
    """

    kind: int
    first: Array
    second: Array
    n: Array
    m: Array
    value: float = 0.0


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
        return _pinned(self.at)


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
        Direction of the axis at the start; in the plane it is the normal.
    """

    between: tuple[str, str]
    at: tuple[Metre, ...]
    axis: Direction | None = None

    def rows(self) -> list[JointRow]:
        """Rows of the joint."""
        if len(self.at) == 2:
            return _pinned(self.at)
        axis, first, second = _axes(self.axis, self)
        return [*_pinned(self.at), _directions(first, axis), _directions(second, axis)]


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
        return [*_sliding(self.at, self.axis, self), *_not_turning(len(self.at))]


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
        axis, first, second = _axes(self.axis, self)
        return [*_sliding(self.at, self.axis, self), _directions(first, axis), _directions(second, axis)]


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
        return _sliding(self.at, self.axis, self)


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
        one, other = (_unit(axis, 3, "axes") for axis in self.axes)
        if abs(one @ other) > 1e-9:
            raise InputError("axes", f"{self.axes} are not perpendicular", "two perpendicular directions")
        return [*_pinned(self.at), _directions(one, other)]


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


Joint = BallJoint | Hinge | Weld | Slider | Cylindrical | PinSlot | Universal | Rod


def in_space(point: Sequence[float]) -> Array:
    """Point or direction (3,) of one in the plane or in space."""
    out = np.zeros(3)
    out[: len(point)] = point
    return out


def _unit(direction: Sequence[float], dim: int, where: str) -> Array:
    """Unit vector (3,)."""
    if len(direction) != dim or not np.linalg.norm(direction) > 0.0:
        raise InputError(where, f"{direction} is no direction in {dim}D", f"{dim} components, not all zero")
    found = in_space(direction)
    return found / float(np.linalg.norm(found))


def _axes(axis: Direction | None, joint: object) -> tuple[Array, Array, Array]:
    """Unit axis (3,) in space and two directions perpendicular to it."""
    if axis is None:
        raise InputError("axis", f"{type(joint).__name__} in space without an axis", "its direction, such as (0, 0, 1)")
    one = _unit(axis, 3, "axis")
    first = np.cross(one, np.eye(3)[int(np.argmin(np.abs(one)))])
    first = first / float(np.linalg.norm(first))
    return one, first, np.cross(one, first)


def _pinned(at: Sequence[float]) -> list[JointRow]:
    """Rows that keep two points together."""
    point = in_space(at)
    return [
        JointRow(kind=POINT, first=point, second=point, n=np.eye(3)[k], m=np.zeros(3), value=0.0)
        for k in range(len(at))
    ]


def _sliding(at: Sequence[float], axis: Direction, joint: object) -> list[JointRow]:
    """Rows that keep a point of the second body on an axis of the first."""
    point = in_space(at)
    if len(at) == 2:
        one = _unit(axis, 2, "axis")
        normals = [np.array([-one[1], one[0], 0.0])]
    else:
        normals = list(_axes(axis, joint)[1:])
    return [JointRow(kind=ALONG, first=point, second=point, n=n, m=np.zeros(3)) for n in normals]


def _directions(n: Array, m: Array) -> JointRow:
    """Row that keeps a direction of the first body perpendicular to one of the second."""
    return JointRow(kind=DIRECTION, first=np.zeros(3), second=np.zeros(3), n=n, m=m)


def _not_turning(dim: int) -> list[JointRow]:
    """Rows that keep two bodies from turning against each other."""
    x, y, z = np.eye(3)
    return [_directions(x, y)] if dim == 2 else [_directions(x, y), _directions(y, z), _directions(z, x)]
