"""Start of a march of a mechanism with stops."""

from collections.abc import Mapping

import numpy as np

from softway.arrays import IntArray
from softway.kernels.multibody.tables import Space
from softway.mechanisms.arrays import Arrays
from softway.mechanisms.impacts import StopMarch
from softway.mechanisms.stops import Impacts, Stop


def stop_march(it: Arrays, room: Space, stops: Mapping[str, Stop], law: Impacts) -> StopMarch:
    """March with stops; all of them are open at first."""
    rows = np.array([k for k, name in enumerate(it.joint_of) if name in stops], dtype=np.int64)
    given = [stops[it.joint_of[k]] for k in rows]
    room.active[rows] = 0
    return StopMarch(
        it=it,
        room=room,
        rows=rows,
        sign=np.array([stop.sign for stop in given]),
        restitution=np.array([stop.restitution for stop in given]),
        names=tuple(it.joint_of[k] for k in rows),
        law=law,
        held=_held(it, rows),
        closed=np.zeros(len(rows), bool),
        touched=np.full(len(rows), -np.inf),
    )


def _held(it: Arrays, stops: IntArray) -> IntArray:
    """Groups (g,) that the ground holds by joints, springs or torques."""
    ground, held = len(it.names), np.zeros(len(it.bodies.jointed), dtype=np.int64)
    joints = np.setdiff1d(np.arange(len(it.joint_of)), stops)
    for a, b in ((it.joints.a[joints], it.joints.b[joints]), (it.springs.a, it.springs.b)):
        both = np.stack([a, b])
        held[it.bodies.group[both.min(axis=0)[(both == ground).any(axis=0)]]] = 1
    held[it.bodies.group[it.springs.turned]] = 1
    return held
