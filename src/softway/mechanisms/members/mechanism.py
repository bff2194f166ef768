"""Mechanism: rigid bodies, joints and springs as plain data."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import combinations

from softway.errors import InputError
from softway.mechanisms.members.couplings import Gear, HeatLink
from softway.mechanisms.members.joints import GROUND, Joint, Rod, motor_row, travel_axis, turning_axis
from softway.mechanisms.members.motors import Motor
from softway.mechanisms.members.rigid import FAR, Rigid
from softway.mechanisms.members.springs import HingeTorque, PointForce, Spring, Torque, TorsionSpring
from softway.mechanisms.members.stops import AngleStop, Impacts, Restitution, Stop
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
    restitution
        What the coefficients of restitution of stops are ratios of: ``Newton``, of the velocities of the gap after and
        before an impact; ``Poisson``, of the impulses of expansion and compression.  Without friction a single impact
        is the same.  With friction Poisson's law creates no energy at a single impact that slides back.
    gears
        Couplings of the motions of joints by name.
    motors
        Prescribed motions of joints by name.
    springs
        Springs and dampers, between points or about the axes of joints.
    torques
        Constant torques, on a body or about the axes of joints.
    forces
        Constant forces at points of bodies.
    gravity
        Acceleration of gravity [m/s^2]; none by default.
    heat_links
        Heat between bodies with a temperature, beside solids with heat; at most one of each stop.

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
    restitution: Restitution = "Newton"
    gears: Mapping[str, Gear] = field(default_factory=dict)
    motors: Mapping[str, Motor] = field(default_factory=dict)
    springs: tuple[Spring | TorsionSpring, ...] = ()
    torques: tuple[Torque | HingeTorque, ...] = ()
    forces: tuple[PointForce, ...] = ()
    gravity: tuple[MetrePerSecondSquared, ...] | None = None
    heat_links: tuple[HeatLink, ...] = ()

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
        self._require_stops()
        self._require_names()
        for name, gear in self.gears.items():
            self._require_geared(f"gears.{name}.joints", gear)
        for name, motor in self.motors.items():
            moving = [one for one, joint in self.joints.items() if motor_row(joint) is not None]
            if motor.joint not in moving:
                problem = f"{motor.joint!r} is no joint with one motion, an angle or a travel"
                raise InputError(f"motors.{name}.joint", problem, f"one of {moving}")
        for k, spring in enumerate(self.springs):
            if isinstance(spring, TorsionSpring):
                self._require_turning(f"springs[{k}]", spring.joint)
            else:
                self._require(f"springs[{k}]", spring.between, spring.ends)
        for k, torque in enumerate(self.torques):
            if isinstance(torque, HingeTorque):
                self._require_turning(f"torques[{k}]", torque.joint)
            else:
                self._require(f"torques[{k}]", (torque.on, GROUND), ())
        for k, force in enumerate(self.forces):
            self._require(f"forces[{k}]", (force.on, GROUND), (force.at,))
        self._require_links()

    @property
    def dim(self) -> int:
        """2 in the plane, 3 in space."""
        return next(iter(self.bodies.values())).dim

    @property
    def turning(self) -> frozenset[str]:
        """Names of the joints whose angles other members need."""
        springs = [spring.joint for spring in self.springs if isinstance(spring, TorsionSpring)]
        torques = [torque.joint for torque in self.torques if isinstance(torque, HingeTorque)]
        geared = [
            name for gear in self.gears.values() for name in gear.joints if travel_axis(self.joints[name]) is None
        ]
        motors = [motor.joint for motor in self.motors.values() if turning_axis(self.joints[motor.joint]) is not None]
        stops = [stop.joint for stop in self.stops.values() if isinstance(stop, AngleStop)]
        return frozenset(springs + torques + geared + motors + stops)

    def linked_by_heat(self, link: HeatLink) -> tuple[str, str]:
        """Names of the two bodies between which heat passes."""
        if link.between is not None:
            return link.between
        assert link.stop is not None
        stop = self.stops[link.stop]
        return self.joints[stop.joint].between if isinstance(stop, AngleStop) else stop.between

    def _require_links(self) -> None:
        """Refuse heat links of the same stop, whose friction would heat once by each, and those of cold bodies."""
        stops: dict[str, int] = {}
        for k, link in enumerate(self.heat_links):
            self._require_warm(f"heat_links[{k}]", link)
            if link.stop is not None and (first := stops.setdefault(link.stop, k)) != k:
                problem = f"{link.stop!r}, as in heat_links[{first}]: what the stop dissipates would heat twice"
                raise InputError(f"heat_links[{k}].stop", problem, "one link of the stop, with the whole conductance")

    def _require_warm(self, where: str, link: HeatLink) -> None:
        """Refuse heat of a stop that is not there, and of bodies without a temperature."""
        key = "between" if link.stop is None else "stop"
        if link.stop is not None and link.stop not in self.stops:
            raise InputError(f"{where}.stop", f"no stop {link.stop!r}", f"one of {[*self.stops]}")
        for name in (both := self.linked_by_heat(link)):
            if name not in self.bodies or self.bodies[name].thermal is None:
                warm = [n for n, body in self.bodies.items() if body.thermal is not None]
                problem = f"heat with {name!r}, which is no body with a temperature"
                raise InputError(f"{where}.{key}", problem, f"bodies with thermal, of which there are {warm}")
        if both[0] == both[1]:
            raise InputError(f"{where}.{key}", f"{both[0]!r} twice", "two different bodies")

    def require_cold(self) -> None:
        """Refuse bodies with a temperature, in a march of rigid bodies alone.

        Raises
        ------
        InputError
            With the place of the first of them.
        """
        for name, body in self.bodies.items():
            if body.thermal is not None:
                problem = "heat of a rigid body without solids: it is solved for together with theirs"
                remedy = "omit it, or a solid with the key thermal beside the body"
                raise InputError(f"bodies.{name}.thermal", problem, remedy)

    def _require_stops(self) -> None:
        """Refuse stops of unknown bodies or joints, and unknown laws of impacts."""
        for name, stop in self.stops.items():
            if isinstance(stop, AngleStop):
                self._require_turning(f"stops.{name}", stop.joint)
            else:
                self._require(f"stops.{name}", stop.between, stop.places)
        if self.impacts not in ("simultaneous", "sequential"):
            raise InputError("impacts", f"{self.impacts!r}", "'simultaneous' or 'sequential'")
        if self.restitution not in ("Newton", "Poisson"):
            raise InputError("restitution", f"{self.restitution!r}", "'Newton' or 'Poisson'")

    def _require_names(self) -> None:
        """Refuse names that two members have."""
        members = [("joints", self.joints), ("stops", self.stops), ("gears", self.gears), ("motors", self.motors)]
        for (where, one), (which, other) in combinations(members, 2):
            if twice := one.keys() & other.keys():
                raise InputError(which, f"{sorted(twice)} are names of {where}, too", "other names")

    def _require_geared(self, where: str, gear: Gear) -> None:
        """Refuse joints that are not there or have neither an angle nor a travel, and two travels."""
        turning = [name for name, joint in self.joints.items() if turning_axis(joint) is not None]
        sliding = [name for name, joint in self.joints.items() if travel_axis(joint) is not None]
        for name in gear.joints:
            if name not in turning + sliding:
                problem = f"{name!r} is no joint with an angle or a travel"
                raise InputError(where, problem, f"two of {turning + sliding}")
        if set(gear.joints) <= set(sliding):
            raise InputError(where, f"{gear.joints} both slide", f"one joint with an angle, of {turning}")

    def _require_turning(self, where: str, joint: str) -> None:
        """Refuse a joint that is not there, or has no axis to turn about."""
        turning = [name for name, one in self.joints.items() if turning_axis(one) is not None]
        if joint not in turning:
            raise InputError(f"{where}.joint", f"{joint!r} is no joint that turns about an axis", f"one of {turning}")

    def _require(self, where: str, between: tuple[str, str], points: tuple[tuple[float, ...], ...]) -> None:
        """Refuse unknown or equal bodies, and points of another dimension."""
        for name in between:
            if name not in self.bodies and name != GROUND:
                raise InputError(f"{where}.between", f"no body {name!r}", f"one of {[*self.bodies, GROUND]}")
        if between[0] == between[1]:
            raise InputError(f"{where}.between", f"{between[0]!r} twice", "two different bodies")
        for point in points:
            if len(point) != self.dim or not max(map(abs, point)) < FAR:
                raise InputError(where, f"the place {point} in {self.dim}D", f"{self.dim} coordinates")
