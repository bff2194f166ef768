"""Tables of the rows of joints, in an order of small band width, and of the angles of joints."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import reverse_cuthill_mckee

from softway.arrays import Array, IntArray
from softway.bodies.setup.motion_laws import pieces, value_and_rate
from softway.errors import InputError, within
from softway.kernels.multibody.joint_rows import ALONG, ANGLE, DIRECTION, SLIDE, TURN
from softway.kernels.multibody.tables import Angles, Drives, Joints
from softway.mechanisms.members.joints import GROUND, JointRow, motor_row, travel_axis, turning_axis
from softway.mechanisms.members.mechanism import Mechanism
from softway.mechanisms.members.motors import Prescribed
from softway.mechanisms.members.rows import axes
from softway.mechanisms.members.stops import AngleStop

FELT = 1e-9
"""Arm about an axis without inertia, relative to the greatest, below which a joint does not turn about it."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Row:
    """Row of a joint of this ``name`` between the numbers of its ``bodies``, two or four.

    Rows that are not ``fixed`` do not always take part.  ``angles`` are numbers of angles with their factors, the first
    between the first two bodies and the second between the others; ``motion`` is the prescribed one.  The ``rank`` is
    the number of a row among those of its stop.
    """

    name: str
    bodies: tuple[int, ...]
    row: JointRow
    fixed: bool = True
    angles: tuple[tuple[int, float], ...] = ()
    motion: Prescribed | None = None
    rank: int = 0


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Turning:
    """Angle of a joint: numbers of its bodies, and its unit axis (3,) at the start."""

    a: int
    b: int
    axis: Array


def rows_of(mechanism: Mechanism, number: Mapping[str, int]) -> tuple[list[Row], Mapping[str, Turning]]:
    """Rows of the joints and stops, and the angles of the joints that turn about an axis."""
    rows, turnings, counted = [], {}, mechanism.turning
    for name, joint in mechanism.joints.items():
        a, b = number[joint.between[0]], number[joint.between[1]]
        with within(f"joints.{name}"):
            found, axis = joint.rows(), turning_axis(joint)
        if axis is not None and (name in counted or any(row.ratio for row in found)):
            turnings[name] = Turning(a=a, b=b, axis=axis)
        for row in found:
            own = ((list(turnings).index(name), row.ratio),) if row.ratio else ()
            rows.append(Row(name=name, bodies=(a, b), row=row, angles=own))
    rows += _stops(mechanism, number, list(turnings))
    names = list(turnings)
    return rows + _gears(mechanism, number, names) + _motors(mechanism, number, names), turnings


def _stops(mechanism: Mechanism, number: Mapping[str, int], turning: Sequence[str]) -> list[Row]:
    """Rows of the stops: the normal one, and of all of them those of friction that any has."""
    rows, laws = [], [stop.law for stop in mechanism.stops.values()]
    for name, stop in mechanism.stops.items():
        between = mechanism.joints[stop.joint].between if isinstance(stop, AngleStop) else stop.between
        two = number[between[0]], number[between[1]]
        angles = ((turning.index(stop.joint), stop.sign),) if isinstance(stop, AngleStop) else ()
        rows.append(Row(name=name, bodies=two, row=stop.row(), fixed=False, angles=angles))
        others = stop.tangential_rows(mechanism.dim) if any(law.rough for law in laws) else []
        others += stop.turning_rows(mechanism.dim) if any(law.turns for law in laws) else []
        rows += [Row(name=name, bodies=two, row=row, fixed=False, rank=k + 1) for k, row in enumerate(others)]
    return rows


def _gears(mechanism: Mechanism, number: Mapping[str, int], turning: Sequence[str]) -> list[Row]:
    """Rows of the gears: of the travel, if there is one, and of the angles."""
    rows, zero = [], np.zeros(3)
    for name, gear in mechanism.gears.items():
        first, second = gear.joints
        ratio = gear.ratio
        if travel_axis(mechanism.joints[first]) is not None:
            first, second, ratio = second, first, 1.0 / ratio
        one, other = mechanism.joints[second], mechanism.joints[first]
        four = tuple(number[body] for body in (*one.between, *other.between))
        driving = (turning.index(first), -ratio)
        if travel_axis(one) is not None and (row := motor_row(one)) is not None:
            rows.append(Row(name=name, bodies=four, row=row, angles=((-1, 0.0), driving)))
        else:
            row = JointRow(kind=ANGLE, first=zero, second=zero, n=zero, m=zero)
            rows.append(Row(name=name, bodies=four, row=row, angles=((turning.index(second), 1.0), driving)))
    return rows


def _motors(mechanism: Mechanism, number: Mapping[str, int], turning: Sequence[str]) -> list[Row]:
    """Rows of the motors."""
    rows = []
    for name, motor in mechanism.motors.items():
        joint = mechanism.joints[motor.joint]
        if (row := motor_row(joint)) is not None:
            two = number[joint.between[0]], number[joint.between[1]]
            angles = ((turning.index(motor.joint), row.ratio),) if row.ratio else ()
            rows.append(Row(name=name, bodies=two, row=row, angles=angles, motion=motor.motion))
    return rows


