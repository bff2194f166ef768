"""Stops of a mechanism: unilateral joints, which bodies hit with a coefficient of restitution, and friction."""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from softway.errors import InputError
from softway.kernels.multibody.joint_rows import ALONG, ANGLE, DISTANCE, ROLL, SLIDE
from softway.mechanisms.members.rows import JointRow, in_space
from softway.mechanisms.members.stop_friction import (
    StopFriction,
    require_belt,
    require_space,
    tangents,
    turns_on_line,
    turns_on_plane,
)
from softway.units import Metre, MetrePerSecond, Pure, Radian


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
        Coefficient of restitution, between 0 and 1: see ``restitution`` of :class:`~softway.mechanisms.Mechanism`.
    friction
        Coefficient of Coulomb's friction, at rest and in motion.
    mu_s
        Coefficient at rest, ``friction`` or more.  If it is given, the instants at which sliding begins and ends are
        located, and are events; at an impact ``friction`` acts.
    rolling
        Greatest moment against rolling, over the normal force [m].
    drilling
        Greatest moment against turning about the normal, over the normal force [m]; in space only.
    velocity
        Velocity of the surface of the first body against that body, as of a belt [m/s]: along the plane, in the axes at
        the start, and constant in the axes of the first body.

    Examples
    --------
    >>> floor = PlaneStop(between=("ground", "ball"), point=(0.0, 1.0), plane=(0.0, 0.0), normal=(0.0, 1.0))
    >>> floor.restitution
    0.0
    >>> belt = PlaneStop(between=("ground", "box"), point=(0.0, 0.0), plane=(0.0, 0.0), normal=(0.0, 1.0),
    ...                  friction=0.2, mu_s=0.4, velocity=(0.1, 0.0))
    >>> belt.law.at_rest
    0.4
    """

    between: tuple[str, str]
    point: tuple[Metre, ...]
    plane: tuple[Metre, ...]
    normal: tuple[float, ...]
    radius: Metre = 0.0
    restitution: Pure = 0.0
    friction: Pure = 0.0
    mu_s: Pure | None = None
    rolling: Metre = 0.0
    drilling: Metre = 0.0
    velocity: tuple[MetrePerSecond, ...] | None = None

    def __post_init__(self) -> None:
        _require_restitution(self.restitution)
        if len(self.normal) != len(self.point) or not np.linalg.norm(self.normal) > 0.0:
            raise InputError("normal", f"{self.normal} is no direction", f"{len(self.point)} components, not all zero")
        if not self.radius >= 0.0:
            raise InputError("radius", f"{self.radius:g} m is negative", "zero or more")
        require_space(self.law, len(self.point))
        require_belt(self.velocity, self.normal, self.law)

    @property
    def law(self) -> StopFriction:
        """Friction of the stop."""
        return StopFriction(friction=self.friction, mu_s=self.mu_s, rolling=self.rolling, drilling=self.drilling)

    @property
    def places(self) -> tuple[tuple[float, ...], ...]:
        """Places that the stop names."""
        return self.point, self.plane

    @property
    def gap(self) -> float:
        """Gap at the start [m]."""
        row = self.row()
        return float(row.n @ (row.second - row.first)) - self.radius

    def row(self) -> JointRow:
        """Row of the stop."""
        normal, zero = in_space(self.normal), np.zeros(3)
        normal = normal / float(np.linalg.norm(normal))
        first, second = in_space(self.plane), in_space(self.point)
        return JointRow(kind=ALONG, first=first, second=second, n=normal, m=zero, value=self.radius)

    def tangential_rows(self, dim: int) -> list[JointRow]:
        """Rows of the sliding: one in the plane, two in space."""
        row = self.row()
        across = tangents(row.n, dim)
        return [replace(row, kind=SLIDE, m=one) for one in across]

    def turning_rows(self, dim: int) -> list[JointRow]:
        """Rows of the rolling, one in the plane and two in space, and there of the drilling."""
        return turns_on_plane(self.row(), self.law, dim)


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
        Coefficient of restitution, between 0 and 1: see ``restitution`` of :class:`~softway.mechanisms.Mechanism`.
    friction
        Coefficient of Coulomb's friction, at rest and in motion.
    mu_s
        Coefficient at rest, ``friction`` or more.  If it is given, the instants at which sliding begins and ends are
        located, and are events; at an impact ``friction`` acts.
    rolling
        Greatest moment against rolling, over the normal force [m].
    drilling
        Greatest moment against turning about the normal, over the normal force [m]; in space only.
    contact
        Place of the friction on the line between the points, as a part of it from the first: one half for equal balls.
    """

    between: tuple[str, str]
    points: tuple[tuple[Metre, ...], tuple[Metre, ...]]
    distance: Metre
    side: Literal["least", "most"] = "least"
    restitution: Pure = 0.0
    friction: Pure = 0.0
    mu_s: Pure | None = None
    rolling: Metre = 0.0
    drilling: Metre = 0.0
    contact: Pure = 0.5

    def __post_init__(self) -> None:
        _require_restitution(self.restitution)
        require_space(self.law, len(self.points[0]))
        if self.side not in ("least", "most"):
            raise InputError("side", f"{self.side!r}", "'least' or 'most'")
        if not self.distance > 0.0:
            raise InputError("distance", f"{self.distance:g} m is not positive", "the distance at which the stop acts")

    @property
    def law(self) -> StopFriction:
        """Friction of the stop."""
        return StopFriction(friction=self.friction, mu_s=self.mu_s, rolling=self.rolling, drilling=self.drilling)

    @property
    def places(self) -> tuple[tuple[float, ...], ...]:
        """Places that the stop names."""
        return self.points

    @property
    def gap(self) -> float:
        """Gap at the start [m]."""
        apart = float(np.linalg.norm(np.subtract(*self.points))) - self.distance
        return apart if self.side == "least" else -apart

    def row(self) -> JointRow:
        """Row of the stop."""
        first, second = (in_space(point) for point in self.points)
        value = float(self.distance) if self.side == "least" else -float(self.distance)  # the sign of the gap
        return JointRow(kind=DISTANCE, first=first, second=second, n=np.zeros(3), m=np.zeros(3), value=value)

    def tangential_rows(self, dim: int) -> list[JointRow]:
        """Rows of the sliding: one in the plane, two in space."""
        kinds = [np.array([float(k), 0.0, 0.0]) for k in range(dim - 1)]
        return [replace(self.row(), kind=ROLL, m=one, value=self.contact) for one in kinds]

    def turning_rows(self, dim: int) -> list[JointRow]:
        """Rows of the rolling, one in the plane and two in space, and there of the drilling."""
        return turns_on_line(self.row(), self.law, dim)


