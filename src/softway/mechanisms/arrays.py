"""Arrays of a mechanism for the compiled slabs (time steps)."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import InputError
from softway.kernels.multibody.tables import Bodies, Joints, Motion, Space, Springs
from softway.kernels.rigid_course.course import reach
from softway.mechanisms.force_tables import spring_tables
from softway.mechanisms.members.joints import GROUND
from softway.mechanisms.members.mechanism import Mechanism
from softway.mechanisms.members.rigid import inverse
from softway.mechanisms.row_tables import joint_tables, require_inertia, rows_of


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Arrays:
    """Tables of a mechanism, its motion at the start, and the extent [m].

    ``joint_of`` are the names of the joints of the rows, and ``rank`` their numbers among those of a stop.
    """

    bodies: Bodies
    joints: Joints
    springs: Springs
    motion: Motion
    names: tuple[str, ...]
    joint_of: tuple[str, ...]
    rank: tuple[int, ...]
    extent: float

    def reach(self, h: float) -> float:
        """Extent of the mechanism with its places, or its way in a slab of length h: the scale of rounding [m]."""
        return float(reach(self.motion.place, self.motion.velocity, self.bodies.gravity, self.extent, h))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MechanismState:
    """State of the march of a mechanism at the end of a slab (time step), from which it goes on with the same bits.

    Parameters
    ----------
    slabs
        Number of slabs marched so far.
    time, span
        Time, and length of the slabs [s].
    energy
        Energy at the start of the march [J].
    numbers, flags
        Arrays of the march by name.
    """

    slabs: int
    time: float
    span: float
    energy: float
    numbers: Mapping[str, Array]
    flags: Mapping[str, IntArray]


def changing(
    it: Arrays, room: Space, stops: Mapping[str, Array | IntArray | BoolArray]
) -> dict[str, Array | IntArray | BoolArray]:
    """Arrays that a march changes, by name; those of its ``stops`` among them.

    Addresses are not: they belong to this process, and no state may bring one.
    """
    space = {name: array for name, array in room._asdict().items() if name != "cone"}
    tables = [("motion", it.motion._asdict()), ("space", space), ("stops", stops)]
    found = {f"{table}.{name}": array for table, arrays in tables for name, array in arrays.items()}
    return {**found, "supported": it.bodies.supported}


def captured(
    tables: Mapping[str, Array | IntArray | BoolArray], slabs: int, time: float, span: float, energy: float
) -> MechanismState:
    """State of a march, with copies of the arrays that it changes."""
    numbers = {name: array.astype(np.float64) for name, array in tables.items() if array.dtype.kind == "f"}
    flags = {name: array.astype(np.int64) for name, array in tables.items() if array.dtype.kind != "f"}
    return MechanismState(slabs=slabs, time=time, span=span, energy=energy, numbers=numbers, flags=flags)


def restore(tables: Mapping[str, Array | IntArray | BoolArray], state: MechanismState, span: float) -> None:
    """Set the arrays that a march changes to those of a state.

    Raises
    ------
    InputError
        If the state is not one of this mechanism, or has slabs of another length.
    """
    stored: dict[str, Array | IntArray] = {**state.numbers, **state.flags}
    if {name: array.shape for name, array in stored.items()} != {name: a.shape for name, a in tables.items()}:
        raise InputError("state", "is one of another mechanism", "a state of a march of this mechanism")
    if state.span != span:
        problem = f"has slabs of {state.span:.17g} s instead of {span:.17g} s"
        raise InputError("state", problem, "the end and the step of the march that it comes from")
    for name, array in tables.items():
        array[:] = stored[name]


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
    rows, angles = rows_of(mechanism, number)
    joints, order = joint_tables(rows, angles, centres)
    springs = spring_tables(mechanism, number, centres, tuple(angles))
    bodies = _bodies(mechanism, joints, springs, np.array([rows[k].fixed for k in order], dtype=bool))
    require_inertia(mechanism, [rows[k] for k in order], centres)
    return Arrays(
        bodies=bodies,
        joints=joints,
        springs=springs,
        motion=_motion(mechanism, centres, joints, len(bodies.jointed)),
        names=names,
        joint_of=tuple(rows[k].name for k in order),
        rank=tuple(rows[k].rank for k in order),
        extent=float(
            max(np.abs(joints.X).max(initial=0.0), np.abs(joints.Y).max(initial=0.0), np.ptp(centres, 0).max())
        ),
    )


def _bodies(mechanism: Mechanism, joints: Joints, springs: Springs, fixed: BoolArray) -> Bodies:
    """Table of the bodies, and their groups: bodies connected by joints, stops or springs.

    The ``fixed`` rows (r,), those of joints, hold their group if they lead to the ground; closed stops do, too.
    """
    given, ground = list(mechanism.bodies.values()), len(mechanism.bodies)
    first, second = np.concatenate([joints.a, springs.a]), np.concatenate([joints.b, springs.b])
    inner = (first != ground) & (second != ground)
    two = [joints.sides[:, pair] for pair in combinations(range(joints.sides.shape[1]), 2)]
    linked = np.concatenate([np.stack([springs.a, springs.b], axis=1), *two])
    linked = linked[(linked != ground).all(axis=1)]
    links = sp.coo_array((np.ones(len(linked)), tuple(linked.T)), shape=(ground, ground))
    groups, group = connected_components(links, directed=False)
    held = np.zeros(groups, dtype=np.int64)
    holds = np.concatenate([fixed, np.ones(len(springs.a), bool)]) & ~inner
    held[group[np.minimum(first, second)[holds]]] = 1
    jointed = np.zeros(groups, dtype=np.int64)
    jointed[group[np.minimum(joints.a, joints.b)]] = 1
    loaded = mechanism.gravity is not None and any(mechanism.gravity)
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


def _motion(mechanism: Mechanism, centres: Array, joints: Joints, groups: int) -> Motion:
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
        angle=np.zeros(len(joints.angles.a)),
        impulse=np.zeros(len(joints.kind)),
        energy=np.zeros(groups),
        work=np.zeros(2),
        time=np.zeros(2),
    )