def joint_tables(rows: Sequence[Row], turnings: Mapping[str, Turning], centres: Array) -> tuple[Joints, IntArray]:
    """Rows in an order of small band width, and that order."""
    ground = len(centres) - 1
    width = max((len(row.bodies) for row in rows), default=2)
    sides = np.full((len(rows), width), ground, dtype=np.int64)
    angle, ratio = np.full((len(rows), 2), -1, dtype=np.int64), np.zeros((len(rows), 2))
    for k, row in enumerate(rows):
        sides[k, : len(row.bodies)] = row.bodies
        for t, (which, factor) in enumerate(row.angles):
            angle[k, t], ratio[k, t] = which, factor
    order, pairs = _ordered(sides, ground)
    sides, found = sides[order], [rows[k].row for k in order]
    first, second = sides[:, 0].copy(), sides[:, 1].copy()
    joints = Joints(
        kind=np.array([r.kind for r in found], dtype=np.int64),
        a=first,
        b=second,
        sides=sides,
        X=_table([r.first for r in found]) - centres[first],
        Y=_table([r.second for r in found]) - centres[second],
        N=_table([r.n for r in found]),
        B=_table([r.m for r in found]),
        value=np.array([r.value for r in found], dtype=float),
        pairs=pairs,
        width=int((pairs[:, 0] - pairs[:, 1]).max(initial=0)),
        angles=_angles(list(turnings.values())),
        angle=angle[order],
        ratio=ratio[order],
        drives=_drives([rows[k].motion for k in order]),
    )
    return joints, order


def _ordered(sides: IntArray, ground: int) -> tuple[IntArray, IntArray]:
    """Order (r,) of the rows, and pairs (p, 4) of rows in that order that share a body, with their sides."""
    of_body: list[list[int]] = [[] for _ in range(ground)]
    for k, bodies in enumerate(sides):
        for i in set(bodies.tolist()) - {ground}:
            of_body[i].append(k)
    linked = {(i, j) for mine in of_body for i in mine for j in mine}
    if not linked:
        return np.arange(len(sides)), np.zeros((0, 4), dtype=np.int64)
    graph = sp.csr_array(
        (np.ones(len(linked)), tuple(np.array(sorted(linked)).reshape(-1, 2).T)), shape=(len(sides),) * 2
    )
    order = np.asarray(reverse_cuthill_mckee(graph, symmetric_mode=True), dtype=np.int64)
    place, moved = np.argsort(order), sides[order]
    pairs = set()
    for i, j in ((int(place[i]), int(place[j])) for i, j in linked if place[i] >= place[j]):
        for si, p in enumerate(moved[i]):
            pairs |= {(i, j, si, sj) for sj, q in enumerate(moved[j]) if p == q != ground}
    return order, np.array(sorted(pairs), dtype=np.int64).reshape(-1, 4)


def _angles(turnings: Sequence[Turning]) -> Angles:
    """Table of the angles."""
    across = [axes(tuple(turning.axis.tolist()), turning)[1:] for turning in turnings]
    u = _table([one for one, _ in across])
    return Angles(
        a=np.array([turning.a for turning in turnings], dtype=np.int64),
        b=np.array([turning.b for turning in turnings], dtype=np.int64),
        U=u,
        V=_table([other for _, other in across]),
        W=u.copy(),
    )


def _drives(motions: Sequence[Prescribed | None]) -> Drives:
    """Table of the prescribed motions."""
    row = [k for k, motion in enumerate(motions) if motion is not None]
    given = [motion for motion in motions if motion is not None]
    laws = [_since_the_start(motion) for motion in given]
    return Drives(
        row=np.array(row, dtype=np.int64),
        first=np.cumsum([0, *(len(law) for law in laws)], dtype=np.int64),
        pieces=np.concatenate([pieces(np.zeros(0), np.zeros((0, 1))), *laws]),
    )


def _since_the_start(motion: Prescribed) -> Array:
    """Pieces (q, 10) of a motion that is zero at t = 0."""
    law = motion.pieces.copy()
    law[:, 1] -= value_and_rate(law, 0.0)[0]
    return law


def _table(vectors: Sequence[Array]) -> Array:
    return np.array(vectors, dtype=float).reshape(-1, 3)


def require_inertia(mechanism: Mechanism, rows: Sequence[Row], centres: Array) -> None:
    """Refuse joints that turn a body about an axis without inertia: they would hold it instead."""
    names = [*mechanism.bodies, GROUND]
    for it in rows:
        (a, b), row = it.bodies[:2], it.row
        moment = row.kind >= TURN and bool(row.m.any())
        for i, point, turning in (
            (a, row.first, moment or row.kind in (ALONG, DIRECTION, ANGLE, SLIDE)),
            (b, row.second, moment or row.kind in (DIRECTION, ANGLE)),
        ):
            if names[i] == GROUND:
                continue
            empty, arm = _without_inertia(mechanism, names[i]), point - centres[i]
            felt = np.linalg.norm(np.cross(empty, arm), axis=1) > FELT * float(np.linalg.norm(arm))
            if felt.any() or (turning and len(empty)):
                problem = f"turns {names[i]!r} about an axis without inertia"
                raise InputError(f"joints.{it.name}", problem, "its inertia, or a Rod to the centre of a point mass")


def _without_inertia(mechanism: Mechanism, name: str) -> Array:
    """Axes (k, 3) about which a body may turn and has no inertia."""
    tensor = mechanism.bodies[name].tensor
    if mechanism.dim == 2:
        return np.zeros((0, 3)) if tensor[2, 2] else np.array([[0.0, 0.0, 1.0]])
    values, axes = np.linalg.eigh(tensor)
    found: Array = axes[:, values <= FELT * max(float(values.max()), 1e-300)].T
    return found
