"""Mechanisms from URDF and MJCF files, which MuJoCo reads (``pip install 'softway[robots]'``)."""

from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

from softway.errors import InputError, within
from softway.mechanisms.members.mechanism import Mechanism
from softway.mechanisms.robots.left_out import left_out_of_model
from softway.mechanisms.robots.model_members import model_bodies, model_joints, model_loops, model_springs
from softway.mechanisms.robots.urdf import urdf_without_geometry

SUFFIXES = (".urdf", ".xml", ".mjcf")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RobotFile:
    """Mechanism of a file of a robot, and what of the file it does not have.

    Parameters
    ----------
    mechanism
        The mechanism, at rest at the reference position of the file.
    left_out
        Elements of the file that the mechanism does not have, by name, such as limits of joints and actuators.
    """

    mechanism: Mechanism
    left_out: tuple[str, ...]


def read_robot(path: str | Path) -> RobotFile:
    """Read a URDF or MJCF file: bodies, joints, loops, springs and dampers of hinges, and gravity.

    Hinges, slides, balls and free joints are read, cylindrical and universal joints of two of them, fixed bodies as
    welds or parts of the ground, ``connect`` as ball joints, and linear couplings of joints (``mimic``) as gears.  The
    inertia of MJCF bodies may come from their geometry.  A URDF robot stands on its first link.

    Parameters
    ----------
    path
        Path of the file, ``.urdf``, ``.xml`` or ``.mjcf``.

    Raises
    ------
    InputError
        If MuJoCo is not installed or does not read the file, if a body that moves has no mass, or has joints that no
        joint of the package replaces.

    Examples
    --------
    >>> read_robot("arm.urdf")  # doctest: +SKIP
    RobotFile(mechanism=Mechanism(...), left_out=("limits of the joint 'shoulder'", "actuator 'motor'"))
    """
    path = Path(path)
    if path.suffix.lower() not in SUFFIXES:
        raise InputError("path", f"{path.name} has the ending {path.suffix!r}", f"one of: {', '.join(SUFFIXES)}")
    if not path.is_file():
        raise InputError("path", f"no such file: {str(path):.300}", "the path of a URDF or MJCF file")
    mujoco = _mujoco()
    with within(path.name):
        model, missing = _compiled(mujoco, path)
        bodies, part_of = model_bodies(mujoco, model)
        joints, of_joint = model_joints(mujoco, model, part_of)
        loops, gears, open_loops = model_loops(mujoco, model, part_of, of_joint, joints)
        springs, slack = model_springs(model, joints, of_joint)
        mechanism = Mechanism(
            bodies=bodies,
            joints=joints | loops,
            gears=gears,
            springs=springs,
            gravity=tuple(model.opt.gravity.tolist()),
        )
    return RobotFile(
        mechanism=mechanism,
        left_out=(*missing, *open_loops, *slack, *left_out_of_model(mujoco, model)),
    )


def _mujoco() -> ModuleType:
    """Module of MuJoCo."""
    try:
        import mujoco
    except ImportError:
        raise InputError(
            "path", "MuJoCo, which reads the file, is not installed", "pip install 'softway[robots]'"
        ) from None
    found: ModuleType = mujoco
    return found


def _compiled(mujoco: ModuleType, path: Path) -> tuple[Any, tuple[str, ...]]:
    """Model of a file, and what was taken out of a URDF file before."""
    try:
        text = path.read_text(encoding="utf-8")
        stripped = urdf_without_geometry(text)
        spec = mujoco.MjSpec.from_string(stripped.text) if stripped else mujoco.MjSpec.from_file(str(path))
        spec.compiler.fusestatic = False
        return spec.compile(), stripped.left_out if stripped else ()
    except (ValueError, UnicodeDecodeError) as error:
        raise InputError("", f"MuJoCo does not read it: {str(error):.300}", "a file that MuJoCo compiles") from None
