"""Rigid bodies of a stored run with solids: their shapes, at the places that ``rigid.csv`` tells."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from softway.bodies.prescribed_motion import PlacedShape, Pose
from softway.bodies.solid import Tool
from softway.obstacles.primitives import Shape
from softway.record.storage.table import Table, read
from softway.record.write.mechanism.columns import placed
from softway.record.write.mechanism.rigid_table import FILE


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RecordedBody:
    """Shape of a rigid body with its motion in a table; it is ``at`` the place of the line that is nearest in time.

    Parameters
    ----------
    name, shape
        Name of the body, and its shape at the start.
    motion
        Table of the motion of all bodies.
    """

    name: str
    shape: Shape
    motion: Table

    def at(self, time: float) -> PlacedShape:
        """Shape at its place at a time [s]."""
        row = int(np.argmin(np.abs(self.motion["time"] - time)))
        (first, _), (centre, rotation) = (placed(self.motion, self.name, k) for k in (0, row))
        return PlacedShape(shape=self.shape, pose=Pose(rotation=rotation, shift=centre - rotation @ first))


def recorded_bodies(folder: Path, tools: Mapping[str, Tool | None]) -> dict[str, RecordedBody]:
    """Bodies with these shapes, given as tools at rest, whose motion is in a run folder.

    Raises
    ------
    InputError
        If the table of the motion is missing or damaged.
    """
    if not tools:
        return {}
    needed: list[tuple[str, str]] = [("time", "s")]
    motion: Any = read(folder / FILE, needed)
    return {n: RecordedBody(name=n, shape=t.shape, motion=motion) for n, t in tools.items() if t is not None}
