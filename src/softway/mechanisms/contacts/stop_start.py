"""Start of a march of a mechanism with stops."""

from collections.abc import Mapping

import numpy as np

from softway.kernels.multibody.joint_rows import ANGLE, SLIDE
from softway.kernels.multibody.tables import Space
from softway.mechanisms.arrays import Arrays
from softway.mechanisms.contacts.impacts import StopMarch
from softway.mechanisms.contacts.stop_rows import Stops
from softway.mechanisms.members.stops import Impacts, Restitution, Stop


def stop_march(it: Arrays, room: Space, stops: Mapping[str, Stop], law: Impacts, restitution: Restitution) -> StopMarch:
    """March with stops; all of them are open at first."""
    names = tuple(dict.fromkeys(name for name in it.joint_of if name in stops))
    rows = np.array([_rows_of(it, name) for name in names], dtype=np.int64)
    room.active[rows.ravel()] = 0
    found = Stops(
        it=it,
        room=room,
        rows=rows,
        restitution=np.array([stops[name].restitution for name in names], dtype=float),
        friction=np.array([stops[name].friction for name in names], dtype=float),
        names=names,
        held=it.bodies.supported.copy(),
        closed=np.zeros(len(rows), bool),
        sliding=np.ones(len(rows), bool),
    )
    return StopMarch(stops=found, law=law, restitution=restitution, touched=np.full(len(rows), -np.inf))


def _rows_of(it: Arrays, name: str) -> list[int]:
    """Rows of a stop: the normal one first."""
    mine = [k for k, other in enumerate(it.joint_of) if other == name]
    without_value = (it.joints.kind >= SLIDE) | ((it.joints.kind == ANGLE) & (it.joints.angle[:, 0] < 0))
    return sorted(mine, key=lambda k: bool(without_value[k]))
