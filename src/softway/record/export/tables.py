"""Tables, lists and arrays of the motion of rigid bodies."""

import csv
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import MappingProxyType

import numpy as np

from softway.arrays import Array
from softway.record.read.body_motion import BodyMotion
from softway.record.storage.table import RATIO, TEXT, header

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


def csv_file(path: Path, time: Array, bodies: Mapping[str, BodyMotion]) -> None:
    """Write a table with a line for each instant and body."""
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


def json_file(path: Path, time: Array, bodies: Mapping[str, BodyMotion]) -> None:
    """Write nested lists."""
    parts = {name: {part: getattr(body, part).tolist() for part in UNITS} for name, body in bodies.items()}
    found = {"units": {"time": "s", **UNITS}, "time": time.tolist(), "bodies": parts}
    path.write_text(json.dumps(found) + "\n", encoding="utf-8")


def npz_file(path: Path, time: Array, bodies: Mapping[str, BodyMotion]) -> None:
    """Write arrays of NumPy."""
    arrays = {f"{name}.{part}": getattr(body, part) for name, body in bodies.items() for part in UNITS}
    np.savez_compressed(path, allow_pickle=False, time=time, **arrays)