@dataclass(frozen=True, slots=True, kw_only=True)
class AngleStop:
    """Stop at a limit of the angle of a joint; the angle counts beyond a turn.

    Parameters
    ----------
    joint
        Name of a joint that turns about an axis, such as a :class:`~softway.mechanisms.Hinge`.
    limit
        Angle from the start at which the stop acts [rad].
    side
        ``least`` or ``most``.
    restitution
        Coefficient of restitution, between 0 and 1: see ``restitution`` of :class:`~softway.mechanisms.Mechanism`.

    Examples
    --------
    >>> AngleStop(joint="hinge", limit=1.5).gap
    1.5
    """

    joint: str
    limit: Radian
    side: Literal["least", "most"] = "most"
    restitution: Pure = 0.0

    def __post_init__(self) -> None:
        _require_restitution(self.restitution)
        if self.side not in ("least", "most"):
            raise InputError("side", f"{self.side!r}", "'least' or 'most'")
        if not np.isfinite(self.limit):
            raise InputError("limit", f"{self.limit:g} is not finite", "an angle")

    @property
    def law(self) -> StopFriction:
        """No friction."""
        return StopFriction()

    @property
    def sign(self) -> float:
        """Sign of the angle in the gap."""
        return 1.0 if self.side == "least" else -1.0

    @property
    def gap(self) -> float:
        """Gap at the start [rad]."""
        return -self.sign * self.limit

    def row(self) -> JointRow:
        """Row of the stop, without the angle."""
        zero = np.zeros(3)
        return JointRow(kind=ANGLE, first=zero, second=zero, n=zero, m=zero, value=self.sign * self.limit)

    def tangential_rows(self, dim: int) -> list[JointRow]:
        """Rows of no sliding, as many as other stops have."""
        return [replace(self.row(), value=0.0) for _ in range(dim - 1)]

    def turning_rows(self, dim: int) -> list[JointRow]:
        """Rows of no turning, as many as other stops have."""
        return [replace(self.row(), value=0.0) for _ in range(2 * dim - 3)]


Stop = PlaneStop | DistanceStop | AngleStop
Impacts = Literal["simultaneous", "sequential"]
Restitution = Literal["Newton", "Poisson"]


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
        ``touch``, ``rest``, ``release``, or ``jam``: the sliding has no continuous course (Painleve), and its velocity
        jumps without a touch.  With a coefficient ``mu_s`` also ``slip`` and ``stick``: the sliding of a closed stop
        begins, and ends.
    velocity_before, velocity_after
        Velocity of the gap before and after an impact [m/s], negative while it closes; of an angle [rad/s].
    impulse
        Normal impulse of the impact [N s]; of an angle [N m s].
    located
        False for a touch beyond the number that is located in a time step: it acts at the end of the time step.
    """

    time: float
    stop: str
    kind: Literal["touch", "rest", "release", "jam", "slip", "stick"]
    velocity_before: float = 0.0
    velocity_after: float = 0.0
    impulse: float = 0.0
    located: bool = True


def _require_restitution(restitution: float) -> None:
    """Refuse coefficients that create energy."""
    if not 0.0 <= restitution <= 1.0:
        raise InputError("restitution", f"{restitution:g} is not between 0 and 1", "0 for no rebound, 1 for no loss")
