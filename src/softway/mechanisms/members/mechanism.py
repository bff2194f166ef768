"""Mechanism: rigid bodies, joints and springs as plain data."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from softway.errors import InputError
from softway.mechanisms.members.joints import GROUND, Joint, Rod
from softway.mechanisms.members.rigid import Rigid
from softway.mechanisms.members.springs import Spring, Torque
from softway.mechanisms.members.stops import Impacts, Stop
from softway.units import MetrePerSecondSquared


@dataclass(frozen=True, slots=True, kw_only=True)
class Mechanism:
    """Rigid bodies with joints, springs and torques under gravity.

    Parameters
    ----------
    bodies
        Rigid bodies by name, all in the plane or all in space.
    joints
        Joints by name; ``ground`` is the body that does not move.
    stops
        Unilateral joints by name.
    impacts
        Law of impacts at several stops at once: ``simultaneous``, or ``sequential``, one after the other, each time
        that with the greatest velocity of approach.
    springs
        Springs and dampers.
    torques
        Constant torques.
    gravity
        Acceleration of gravity [m/s^2]; none by default.

    Raises
    ------
    InputError
        For unknown names and dimensions that do not fit.

    Examples
    --------
    >>> mass = Rigid(mass=1.0, centre=(1.0, 0.0))
    >>> rod = Rod(between=("ground", "mass"), ends=((0.0, 0.0), (1.0, 0.0)))
    >>> Mechanism(bodies={"mass": mass}, joints={"rod": rod}, gravity=(0.0, -9.81)).dim
    2
    """

    bodies: Mapping[str, Rigid]
    joints: Mapping[str, Joint] = field(default_factory=dict)
    stops: Mapping[str, Stop] = field(default_factory=dict)
    impacts: Impacts = "simultaneous"
    springs: tuple[Spring, ...] = ()
    torques: tuple[Torque, ...] = ()
    gravity: tuple[MetrePerSecondSquared, ...] | None = None

    def __post_init__(self) -> None:
        if not self.bodies:
            raise InputError("bodies", "is empty", "at least one Rigid")
        if GROUND in self.bodies:
            raise InputError("bodies", f"{GROUND!r} is the name of the body that does not move", "another name")
        dims = {body.dim for body in self.bodies.values()}
        if len(dims) > 1:
            raise InputError("bodies", "some in the plane, some in space", "centres of two or of three coordinates")
        if self.gravity is not None and len(self.gravity) != self.dim:
            raise InputError("gravity", f"{self.gravity} in {self.dim}D", f"{self.dim} components")
        for name, joint in self.joints.items():
            points = joint.ends if isinstance(joint, Rod) else (joint.at,)
            self._require(f"joints.{name}", joint.between, points)
        for name, stop in self.stops.items():
            self._require(f"stops.{name}", stop.between, stop.places)
        if self.impacts not in ("simultaneous", "sequential"):
            raise InputError("impacts", f"{self.impacts!r}", "'simultaneous' or 'sequential'")
        if twice := self.joints.keys() & self.stops.keys():
            raise InputError("stops", f"{sorted(twice)} are names of joints, too", "other names")
        for k, spring in enumerate(self.springs):
            self._require(f"springs[{k}]", spring.between, spring.ends)
        for k, torque in enumerate(self.torques):
            self._require(f"torques[{k}]", (torque.on, GROUND), ())

    @property
    def dim(self) -> int:
        """2 in the plane, 3 in space."""
        return next(iter(self.bodies.values())).dim

    def _require(self, where: str, between: tuple[str, str], points: tuple[tuple[float, ...], ...]) -> None:
        """Refuse unknown or equal bodies, and points of another dimension."""
        for name in between:
            if name not in self.bodies and name != GROUND:
                raise InputError(f"{where}.between", f"no body {name!r}", f"one of {[*self.bodies, GROUND]}")
        if between[0] == between[1]:
            raise InputError(f"{where}.between", f"{between[0]!r} twice", "two different bodies")
        for point in points:
            if len(point) != self.dim:
                raise InputError(where, f"the place {point} in {self.dim}D", f"{self.dim} coordinates")
