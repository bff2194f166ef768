"""Motion of the rigid bodies of a run as arrays, and its export to files of other programs."""

import csv
import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.record.read.records import Records
from softway.record.storage.table import RATIO, TEXT, Table, header
from softway.record.write.mechanism.columns import placed, quaternion

UNITS = MappingProxyType({"place": "m", "quaternion": RATIO, "rotation": RATIO, "velocity": "m/s", "spin": "rad/s"})
"""Units of the parts of a motion."""
ENTRIES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "place": ("x", "y", "z"),
        "quaternion": ("quaternion_w", "quaternion_x", "quaternion_y", "quaternion_z"),
        "rotation": tuple(f"rotation_{a}{b}" for a in "xyz" for b in "xyz"),
        "velocity": ("velocity_x", "velocity_y", "velocity_z"),
        "spin": ("spin_x", "spin_y", "spin_z"),
    }
)
"""Columns of the parts of a motion."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BodyMotion:
    """Motion of a rigid body at the stored instants t, in space; that of one in the plane has z = 0.

    Parameters
    ----------
    place
        (t, 3) places of the centre of mass [m].
    quaternion
        (t, 4) unit quaternions of the rotation since the start, scalar first and not negative.
    rotation
        (t, 3, 3) matrices of this rotation: a point X of the body at the start is at ``place + rotation @ (X - C)``
        with the centre C at the start.
    velocity
        (t, 3) velocities of the centre [m/s].
    spin
        (t, 3) angular velocities in the axes of the scene [rad/s].
    """

    place: Array
    quaternion: Array
    rotation: Array
    velocity: Array
    spin: Array


def body_motions(run: Records) -> dict[str, BodyMotion]:
    """Motion of each body of the run of a mechanism.

    Raises
    ------
    InputError
        If the run is not one of a mechanism.
    """
    motion = run.motion
    return {name: _motion(motion, name) for name in run.outline["bodies"]}


def export(run: Records, file: str | Path) -> Path:
    """Write the motion of the bodies of a mechanism to a file.

    Parameters
    ----------
    run
        Run of a mechanism.
    file
        ``.csv`` for a table with a line for each instant and body, ``.json`` for nested lists, ``.npz`` for arrays of
        NumPy named ``time`` and ``BODY.place`` and so on.  Numbers have all their digits in each of them.

    Raises
    ------
    InputError
        For another kind of file, a file that cannot be written, or the run of solids.
    """
    path = Path(file)
    if path.suffix not in FORMATS:
        raise InputError("--to", f"'{path}' is of no known kind", f"a name that ends in {', '.join(FORMATS)}")
    time, bodies = run.motion["time"], body_motions(run)
    try:
        FORMATS[path.suffix](path, time, bodies)
    except OSError as error:
        raise InputError("--to", f"cannot write '{path}': {error.strerror}", "a folder that exists") from None
    return path


def _motion(motion: Table, name: str) -> BodyMotion:
    """Motion of a body from the columns of the table."""
    plane = f"{name}.z" not in motion
    place, rotation = np.zeros((motion.rows, 3)), np.tile(np.eye(3), (motion.rows, 1, 1))
    velocity, spin = np.zeros((motion.rows, 3)), np.zeros((motion.rows, 3))
    for row in range(motion.rows):
        centre, turned = placed(motion, name, row)
        place[row, : len(centre)], rotation[row, : len(centre), : len(centre)] = centre, turned
    for k, axis in enumerate("xy" if plane else "xyz"):
        velocity[:, k] = motion[f"{name}.velocity_{axis}"]
    for k, key in ((2, "spin"),) if plane else enumerate(("spin_x", "spin_y", "spin_z")):
        spin[:, k] = motion[f"{name}.{key}"]
    turns = np.array([quaternion(one) for one in rotation]).reshape(-1, 4)
    return BodyMotion(place=place, quaternion=turns, rotation=rotation, velocity=velocity, spin=spin)


def _csv(path: Path, time: Array, bodies: Mapping[str, BodyMotion]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        lines = csv.writer(file, lineterminator="\n")
        columns = [(name, UNITS[part]) for part, names in ENTRIES.items() for name in names]
        lines.writerow(header([("time", "s"), ("body", TEXT), *columns]))
        for row, instant in enumerate(time):
            for name, body in bodies.items():
                lines.writerow([f"{instant:.17g}", name, *(f"{x:.17g}" for x in _numbers(body, row))])


def _numbers(body: BodyMotion, row: int) -> Iterator[float]:
    for part in ENTRIES:
        yield from getattr(body, part)[row].ravel().tolist()


def _json(path: Path, time: Array, bodies: Mapping[str, BodyMotion]) -> None:
    parts = {name: {part: getattr(body, part).tolist() for part in UNITS} for name, body in bodies.items()}
    found = {"units": {"time": "s", **UNITS}, "time": time.tolist(), "bodies": parts}
    path.write_text(json.dumps(found) + "\n", encoding="utf-8")


def _npz(path: Path, time: Array, bodies: Mapping[str, BodyMotion]) -> None:
    arrays = {f"{name}.{part}": getattr(body, part) for name, body in bodies.items() for part in UNITS}
    np.savez_compressed(path, allow_pickle=False, time=time, **arrays)


FORMATS: Mapping[str, Callable[[Path, Array, Mapping[str, BodyMotion]], None]] = MappingProxyType(
    {".csv": _csv, ".json": _json, ".npz": _npz}
)
"""Writers by the ending of the name."""
