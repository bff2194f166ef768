"""Energies, momentum and spin of a mechanism, computed from its motion and compared with its history."""

import numpy as np

from softway.arrays import Array
from softway.mechanisms.members.joints import turning_axis
from softway.mechanisms.members.rows import in_space
from softway.mechanisms.members.springs import Spring, TorsionSpring
from softway.record.audit.placed_bodies import PlacedBodies
from softway.record.read.mechanism_summary import energy_scale
from softway.record.read.records import Records

FAST = 2.5
"""Angle between two stored instants from which on full turns cannot be counted [rad]."""


def balance_errors(run: Records, placed: PlacedBodies) -> tuple[dict[str, float], tuple[str, ...]]:
    """Relative errors of the columns of the history, and what cannot be computed from the motion."""
    history, time = run.history, run.motion["time"]
    rows = slice(min(history.rows, len(time)))  # a killed run may have written one line more to one of them
    kinetic, energy = kinetic_energies(placed), energy_scale(history) or 1.0
    found = {"the kinetic energy": float(np.abs(kinetic[rows] - history["energy_kinetic"][rows]).max()) / energy}
    for name, (values, scale) in momenta(placed).items():
        columns = np.stack([history[f"{name}_{a}"][rows] for a in "xyz"], axis=1)
        found[f"the {name}"] = float(np.abs(columns - values[rows]).max()) / (scale or 1.0)
    potential, lacking = _potential(placed, time)
    if potential is None:
        return found, lacking
    balance = (kinetic + potential)[rows] - history["work_external"][rows] + history["dissipation"][rows]
    found["the potential energy"] = float(np.abs(potential[rows] - history["energy_potential"][rows]).max()) / energy
    found["the energy balance"] = float(np.abs(balance - balance[0]).max()) / energy
    return found, lacking


def kinetic_energies(placed: PlacedBodies) -> Array:
    """Kinetic energy (t,) [J]."""
    total = np.zeros(placed.instants)
    for name, body in placed.mechanism.bodies.items():
        motion = placed.motions[name]
        own = np.einsum("tji,tj->ti", motion.rotation, motion.spin)
        total += 0.5 * body.mass * (motion.velocity**2).sum(axis=1)
        total += 0.5 * np.einsum("ti,ij,tj->t", own, body.tensor, own)
    return total


def momenta(placed: PlacedBodies) -> dict[str, tuple[Array, float]]:
    """Momentum and spin (angular momentum about the origin), each (t, 3), with the greatest sum of the bodies' own."""
    pushes, spins = [], []
    for name, body in placed.mechanism.bodies.items():
        motion = placed.motions[name]
        pushes.append(body.mass * motion.velocity)
        inertia = motion.rotation @ body.tensor @ motion.rotation.transpose(0, 2, 1)
        spins.append(np.cross(motion.place, pushes[-1]) + np.einsum("tij,tj->ti", inertia, motion.spin))
    sums = {"momentum": np.array(pushes), "spin": np.array(spins)}
    return {n: (all_.sum(axis=0), float(np.linalg.norm(all_, axis=2).sum(axis=0).max())) for n, all_ in sums.items()}


def _potential(placed: PlacedBodies, time: Array) -> tuple[Array | None, tuple[str, ...]]:
    """Potential energy (t,) of weight and springs [J], or None with the reason."""
    mechanism, total = placed.mechanism, np.zeros(placed.instants)
    for name, body in mechanism.bodies.items():
        total -= body.mass * placed.motions[name].place @ in_space(mechanism.gravity or ())
    for spring in mechanism.springs:
        if isinstance(spring, Spring):
            one, other = (placed.point(b, end) for b, end in zip(spring.between, spring.ends, strict=True))
            rest = float(np.linalg.norm(np.subtract(*spring.ends))) if spring.rest is None else spring.rest
            total += 0.5 * spring.stiffness * (np.linalg.norm(other - one, axis=1) - rest) ** 2
            continue
        angle = _counted(placed, spring, time)
        if angle is None:
            return None, (
                f"the energy of the torsion spring of '{spring.joint}', which turns too far between instants",
            )
        total += 0.5 * spring.stiffness * (angle - spring.rest) ** 2
    return total, ()


def _counted(placed: PlacedBodies, spring: TorsionSpring, time: Array) -> Array | None:
    """Angle (t,) of a joint with all turns [rad]; None where the bodies turn too far between two instants."""
    joint = placed.mechanism.joints[spring.joint]
    rate = np.linalg.norm(placed.spin(joint.between[1]) - placed.spin(joint.between[0]), axis=1)
    axis = turning_axis(joint)
    if axis is None or float((rate[:-1] * np.diff(time)).max(initial=0.0)) > FAST:
        return None
    return np.unwrap(placed.angle(joint.between, axis))
