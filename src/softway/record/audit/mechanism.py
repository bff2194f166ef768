"""Audit of the run of a mechanism: joints, gaps and energies computed again from its motion and its description.

Nothing of the march is used: every joint and stop is looked at by what its kind means.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType
from typing import Any

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
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
from softway.mechanisms.members.mechanism import Mechanism
from softway.mechanisms.members.rows import in_space
from softway.mechanisms.members.stops import AngleStop, DistanceStop, PlaneStop
from softway.record.audit.mechanism_energy import balance_errors
from softway.record.audit.placed_bodies import PlacedBodies
from softway.record.read.body_motion import body_motions
from softway.record.read.records import Records

LIMIT = 1e-9
"""Error relative to the size of the mechanism, or to the energies, beyond which it is a finding."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MechanismAudit:
    """What the audit of the run of a mechanism found.

    Parameters
    ----------
    instants
        Number of stored instants.
    joints
        Greatest error of each joint: of places [m], and of directions times the size of the mechanism.
    overlaps
        Deepest overlap of each stop [m], zero where none is negative.
    balances
        Greatest errors of the energies, of their balance, of momentum and of spin in ``history.csv``, relative to the
        greatest of each.
    size
        Size of the mechanism and its ways [m].
    left_out
        What was not looked at.
    """

    instants: int
    joints: Mapping[str, float]
    overlaps: Mapping[str, float]
    balances: Mapping[str, float]
    size: float
    left_out: tuple[str, ...]

    @property
    def findings(self) -> tuple[str, ...]:
        """Sentences on errors beyond rounding."""
        found = [
            f"the joint '{name}' is open by {error:.3g} m"
            for name, error in self.joints.items()
            if not error <= LIMIT * self.size
        ]
        found += [
            f"the stop '{name}' is overlapped by {depth:.3g} m"
            for name, depth in self.overlaps.items()
            if not depth <= LIMIT * self.size
        ]
        found += [
            f"{name} in history.csv: error of {error:.3g} against the motion, relative to the greatest"
            for name, error in self.balances.items()
            if not error <= LIMIT
        ]
        return tuple(found)


def audited_mechanism(run: Records, mechanism: Mechanism) -> MechanismAudit:
    """Audit the run of a mechanism.

    Parameters
    ----------
    run
        The run.
    mechanism
        The mechanism that its scenario describes.

    Raises
    ------
    InputError
        If a table of the run is missing, damaged or empty.
    """
    if not (run.motion.rows and run.history.rows):
        raise InputError(str(run.path), "holds no instant yet", "a run that has started to move")
    placed = PlacedBodies(mechanism=mechanism, motions=body_motions(run))
    balances, lacking = balance_errors(run, placed)
    angular = [f"the stop '{name}'" for name, stop in mechanism.stops.items() if isinstance(stop, AngleStop)]
    driven = [f"the gear '{name}'" for name in mechanism.gears] + [f"the motor '{name}'" for name in mechanism.motors]
    return MechanismAudit(
        instants=run.motion.rows,
        joints={name: _open(placed, joint) for name, joint in mechanism.joints.items()},
        overlaps={
            name: float(max(0.0, -_gap(placed, stop).min()))
            for name, stop in mechanism.stops.items()
            if not isinstance(stop, AngleStop)
        },
        balances=balances,
        size=placed.size,
        left_out=(*angular, *driven, *lacking),
    )


def _gap(placed: PlacedBodies, stop: PlaneStop | DistanceStop) -> Array:
    """Gap (t,) of a stop [m]."""
    first, second = stop.between
    if isinstance(stop, DistanceStop):
        apart = placed.point(second, stop.points[1]) - placed.point(first, stop.points[0])
        gap = np.linalg.norm(apart, axis=1) - stop.distance
        return np.asarray(gap if stop.side == "least" else -gap)
    normal = placed.direction(first, stop.normal)
    normal = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    apart = placed.point(second, stop.point) - placed.point(first, stop.plane)
    return np.asarray((apart * normal).sum(axis=1) - stop.radius)


def _open(placed: PlacedBodies, joint: Joint) -> float:
    """Greatest error of a joint at all instants."""
    return max(float(np.abs(error).max()) for error in ERRORS[type(joint)](placed, joint))


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
