"""Places of the parts of a mechanism at its stored instants, seen from the front or, in space, from a corner."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from softway.arrays import Array
from softway.mechanisms.members.joints import GROUND
from softway.record.read.records import Records
from softway.record.storage.table import Table
from softway.record.write.mechanism.columns import placed

CORNER = ((-0.5, 0.866, 0.0), (-0.433, -0.25, 0.866))
"""View (2, 3) from a corner: z points upwards."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Poses:
    """Places of a mechanism.

    Parameters
    ----------
    parts
        Outline of the mechanism.
    motion
        Table of the motion.
    feet
        For each stop with a plane of the ground, the place on the plane that its point comes nearest to.
    """

    parts: Mapping[str, Any]
    motion: Table
    feet: Mapping[str, Array]

    @property
    def times(self) -> Array:
        """Stored instants (t,) [s]."""
        return self.motion["time"]

    def point(self, body: str, start: Sequence[float], row: int) -> Array:
        """Place (2,) in the picture of a point of a body that is at ``start`` at the start, in a row of the table."""
        place = np.asarray(start, float)
        if body != GROUND:
            centre, rotation = placed(self.motion, body, row)
            place = centre + rotation @ (place - np.asarray(self.parts["bodies"][body], float))
        return seen(place)

    def points(self, body: str, row: int) -> Array:
        """Places (n, 2) of the joints and springs of a body, of its centre if it has none but one."""
        ends = [
            (tuple(point), None)
            for part in (*self.parts["joints"], *self.parts["springs"], *self._tips())
            for name, point in zip(part["between"], part["points"], strict=True)
            if name == body
        ]
        starts = [point for point, _ in dict.fromkeys(ends)]
        if len(starts) < 2:
            starts.append(tuple(self.parts["bodies"][body]))
        return np.array([self.point(body, start, row) for start in dict.fromkeys(starts)])

    def _tips(self) -> list[Mapping[str, Any]]:
        """Stops that a point without a size touches: bodies reach to it."""
        return [stop for stop in self.parts["stops"] if stop["kind"] == "PlaneStop" and not stop["radius"]]

    def path(self, body: str, start: Sequence[float]) -> Array:
        """Path (t, 2) of a point of a body."""
        return np.array([self.point(body, start, row) for row in range(self.motion.rows)])

    def direction(self, body: str, start: Sequence[float], row: int) -> Array:
        """Direction (2,) in the picture of one that is fixed in a body."""
        way = np.asarray(start, float)
        return seen(way if body == GROUND else placed(self.motion, body, row)[1] @ way)


def seen(place: Array) -> Array:
    """Place or direction (2,) in the picture of one in the plane or in space."""
    return place if len(place) == 2 else np.array(CORNER) @ place


def poses(run: Records) -> Poses:
    """Places of a recorded mechanism."""
    parts, motion = run.outline, run.motion
    planes = [stop for stop in parts["stops"] if stop["kind"] == "PlaneStop" and stop["between"][0] == GROUND]
    return Poses(parts=parts, motion=motion, feet={stop["name"]: _foot(parts, motion, stop) for stop in planes})


def _foot(parts: Mapping[str, Any], motion: Table, stop: Mapping[str, Any]) -> Array:
    """Place (d,) on the plane of a stop that its point comes nearest to."""
    at, normal = (np.asarray(x, float) for x in (stop["points"][0], stop["normal"]))
    body, start = stop["between"][1], np.asarray(stop["points"][1], float)
    arm, normal = start - np.asarray(parts["bodies"][body], float), normal / np.linalg.norm(normal)
    places = np.array([c + r @ arm for c, r in (placed(motion, body, row) for row in range(motion.rows))])
    gaps = (places - at) @ normal
    nearest = int(np.argmin(gaps))
    return np.asarray(places[nearest] - gaps[nearest] * normal)
