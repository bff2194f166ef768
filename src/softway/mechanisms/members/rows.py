"""Rows of joints: the equations of two bodies that a joint consists of, at the start."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.kernels.multibody.joint_rows import ALONG, DIRECTION, POINT

SQUARE = 1e-9
"""Cosine of the angle of two directions below which they are perpendicular."""
Direction = tuple[float, ...]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class JointRow:
    """Row of a joint at the start: points ``first`` and ``second`` (3,) of the bodies, directions ``n`` and ``m`` (3,).

    See :mod:`~softway.kernels.multibody.joint_rows` for the kinds.  The angle of the joint counts with the ``ratio``.
    """

    kind: int
    first: Array
    second: Array
    n: Array
    m: Array
    value: float = 0.0
    ratio: float = 0.0


def in_space(point: Sequence[float]) -> Array:
    """Point or direction (3,) of one in the plane or in space."""
    out = np.zeros(3)
    out[: len(point)] = point
    return out


def unit(direction: Sequence[float], dim: int, where: str) -> Array:
    """Unit vector (3,)."""
    if len(direction) != dim or not np.linalg.norm(direction) > 0.0:
        raise InputError(where, f"{direction} is no direction in {dim}D", f"{dim} components, not all zero")
    found = in_space(direction)
    return found / float(np.linalg.norm(found))


def axes(axis: Direction | None, joint: object) -> tuple[Array, Array, Array]:
    """Unit axis (3,) in space and two directions perpendicular to it."""
    if axis is None:
        raise InputError("axis", f"{type(joint).__name__} in space without an axis", "its direction, such as (0, 0, 1)")
    one = unit(axis, 3, "axis")
    return one, *across(one)


def across(one: Array) -> tuple[Array, Array]:
    """Two unit directions (3,) in space that are perpendicular to each other and to a unit vector (3,)."""
    first = np.cross(one, np.eye(3)[int(np.argmin(np.abs(one)))])
    first = first / float(np.linalg.norm(first))
    return first, np.cross(one, first)


def perpendicular(pair: tuple[Direction, Direction], where: str) -> tuple[Array, Array]:
    """Unit vectors (3,) of two directions in space that are perpendicular to each other."""
    one, other = (unit(direction, 3, where) for direction in pair)
    if abs(one @ other) > SQUARE:
        raise InputError(where, f"{pair} are not perpendicular", "two perpendicular directions")
    return one, other


def pinned(at: Sequence[float]) -> list[JointRow]:
    """Rows that keep two points together."""
    point = in_space(at)
    return [
        JointRow(kind=POINT, first=point, second=point, n=np.eye(3)[k], m=np.zeros(3), value=0.0)
        for k in range(len(at))
    ]


def sliding(at: Sequence[float], axis: Direction, joint: object) -> list[JointRow]:
    """Rows that keep a point of the second body on an axis of the first."""
    point = in_space(at)
    if len(at) == 2:
        one = unit(axis, 2, "axis")
        normals = [np.array([-one[1], one[0], 0.0])]
    else:
        normals = list(axes(axis, joint)[1:])
    return [JointRow(kind=ALONG, first=point, second=point, n=n, m=np.zeros(3)) for n in normals]


def directions(n: Array, m: Array) -> JointRow:
    """Row that keeps a direction of the first body perpendicular to one of the second."""
    return JointRow(kind=DIRECTION, first=np.zeros(3), second=np.zeros(3), n=n, m=m)


def not_turning(dim: int) -> list[JointRow]:
    """Rows that keep two bodies from turning against each other."""
    x, y, z = np.eye(3)
    return [directions(x, y)] if dim == 2 else [directions(x, y), directions(y, z), directions(z, x)]
