"""Tables of springs, forces and torques."""

from collections.abc import Mapping, Sequence

import numpy as np

from softway.arrays import Array, IntArray
from softway.errors import InputError
from softway.kernels.multibody.tables import Springs
from softway.mechanisms.members.mechanism import Mechanism
from softway.mechanisms.members.springs import HingeTorque, Spring, Torque, TorsionSpring


def spring_tables(mechanism: Mechanism, number: Mapping[str, int], centres: Array, turning: Sequence[str]) -> Springs:
    """Tables of springs, forces and torques; ``turning`` are the names of the joints whose angles are counted."""
    given, dim = [spring for spring in mechanism.springs if isinstance(spring, Spring)], mechanism.dim
    a, b = (np.array([number[s.between[k]] for s in given], dtype=np.int64) for k in (0, 1))
    ends = np.zeros((len(given), 2, 3))
    for k, spring in enumerate(given):
        ends[k, :, :dim] = spring.ends
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    turned, torque = _torques(mechanism, number)
    pushed = np.array([number[one.on] for one in mechanism.forces], dtype=np.int64)
    at, force = np.zeros((len(pushed), 3)), np.zeros((len(pushed), 3))
    for k, one in enumerate(mechanism.forces):
        at[k, :dim], force[k, :dim] = one.at, one.value
    about, torsion = _torsion(mechanism, turning)
    return Springs(
        a=a,
        b=b,
        X=ends[:, 0] - centres[a],
        Y=ends[:, 1] - centres[b],
        stiffness=np.array([s.stiffness for s in given], dtype=float),
        rest=np.array([_rest(s, found) for s, found in zip(given, length.tolist(), strict=True)], dtype=float),
        damping=np.array([s.damping for s in given], dtype=float),
        turned=turned,
        torque=torque,
        pushed=pushed,
        F=at - centres[pushed],
        force=force,
        about=about,
        torsion=torsion,
    )


def _rest(spring: Spring, length: float) -> float:
    return length if spring.rest is None else spring.rest


def _torques(mechanism: Mechanism, number: Mapping[str, int]) -> tuple[IntArray, Array]:
    """Bodies (t,) and torques (t, 3) on them."""
    bodies, torques = [], []
    for k, one in enumerate(mechanism.torques):
        if isinstance(one, Torque):
            if np.size(one.value) != (1 if mechanism.dim == 2 else 3):
                problem = f"{one.value} in {mechanism.dim}D"
                raise InputError(f"torques[{k}].value", problem, "one component, three in space")
            bodies.append(number[one.on])
            torques.append(np.append([0.0, 0.0], one.value) if mechanism.dim == 2 else np.array(one.value, float))
    return np.array(bodies, dtype=np.int64), np.array(torques, dtype=float).reshape(-1, 3)


def _torsion(mechanism: Mechanism, turning: Sequence[str]) -> tuple[IntArray, Array]:
    """Numbers (m,) of angles, and (m, 4) the stiffness, angle without moment, damping and torque about each."""
    springs = [
        (s.joint, s.stiffness, s.rest, s.damping, 0.0) for s in mechanism.springs if isinstance(s, TorsionSpring)
    ]
    motors = [(t.joint, 0.0, 0.0, 0.0, t.value) for t in mechanism.torques if isinstance(t, HingeTorque)]
    about = np.array([turning.index(one[0]) for one in springs + motors], dtype=np.int64)
    return about, np.array([one[1:] for one in springs + motors], dtype=float).reshape(-1, 4)
