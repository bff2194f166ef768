"""Welded rigid bodies, which become one body; bodies that are welded to the ground do not move."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from softway.arrays import Array, IntArray
from softway.errors import InputError
from softway.mechanisms.members.joints import GROUND, Joint, Weld, in_space
from softway.mechanisms.members.mechanism import Mechanism
from softway.mechanisms.members.rigid import Rigid
from softway.mechanisms.members.springs import HingeTorque, PointForce, Spring, Torque, TorsionSpring
from softway.mechanisms.members.stops import AngleStop, DistanceStop, PlaneStop, Stop

Between = TypeVar("Between", bound=Joint | PlaneStop | DistanceStop | Spring)
On = TypeVar("On", bound=Torque | PointForce)
About = TypeVar("About", bound=TorsionSpring | HingeTorque | AngleStop)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Welded:
    """Mechanism without welds, and for each of its given bodies the name of the body that it is part of."""

    mechanism: Mechanism
    part_of: Mapping[str, str]


def welded(mechanism: Mechanism) -> Welded:
    """Join the welded bodies of a mechanism: mass, momentum and spin are those of the parts.

    Raises
    ------
    InputError
        If all bodies are welded to the ground.
    """
    part_of = {name: name for name in [GROUND, *mechanism.bodies]}
    for joint in mechanism.joints.values():
        if isinstance(joint, Weld):
            one, other = (part_of[name] for name in joint.between)
            kept, gone = (other, one) if other == GROUND else (one, other)
            part_of = {name: kept if part == gone else part for name, part in part_of.items()}
    bodies = _bodies(mechanism, part_of)
    if not bodies:
        raise InputError("joints", "weld all bodies to the ground", "a joint that lets a body move")
    joints = {
        name: moved
        for name, joint in mechanism.joints.items()
        if not isinstance(joint, Weld) and (moved := _between(joint, part_of)) is not None
    }
    _require_joints(mechanism, joints)
    turning = (TorsionSpring, HingeTorque)
    return Welded(
        mechanism=replace(
            mechanism,
            bodies=bodies,
            joints=joints,
            stops=_stops(mechanism, joints, part_of),
            springs=tuple(
                spring
                for s in mechanism.springs
                if (spring := _about(s, joints) if isinstance(s, turning) else _between(s, part_of)) is not None
            ),
            torques=tuple(
                torque
                for t in mechanism.torques
                if (torque := _about(t, joints) if isinstance(t, turning) else _on(t, part_of)) is not None
            ),
            forces=tuple(force for f in mechanism.forces if (force := _on(f, part_of)) is not None),
            heat_links=(),
        ),
        part_of=part_of,
    )


def _stops(mechanism: Mechanism, joints: Mapping[str, object], part_of: Mapping[str, str]) -> dict[str, Stop]:
    """Stops between different parts, and at the angles of joints between them."""
    stops: dict[str, Stop] = {}
    for name, stop in mechanism.stops.items():
        held = _about(stop, joints) if isinstance(stop, AngleStop) else _between(stop, part_of)
        if held is not None:
            stops[name] = held
    return stops


def _require_joints(mechanism: Mechanism, joints: Mapping[str, object]) -> None:
    """Refuse gears and motors of joints between welded parts."""
    gears = [(f"gears.{name}.joints", joint) for name, gear in mechanism.gears.items() for joint in gear.joints]
    motors = [(f"motors.{name}.joint", motor.joint) for name, motor in mechanism.motors.items()]
    for where, joint in gears + motors:
        if joint not in joints:
            raise InputError(where, f"{joint!r} joins parts of one body", "no weld between them")


def _bodies(mechanism: Mechanism, part_of: Mapping[str, str]) -> dict[str, Rigid]:
    """Bodies that move, of their parts."""
    bodies = {}
    for name in mechanism.bodies:
        if part_of[name] == name:
            parts = [body for part, body in mechanism.bodies.items() if part_of[part] == name]
            bodies[name] = parts[0] if len(parts) == 1 else _one(parts)
    return bodies


def _between(it: Between, part_of: Mapping[str, str]) -> Between | None:
    """Member between the bodies that its bodies are part of; None if they are one."""
    one, other = (part_of[name] for name in it.between)
    return None if one == other else replace(it, between=(one, other))


def _on(it: On, part_of: Mapping[str, str]) -> On | None:
    """Load on the body that its body is part of; None if that is the ground."""
    return None if part_of[it.on] == GROUND else replace(it, on=part_of[it.on])


def _about(it: About, joints: Mapping[str, object]) -> About | None:
    """Member about the axis of a joint; None if the joint is welded."""
    return it if it.joint in joints else None


def _one(parts: list[Rigid]) -> Rigid:
    """Body of several parts, by Steiner's theorem."""
    dim, mass = parts[0].dim, np.array([part.mass for part in parts])
    places, velocities = (
        np.array([in_space(part.centre) for part in parts]),
        np.array([part.motion[0] for part in parts]),
    )
    centre, velocity = (mass @ places) / mass.sum(), (mass @ velocities) / mass.sum()
    tensor, momentum = np.zeros((3, 3)), np.zeros(3)
    for part, place, moved in zip(parts, places, velocities, strict=True):
        arm = place - centre
        tensor += part.tensor + part.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
        momentum += part.tensor @ part.motion[1] + part.mass * np.cross(arm, moved)
    if dim == 2:
        spin = float(momentum[2] / tensor[2, 2])
        return Rigid(mass=float(mass.sum()), centre=_as_given(centre, 2), inertia=float(tensor[2, 2]),
                     velocity=_as_given(velocity, 2), spin=spin)  # fmt: skip
    turning: Array = np.asarray(np.linalg.lstsq(tensor, momentum, rcond=1e-12)[0], float)
    return Rigid(mass=float(mass.sum()), centre=_as_given(centre, 3), inertia=tuple(map(tuple, tensor.tolist())),
                 velocity=_as_given(velocity, 3), spin=_as_given(turning, 3))  # fmt: skip


def _as_given(vector: Array, dim: int) -> tuple[float, ...]:
    return tuple(vector[:dim].tolist())


def parts_of(mechanism: Mechanism, joined: Welded, names: tuple[str, ...]) -> tuple[IntArray, Array]:
    """Bodies of a mechanism as parts of those without welds: their numbers among ``names`` (b,), the ground last, and
    the arms (b, 3) from the centres of those to their own, at the start [m].
    """
    whole, arms = np.zeros(len(mechanism.bodies), np.int64), np.zeros((len(mechanism.bodies), 3))
    for k, (name, body) in enumerate(mechanism.bodies.items()):
        part = joined.part_of[name]
        whole[k] = names.index(part) if part in names else len(names)
        arms[k, : mechanism.dim] = body.centre
        if part in names:
            arms[k, : mechanism.dim] -= joined.mechanism.bodies[part].centre
    return whole, arms
