"""Start of a march of a mechanism with stops."""

import numpy as np

from softway.kernels.multibody.tables import Space
from softway.kernels.rigid_contact.cone_call import cone
from softway.mechanisms.arrays import Arrays
from softway.mechanisms.contacts.impacts import StopMarch
from softway.mechanisms.contacts.stop_rows import Stops
from softway.mechanisms.members.mechanism import Mechanism
from softway.mechanisms.members.rows import in_space
from softway.mechanisms.members.stops import PlaneStop


def stop_march(it: Arrays, room: Space, mechanism: Mechanism) -> StopMarch:
    """March with the stops of a mechanism; all of them are open at first."""
    stops, dim = mechanism.stops, mechanism.dim
    names = tuple(dict.fromkeys(name for name in it.joint_of if name in stops))
    rows, laws = np.array([_rows_of(it, name) for name in names], dtype=np.int64), [stops[name].law for name in names]
    room.active[rows.ravel()], room.cone[0] = 0, cone().address
    for name, mine in zip(names, rows, strict=True):
        stop = stops[name]
        if isinstance(stop, PlaneStop) and stop.velocity is not None:
            sliding = mine[1:dim]
            room.rate[sliding] = it.joints.B[sliding] @ in_space(stop.velocity)
    blocks = 1 if rows.shape[1] <= dim else dim
    coefficients = [[law.friction, law.rolling, law.drilling][:blocks] for law in laws]
    found = Stops(
        it=it,
        room=room,
        rows=rows,
        restitution=np.array([stops[name].restitution for name in names], dtype=float),
        friction=np.array(coefficients, dtype=float),
        static=np.array([law.at_rest for law in laws], dtype=float),
        located=np.array([law.mu_s is not None for law in laws], dtype=bool),
        names=names,
        held=it.bodies.supported.copy(),
        closed=np.zeros(len(rows), bool),
        sliding=np.ones(len(rows), bool),
        turning=np.zeros((len(rows), blocks - 1), bool),
        told=np.full(len(rows), -1, dtype=np.int64),
        spent=np.zeros(len(rows)),
        shut=np.zeros(len(rows)),
    )
    return StopMarch(
        stops=found, law=mechanism.impacts, restitution=mechanism.restitution, touched=np.full(len(rows), -np.inf)
    )


def _rows_of(it: Arrays, name: str) -> list[int]:
    """Rows of a stop: the normal one first, then those of the sliding, the rolling and the drilling."""
    return sorted((k for k, other in enumerate(it.joint_of) if other == name), key=lambda k: it.rank[k])
