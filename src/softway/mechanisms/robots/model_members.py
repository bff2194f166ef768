"""Bodies, joints, loops and springs of a MuJoCo model as members of a mechanism."""

from collections.abc import Mapping, Sequence
from types import ModuleType
from typing import Any

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.mechanisms.members.couplings import Gear
from softway.mechanisms.members.joints import (
    GROUND,
    BallJoint,
    Cylindrical,
    Hinge,
    Joint,
    Slider,
    Universal,
    Weld,
    travel_axis,
)
from softway.mechanisms.members.rigid import Rigid
from softway.mechanisms.members.springs import TorsionSpring
from softway.mechanisms.robots.left_out import named

FREE, BALL, SLIDE, HINGE = range(4)
"""Types of joints of MuJoCo."""
CONNECT, COUPLED = 0, 2
"""Types of equalities of MuJoCo."""
SAME = 1e-9
"""Rounding of directions, and of places relative to one metre."""


def _point(vector: Array) -> tuple[float, float, float]:
    x, y, z = np.asarray(vector, float).tolist()
    return x, y, z


def _state(mujoco: ModuleType, model: Any) -> Any:
    """Places at the reference position."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return data


def model_bodies(mujoco: ModuleType, model: Any) -> tuple[dict[str, Rigid], list[str]]:
    """Bodies with mass by name, and for each body of the model the name of that which it is part of."""
    bodies: dict[str, Rigid] = {}
    part_of, data = [GROUND], _state(mujoco, model)
    for k in range(1, model.nbody):
        parent, mass = part_of[model.body_parentid[k]], float(model.body_mass[k])
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, k) or f"body {k}"
        fixed = model.body_jntnum[k] == 0
        if fixed and (parent == GROUND or mass == 0.0):
            part_of.append(parent)
            continue
        if not mass > 0.0:
            raise InputError(f"body {name!r}", "moves and has no mass", "its mass and inertia")
        name = f"{name} (body)" if name == GROUND else name
        axes = data.ximat[k].reshape(3, 3)
        tensor = (axes * model.body_inertia[k]) @ axes.T
        inertia = tuple(map(tuple, (0.5 * (tensor + tensor.T)).tolist()))
        bodies[name] = Rigid(mass=mass, centre=_point(data.xipos[k]), inertia=inertia)
        part_of.append(name)
    return bodies, part_of


def model_joints(mujoco: ModuleType, model: Any, part_of: Sequence[str]) -> tuple[dict[str, Joint], dict[int, str]]:
    """Joints by name, and the name for the number of each joint of the model."""
    joints: dict[str, Joint] = {}
    of_joint: dict[int, str] = {}
    data = _state(mujoco, model)
    for k in range(1, model.nbody):
        between = (part_of[model.body_parentid[k]], part_of[k])
        numbers = range(int(model.body_jntadr[k]), int(model.body_jntadr[k]) + int(model.body_jntnum[k]))
        if not numbers:
            if between[0] != between[1] and between[1] != GROUND:
                joints[f"{between[1]} fixed"] = Weld(between=between, at=_point(data.xipos[k]))
            continue
        if [int(model.jnt_type[j]) for j in numbers] == [FREE]:
            continue
        given = [named(mujoco, model, "joint", j) for j in numbers]
        name = " + ".join(one.strip("'").replace("number", "joint") for one in given)
        joints[name] = _joint(model, data, numbers, between, ", ".join(given))
        of_joint |= dict.fromkeys(numbers, name)
    return joints, of_joint


def _joint(model: Any, data: Any, numbers: Sequence[int], between: tuple[str, str], given: str) -> Joint:
    """Joint that leaves the motions of one or two joints of the model."""
    types = [int(model.jnt_type[j]) for j in numbers]
    at, axes = [data.xanchor[j] for j in numbers], [_point(data.xaxis[j]) for j in numbers]
    if types == [HINGE]:
        return Hinge(between=between, at=_point(at[0]), axis=axes[0])
    if types == [SLIDE]:
        return Slider(between=between, at=_point(at[0]), axis=axes[0])
    if types == [BALL]:
        return BallJoint(between=between, at=_point(at[0]))
    if len(types) == 2:
        turn = int(types[1] == HINGE)
        apart = np.asarray(at[0]) - at[1]
        parallel = np.linalg.norm(np.cross(axes[0], axes[1])) <= SAME
        if sorted(types) == [SLIDE, HINGE] and parallel:
            return Cylindrical(between=between, at=_point(at[turn]), axis=axes[turn])
        if types == [HINGE, HINGE] and abs(np.dot(axes[0], axes[1])) <= SAME and np.linalg.norm(apart) <= SAME:
            return Universal(between=between, at=_point(at[0]), axes=(axes[0], axes[1]))
    problem = f"has the joints {given} at once, which no joint of the package replaces"
    raise InputError(f"body {between[1]!r}", problem, "a body with mass for each joint between them")


def model_loops(
    mujoco: ModuleType, model: Any, part_of: Sequence[str], of_joint: Mapping[int, str], joints: Mapping[str, Joint]
) -> tuple[dict[str, Joint], dict[str, Gear], list[str]]:
    """Ball joints that close loops and gears by name, and equalities that are neither."""
    loops: dict[str, Joint] = {}
    gears: dict[str, Gear] = {}
    unread: list[str] = []
    data = _state(mujoco, model)
    for k in range(model.neq):
        label = f"equality {named(mujoco, model, 'equality', k)}"
        one, other, numbers = int(model.eq_obj1id[k]), int(model.eq_obj2id[k]), model.eq_data[k]
        bodily = int(model.eq_objtype[k]) == int(mujoco.mjtObj.mjOBJ_BODY)
        if not model.eq_active0[k]:
            unread.append(f"{label}, which is switched off")
        elif int(model.eq_type[k]) == CONNECT and bodily and part_of[one] != part_of[other]:
            at = data.xpos[one] + data.xmat[one].reshape(3, 3) @ numbers[:3]
            loops[label] = BallJoint(between=(part_of[one], part_of[other]), at=_point(at))
        elif int(model.eq_type[k]) == COUPLED and _geared(model, one, other, numbers, of_joint, joints):
            gears[label] = Gear(joints=(of_joint[other], of_joint[one]), ratio=float(numbers[1]))
        else:
            unread.append(label)
    return loops, gears, unread


def _geared(
    model: Any, one: int, other: int, numbers: Array, of_joint: Mapping[int, str], joints: Mapping[str, Joint]
) -> bool:
    """True for a linear coupling of two joints with one motion each, at least one of them an angle."""
    if other < 0 or numbers[0] or not numbers[1] or np.any(numbers[2:5]):
        return False
    if not all(int(model.jnt_type[j]) in (SLIDE, HINGE) and j in of_joint for j in (one, other)):
        return False
    found = [joints[of_joint[j]] for j in (one, other)]
    single = all(isinstance(joint, Hinge | Slider) for joint in found)
    return single and any(travel_axis(joint) is None for joint in found)


def model_springs(
    model: Any, joints: Mapping[str, Joint], of_joint: Mapping[int, str]
) -> tuple[tuple[TorsionSpring, ...], list[str]]:
    """Springs and dampers of hinges, and the names of the joints whose springs or dampers are not read."""
    springs, unread = [], []
    for j, name in of_joint.items():
        first = int(model.jnt_dofadr[j])
        freedoms = slice(first, first + (6, 3, 1, 1)[int(model.jnt_type[j])])
        stiffness, damping = float(model.jnt_stiffness[j]), float(model.dof_damping[freedoms].max())
        if not (stiffness or damping):
            continue
        if isinstance(joints[name], Hinge):
            place = int(model.jnt_qposadr[j])
            rest = float(model.qpos_spring[place] - model.qpos0[place])
            springs.append(TorsionSpring(joint=name, stiffness=stiffness, rest=rest, damping=damping))
        else:
            unread.append(f"spring or damper of the joint {name!r}")
    return tuple(springs), unread
