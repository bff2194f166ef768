"""Places of the parts of a mechanism at its stored instants, seen from the front or, in space, from a corner."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from softway.arrays import Array
from softway.mechanisms.members.joints import GROUND
from softway.mechanisms.members.rows import in_space
from softway.mechanisms.members.stop_friction import tangents
from softway.record.read.records import Records
from softway.record.storage.table import Table
from softway.record.write.mechanism.columns import placed

CORNER = ((-0.5, 0.866, 0.0), (-0.433, -0.25, 0.866))
"""View (2, 3) from a corner: z points upwards."""
NEAR = 0.25
"""Part of the way to a plane within which the plane is drawn."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Poses:
    """Places of a mechanism.

    Parameters
    ----------
    parts
        Outline of the mechanism.
    motion
        Table of the motion.
    floors
        For each stop with a plane of the ground, the corners (2^(d-1), d) of the part of it that its point comes near
        to: two in the plane, four in space.
    """

    parts: Mapping[str, Any]
    motion: Table
    floors: Mapping[str, Array]

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
        """Places (n, 2) of the joints, springs and stops of a body, and of its centre."""
        return np.array([self.point(body, start, row) for start in body_points(self.parts, body)])

    def path(self, body: str, start: Sequence[float]) -> Array:
        """Path (t, 2) of a point of a body."""
        return np.array([self.point(body, start, row) for row in range(self.motion.rows)])

    def turned(self, body: str, row: int) -> Array:
        """Rotation (d, d) of a body since the start."""
        return placed(self.motion, body, row)[1]

    def direction(self, body: str, start: Sequence[float], row: int) -> Array:
        """Direction (2,) in the picture of one that is fixed in a body."""
        way = np.asarray(start, float)
        return seen(way if body == GROUND else placed(self.motion, body, row)[1] @ way)


def seen(place: Array) -> Array:
    """Place or direction (2,) in the picture of one in the plane or in space."""
    return place if len(place) == 2 else np.array(CORNER) @ place


def body_points(parts: Mapping[str, Any], body: str) -> list[tuple[float, ...]]:
    """Points at the start of the joints, springs and stops of a body, and its centre."""
    starts = [
        tuple(point)
        for part in (*parts["joints"], *parts["springs"])
        for name, point in zip(part["between"], part["points"], strict=True)
        if name == body
    ]
    starts += [tuple(point) for stop in parts["stops"] for point in _tips(stop, body)]
    return list(dict.fromkeys([*starts, tuple(parts["bodies"][body])]))


def _tips(stop: Mapping[str, Any], body: str) -> list[list[float]]:
    """Points of a stop to which a body reaches: a plane of its own, a point without a size, the end of a string."""
    tips = {"PlaneStop": [True, not stop.get("radius")], "DistanceStop": [stop.get("side") == "most"] * 2}[stop["kind"]]
    ends = zip(stop["between"], stop["points"], tips, strict=True)
    return [point for name, point, reached in ends if name == body and reached]


def poses(run: Records) -> Poses:
    """Places of a recorded mechanism."""
    parts, motion = run.outline, run.motion
    planes = [stop for stop in parts["stops"] if stop["kind"] == "PlaneStop" and stop["between"][0] == GROUND]
    return Poses(parts=parts, motion=motion, floors={stop["name"]: _floor(parts, motion, stop) for stop in planes})


def _floor(parts: Mapping[str, Any], motion: Table, stop: Mapping[str, Any]) -> Array:
    """Corners (2^(d-1), d) of the part of the plane of a stop that its point comes near to."""
    at, normal = (np.asarray(x, float) for x in (stop["points"][0], stop["normal"]))
    body, start = stop["between"][1], np.asarray(stop["points"][1], float)
    arm, normal = start - np.asarray(parts["bodies"][body], float), normal / np.linalg.norm(normal)
    places = np.array([c + r @ arm for c, r in (placed(motion, body, row) for row in range(motion.rows))])
    gaps = (places - at) @ normal
    low, feet = float(gaps.min()), places - gaps[:, None] * normal
    near = feet[gaps <= low + NEAR * float(np.ptp(gaps))]
    across = [one[: len(normal)] for one in tangents(in_space(normal), len(normal))]
    corners = [near[0]]
    for one in across:
        ends = [float(f((near - near[0]) @ one)) for f in (np.min, np.max)]
        corners = [corner + end * one for end in ends for corner in corners]
    return np.array(corners)
