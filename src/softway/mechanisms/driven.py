"""Motors whose motion others determine already."""

from collections.abc import Collection

from softway.errors import InputError
from softway.kernels.multibody.slab import begin, prepare_joints
from softway.kernels.multibody.tables import Space, space
from softway.mechanisms.arrays import Arrays


def require_free_motions(it: Arrays, room: Space) -> None:
    """Refuse motors of motions that the joints, or other motors, determine at the start."""
    rows = it.joints.drives.row
    if not len(rows):
        return
    kept = room.active.copy()
    room.active[rows] = 0
    prepare_joints(it.bodies, it.joints, it.motion, room)
    rank = int((room.pivot > 0.0).sum())
    for row in rows:
        room.active[row] = kept[row]
        prepare_joints(it.bodies, it.joints, it.motion, room)
        if int((room.pivot > 0.0).sum()) == rank:
            problem = "prescribes a motion that joints or other motors determine at the start"
            raise InputError(f"motors.{it.joint_of[row]}", problem, "one motor for each motion that the joints leave")
        rank += 1


def check_motions(it: Arrays, stops: Collection[str]) -> None:
    """Refuse such motors before a march; the ``stops`` are open.

    Raises
    ------
    InputError
        With the name of the motor.
    """
    if len(it.joints.drives.row):
        room = space(it.joints, len(it.names), len(it.bodies.jointed))
        room.active[[name in stops for name in it.joint_of]] = 0
        begin(it.bodies, it.joints, it.springs, it.motion, room)
        require_free_motions(it, room)
