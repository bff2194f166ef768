"""Arrays of a mechanism for the compiled slabs (time steps)."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components, reverse_cuthill_mckee

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import InputError, within
from softway.kernels.multibody.joint_rows import ALONG, DIRECTION, SLIDE
from softway.kernels.multibody.tables import Bodies, Joints, Motion, Springs
from softway.mechanisms.members.joints import GROUND, JointRow
from softway.mechanisms.members.mechanism import Mechanism
from softway.mechanisms.members.rigid import inverse
from softway.mechanisms.members.springs import Spring

FELT = 1e-9
"""Arm about an axis without inertia, relative to the greatest, below which a joint does not turn about it."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Arrays:
    """Tables of a mechanism, its motion at the start, the name of the joint of each row, and the extent [m]."""

    bodies: Bodies
    joints: Joints
    springs: Springs
    motion: Motion
    names: tuple[str, ...]
    joint_of: tuple[str, ...]
    extent: float


def arrays(mechanism: Mechanism) -> Arrays:
    """Build the tables; rows of joints are in an order of small band width.

    Raises
    ------
    InputError
        For a joint that turns a body about an axis without inertia, and what the joints refuse.
    """
    names = tuple(mechanism.bodies)
    number = {name: k for k, name in enumerate([*names, GROUND])}
    centres = np.zeros((len(number), 3))
    for k, body in enumerate(mechanism.bodies.values()):
        centres[k, : body.dim] = body.centre
    rows: list[tuple[str, int, int, JointRow]] = []
    for name, joint in mechanism.joints.items():
        with within(f"joints.{name}"):
            rows += [(name, number[joint.between[0]], number[joint.between[1]], row) for row in joint.rows()]
    rough = any(stop.friction for stop in mechanism.stops.values())
    for name, stop in mechanism.stops.items():
        found = [stop.row(), *(stop.tangential_rows() if rough else [])]
        rows += [(name, number[stop.between[0]], number[stop.between[1]], row) for row in found]
    joints, order = _joints(rows, centres)
    springs = _springs(mechanism, number, centres)
    fixed = np.array([rows[k][0] not in mechanism.stops for k in order], dtype=bool)
    bodies = _bodies(mechanism, joints, springs, fixed)
    _require_inertia(mechanism, [rows[k] for k in order], centres, number)
    return Arrays(
        bodies=bodies,
        joints=joints,
        springs=springs,
        motion=_motion(mechanism, centres, len(rows), len(bodies.jointed)),
        names=names,
        joint_of=tuple(rows[k][0] for k in order),
        extent=float(
            max(np.abs(joints.X).max(initial=0.0), np.abs(joints.Y).max(initial=0.0), np.ptp(centres, 0).max())
        ),
    )


def _joints(rows: list[tuple[str, int, int, JointRow]], centres: Array) -> tuple[Joints, IntArray]:
    """Rows in an order of small band width, and that order."""
    ground = len(centres) - 1
    a, b = (np.array([row[k] for row in rows], dtype=np.int64) for k in (1, 2))
    touch = [{int(i), int(j)} - {ground} for i, j in zip(a, b, strict=True)]
    of_body: list[list[int]] = [[] for _ in range(ground)]
    for k, two in enumerate(touch):
        for i in two:
            of_body[i].append(k)
    linked = {(i, j) for mine in of_body for i in mine for j in mine}
    graph = sp.csr_array(
        (np.ones(len(linked)), tuple(np.array(sorted(linked)).reshape(-1, 2).T)), shape=(len(rows),) * 2
    )
    order = np.asarray(reverse_cuthill_mckee(graph, symmetric_mode=True), dtype=np.int64) if rows else np.zeros(0, int)
    place = np.argsort(order)
    found = [rows[k][3] for k in order]
    first, second = a[order], b[order]
    pairs = []
    for i, j in sorted((int(place[i]), int(place[j])) for i, j in linked if place[i] >= place[j]):
        for si, p in enumerate((first[i], second[i])):
            pairs += [(i, j, si, sj) for sj, q in enumerate((first[j], second[j])) if p == q != ground]
    pairs_array = np.array(sorted(set(pairs)), dtype=np.int64).reshape(-1, 4)
    joints = Joints(
        kind=np.array([r.kind for r in found], dtype=np.int64),
        a=first,
        b=second,
        X=_table([r.first for r in found]) - centres[first],
        Y=_table([r.second for r in found]) - centres[second],
        N=_table([r.n for r in found]),
        B=_table([r.m for r in found]),
        value=np.array([r.value for r in found], dtype=float),
        pairs=pairs_array,
        width=int((pairs_array[:, 0] - pairs_array[:, 1]).max(initial=0)),
    )
    return joints, order


def _table(vectors: list[Array]) -> Array:
    return np.array(vectors, dtype=float).reshape(-1, 3)


