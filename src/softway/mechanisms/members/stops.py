"""Stops of a mechanism: unilateral joints without friction, which bodies hit with a coefficient of restitution."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from softway.errors import InputError
from softway.kernels.multibody.joint_rows import ALONG, DISTANCE
from softway.mechanisms.members.joints import JointRow, in_space
from softway.units import Metre, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class PlaneStop:
    """Stop that keeps a point of the second body in front of a plane of the first, or a ball around it.

    Parameters
    ----------
    between
        Names of the two bodies; one may be ``ground``.  The plane belongs to the first.
    point
        Point of the second body at the start [m].
    plane
        A point of the plane at the start [m].
    normal
        Direction from the plane to the allowed side at the start.
    radius
        Radius of the ball around the point [m].
    restitution
        Ratio of the normal velocities after and before an impact (Newton), between 0 and 1.

    Examples
    --------
    >>> floor = PlaneStop(between=("ground", "ball"), point=(0.0, 1.0), plane=(0.0, 0.0), normal=(0.0, 1.0))
    >>> floor.restitution
    0.0
    """

    between: tuple[str, str]
    point: tuple[Metre, ...]
    plane: tuple[Metre, ...]
    normal: tuple[float, ...]
    radius: Metre = 0.0
    restitution: Pure = 0.0

    def __post_init__(self) -> None:
        _require_restitution(self.restitution)
        if len(self.normal) != len(self.point) or not np.linalg.norm(self.normal) > 0.0:
            raise InputError("normal", f"{self.normal} is no direction", f"{len(self.point)} components, not all zero")
        if not self.radius >= 0.0:
            raise InputError("radius", f"{self.radius:g} m is negative", "zero or more")

    @property
    def places(self) -> tuple[tuple[float, ...], ...]:
        """Places that the stop names."""
        return self.point, self.plane

    @property
    def sign(self) -> float:
        """1: the value of the row is a gap."""
        return 1.0

    def row(self) -> JointRow:
        """Row of the stop."""
        normal, zero = in_space(self.normal), np.zeros(3)
        normal = normal / float(np.linalg.norm(normal))
        first, second = in_space(self.plane), in_space(self.point)
        return JointRow(kind=ALONG, first=first, second=second, n=normal, m=zero, value=self.radius)


@dataclass(frozen=True, slots=True, kw_only=True)
class DistanceStop:
    """Stop that keeps two points at least at a distance, as balls do, or at most, as a string does.

    Parameters
    ----------
    between
        Names of the two bodies; one may be ``ground``.
    points
        Point of the first body and point of the second at the start [m].
    distance
        The limit [m], positive.
    side
        ``least`` or ``most``.
    restitution
        Ratio of the velocities along the line after and before an impact (Newton), between 0 and 1.
    """

    between: tuple[str, str]
    points: tuple[tuple[Metre, ...], tuple[Metre, ...]]
    distance: Metre
    side: Literal["least", "most"] = "least"
    restitution: Pure = 0.0

    def __post_init__(self) -> None:
        _require_restitution(self.restitution)
        if self.side not in ("least", "most"):
            raise InputError("side", f"{self.side!r}", "'least' or 'most'")
        if not self.distance > 0.0:
            raise InputError("distance", f"{self.distance:g} m is not positive", "the distance at which the stop acts")

    @property
    def places(self) -> tuple[tuple[float, ...], ...]:
        """Places that the stop names."""
        return self.points

    @property
    def sign(self) -> float:
        """1 where the value of the row is a gap, -1 where it is the opposite."""
        return 1.0 if self.side == "least" else -1.0

    def row(self) -> JointRow:
        """Row of the stop."""
        first, second = (in_space(point) for point in self.points)
        return JointRow(
            kind=DISTANCE, first=first, second=second, n=np.zeros(3), m=np.zeros(3), value=float(self.distance)
        )


Stop = PlaneStop | DistanceStop
Impacts = Literal["simultaneous", "sequential"]


@dataclass(frozen=True, slots=True, kw_only=True)
class StopEvent:
    """Event of a stop.

    Parameters
    ----------
    time
        Instant [s]; of a ``rest`` the end of the sequence of touches that leads to it.
    stop
        Name of the stop.
    kind
        ``touch``, ``rest`` or ``release``.
    velocity_before, velocity_after
        Velocity of the gap before and after an impact [m/s], negative while it closes.
    impulse
        Impulse of the impact [N s].
    """

    time: float
    stop: str
    kind: Literal["touch", "rest", "release"]
    velocity_before: float = 0.0
    velocity_after: float = 0.0
    impulse: float = 0.0


def _require_restitution(value: float) -> None:
    """Refuse a coefficient that creates energy, or none."""
    if not 0.0 <= value <= 1.0:
        raise InputError("restitution", f"{value:g} is not between 0 and 1", "0 for no rebound, 1 for no loss")
