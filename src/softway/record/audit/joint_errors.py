"""Errors of joints and gaps of stops at the stored instants of a run, each by what its kind means.

Nothing of the march is used.
"""

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from types import MappingProxyType
from typing import Any

import numpy as np

from softway.arrays import Array
from softway.mechanisms.members.joints import (
    BallJoint,
    Cylindrical,
    Hinge,
    Joint,
    PinSlot,
    Rod,
    Screw,
    Slider,
    Universal,
    Weld,
)
from softway.mechanisms.members.rows import in_space
from softway.mechanisms.members.stops import DistanceStop, PlaneStop
from softway.record.audit.placed_bodies import PlacedBodies

NEAR = 1e-5
"""Way by which bodies are moved to find the rate of an error, relative to the size of the mechanism."""


def gap_of(placed: PlacedBodies, stop: PlaneStop | DistanceStop) -> Array:
    """Gap (t,) of a stop at all instants [m]."""
    first, second = stop.between
    if isinstance(stop, DistanceStop):
        apart = placed.point(second, stop.points[1]) - placed.point(first, stop.points[0])
        gap = np.linalg.norm(apart, axis=1) - stop.distance
        return np.asarray(gap if stop.side == "least" else -gap)
    normal = placed.direction(first, stop.normal)
    normal = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    apart = placed.point(second, stop.point) - placed.point(first, stop.plane)
    return np.asarray((apart * normal).sum(axis=1) - stop.radius)


def open_by(placed: PlacedBodies, joint: Joint) -> float:
    """Greatest error of a joint at all instants: of places [m], and of directions times the size."""
    return max(float(np.abs(error).max()) for error in ERRORS[type(joint)](placed, joint))


def opening_rates(placed: PlacedBodies) -> dict[str, float]:
    """Greatest rate of the errors of each joint by the velocities at all instants [m/s].

    The bodies are moved on and back with their velocities, by a way so small that the difference is the rate.
    """
    time, out = NEAR * (placed.size or 1.0) / (placed.speed or 1.0), {}
    ahead, back = placed.moved(time), placed.moved(-time)
    for name, joint in placed.mechanism.joints.items():
        pairs = zip(*(ERRORS[type(joint)](bodies, joint) for bodies in (ahead, back)), strict=True)
        out[name] = max(float(np.abs(one - other).max()) for one, other in pairs) / (2.0 * time)
    return out


def _pin(placed: PlacedBodies, joint: Any) -> Iterator[Array]:
    yield _apart(placed, joint)


def _hinge(placed: PlacedBodies, joint: Hinge) -> Iterator[Array]:
    yield _apart(placed, joint)
    if joint.axis is not None:
        yield _askew(placed, joint)


def _universal(placed: PlacedBodies, joint: Universal) -> Iterator[Array]:
    yield _apart(placed, joint)
    one, other = (placed.unit(body, axis) for body, axis in zip(joint.between, joint.axes, strict=True))
    yield placed.size * (one * other).sum(axis=1)


def _weld(placed: PlacedBodies, joint: Weld) -> Iterator[Array]:
    yield _apart(placed, joint)
    yield _turned(placed, joint)


def _guide(placed: PlacedBodies, joint: Any, *, turns: bool) -> Iterator[Array]:
    """A point that stays on an axis of the first body; the bodies ``turn`` against each other or not."""
    axis, apart = placed.unit(joint.between[0], joint.axis), _apart(placed, joint)
    yield apart - (apart * axis).sum(axis=1, keepdims=True) * axis
    if not turns:
        yield _turned(placed, joint)


def _cylinder(placed: PlacedBodies, joint: Any) -> Iterator[Array]:
    yield from _guide(placed, joint, turns=True)
    yield _askew(placed, joint)


def _screw(placed: PlacedBodies, joint: Screw) -> Iterator[Array]:
    yield from _cylinder(placed, joint)
    axis = placed.unit(joint.between[0], joint.axis)
    travel = (_apart(placed, joint) * axis).sum(axis=1)
    missed = travel / joint.pitch - placed.angle(joint.between, in_space(joint.axis)) / (2.0 * np.pi)
    yield joint.pitch * (missed - np.round(missed))  # full turns are not counted


def _rod(placed: PlacedBodies, joint: Rod) -> Iterator[Array]:
    one, other = (placed.point(body, end) for body, end in zip(joint.between, joint.ends, strict=True))
    yield np.linalg.norm(other - one, axis=1) - float(np.linalg.norm(np.subtract(*joint.ends)))


def _apart(placed: PlacedBodies, joint: Any) -> Array:
    """Vector (t, 3) between the points of the bodies that are together at the start."""
    return placed.point(joint.between[1], joint.at) - placed.point(joint.between[0], joint.at)


def _askew(placed: PlacedBodies, joint: Any) -> Array:
    """Difference (t, 3) of the axis of a joint as a direction of both bodies, times the size of the mechanism."""
    one, other = (placed.unit(body, joint.axis) for body in joint.between)
    return placed.size * (other - one)


def _turned(placed: PlacedBodies, joint: Any) -> Array:
    """Difference (t, 3, 3) of the rotations of the bodies, times the size of the mechanism."""
    one, other = (placed.turned(body) for body in joint.between)
    return placed.size * (other - one)


ERRORS: Mapping[type, Callable[[PlacedBodies, Any], Iterator[Array]]] = MappingProxyType(
    {
        BallJoint: _pin,
        Hinge: _hinge,
        Universal: _universal,
        Weld: _weld,
        Slider: partial(_guide, turns=False),
        PinSlot: partial(_guide, turns=True),
        Cylindrical: _cylinder,
        Screw: _screw,
        Rod: _rod,
    }
)
"""Errors of joints by kind, arrays with the instants first."""
