"""Start of a march of a mechanism with stops."""

from collections.abc import Mapping

import numpy as np

from softway.kernels.multibody.tables import Space
from softway.mechanisms.arrays import Arrays
from softway.mechanisms.impacts import StopMarch
from softway.mechanisms.members.stops import Impacts, Stop


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
        held=it.bodies.supported.copy(),
        closed=np.zeros(len(rows), bool),
        touched=np.full(len(rows), -np.inf),
    )