def _springs(mechanism: Mechanism, number: dict[str, int], centres: Array) -> Springs:
    """Tables of springs and torques."""
    given = mechanism.springs
    a, b = (np.array([number[s.between[k]] for s in given], dtype=np.int64) for k in (0, 1))
    ends = np.zeros((len(given), 2, 3))
    for k, spring in enumerate(given):
        ends[k, :, : mechanism.dim] = spring.ends
    torque = np.zeros((len(mechanism.torques), 3))
    for k, one in enumerate(mechanism.torques):
        place = slice(2, 3) if mechanism.dim == 2 else slice(0, 3)
        if np.size(one.value) != (1 if mechanism.dim == 2 else 3):
            raise InputError(f"torques[{k}].value", f"{one.value} in {mechanism.dim}D", "one component, three in space")
        torque[k, place] = one.value
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    return Springs(
        a=a,
        b=b,
        X=ends[:, 0] - centres[a],
        Y=ends[:, 1] - centres[b],
        stiffness=np.array([s.stiffness for s in given], dtype=float),
        rest=np.array([_rest(s, found) for s, found in zip(given, length.tolist(), strict=True)], dtype=float),
        damping=np.array([s.damping for s in given], dtype=float),
        turned=np.array([number[one.on] for one in mechanism.torques], dtype=np.int64),
        torque=torque,
    )


def _rest(spring: Spring, length: float) -> float:
    return length if spring.rest is None else spring.rest


def _bodies(mechanism: Mechanism, joints: Joints, springs: Springs, fixed: BoolArray) -> Bodies:
    """Table of the bodies, and their groups: bodies connected by joints, stops or springs.

    The ``fixed`` rows (r,), those of joints, hold their group if they lead to the ground; closed stops do, too.
    """
    given, ground = list(mechanism.bodies.values()), len(mechanism.bodies)
    first, second = np.concatenate([joints.a, springs.a]), np.concatenate([joints.b, springs.b])
    inner = (first != ground) & (second != ground)
    links = sp.coo_array((np.ones(inner.sum()), (first[inner], second[inner])), shape=(ground, ground))
    groups, group = connected_components(links, directed=False)
    held = np.zeros(groups, dtype=np.int64)
    holds = np.concatenate([fixed, np.ones(len(springs.a), bool)]) & ~inner
    held[group[np.minimum(first, second)[holds]]] = 1
    jointed = np.zeros(groups, dtype=np.int64)
    jointed[group[np.minimum(joints.a, joints.b)]] = 1
    loaded = mechanism.gravity is not None and any(mechanism.gravity)
    held[group[springs.turned]] = 1
    inertia = np.array([body.tensor for body in given] + [np.zeros((3, 3))])
    gravity = np.zeros(3)
    if loaded:
        gravity[: mechanism.dim] = mechanism.gravity
    mass = np.array([body.mass for body in given] + [0.0])
    return Bodies(
        mass=mass,
        inertia=inertia,
        inverse_mass=np.array([1.0 / body.mass for body in given] + [0.0]),
        inverse_inertia=np.array([inverse(tensor) for tensor in inertia]),
        gravity=gravity,
        group=group.astype(np.int64),
        jointed=jointed,
        supported=held,
    )


def _motion(mechanism: Mechanism, centres: Array, rows: int, groups: int) -> Motion:
    """Motion at the start."""
    n = len(centres)
    velocity, spin = np.zeros((n, 3)), np.zeros((n, 3))
    for k, body in enumerate(mechanism.bodies.values()):
        velocity[k], spin[k] = body.motion
    return Motion(
        place=centres.copy(),
        turn=np.tile([1.0, 0.0, 0.0, 0.0], (n, 1)),
        velocity=velocity,
        spin=spin,
        impulse=np.zeros(rows),
        energy=np.zeros(groups),
        work=np.zeros(2),
    )


def _require_inertia(
    mechanism: Mechanism, rows: list[tuple[str, int, int, JointRow]], centres: Array, number: dict[str, int]
) -> None:
    """Refuse joints that turn a body about an axis without inertia: they would hold it instead."""
    names = list(number)
    for name, a, b, row in rows:
        for i, point, turning in (
            (a, row.first, row.kind in (ALONG, DIRECTION, SLIDE)),
            (b, row.second, row.kind == DIRECTION),
        ):
            if names[i] == GROUND:
                continue
            empty, arm = _without_inertia(mechanism, names[i]), point - centres[i]
            felt = np.linalg.norm(np.cross(empty, arm), axis=1) > FELT * float(np.linalg.norm(arm))
            if felt.any() or (turning and len(empty)):
                problem = f"turns {names[i]!r} about an axis without inertia"
                raise InputError(f"joints.{name}", problem, "its inertia, or a Rod to the centre of a point mass")


def _without_inertia(mechanism: Mechanism, name: str) -> Array:
    """Axes (k, 3) about which a body may turn and has no inertia."""
    tensor = mechanism.bodies[name].tensor
    if mechanism.dim == 2:
        return np.zeros((0, 3)) if tensor[2, 2] else np.array([[0.0, 0.0, 1.0]])
    values, axes = np.linalg.eigh(tensor)
    found: Array = axes[:, values <= FELT * max(float(values.max()), 1e-300)].T
    return found
