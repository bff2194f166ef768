"""Springs, dampers, forces and torques between the bodies of a mechanism."""

from dataclasses import dataclass

import numpy as np

from softway.errors import InputError
from softway.units import (
    Metre,
    Newton,
    NewtonMetre,
    NewtonMetrePerRadian,
    NewtonMetreSecondPerRadian,
    NewtonPerMetre,
    NewtonSecondPerMetre,
    Radian,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Spring:
    """Spring, damper, or both, between two points.

    Parameters
    ----------
    between
        Names of the two bodies; one may be ``ground``.
    ends
        End on the first body and end on the second at the start [m].
    stiffness
        Force per change of length [N/m].
    rest
        Length without force [m]; by default the length at the start.
    damping
        Force per rate of the length [N s/m].
    """

    between: tuple[str, str]
    ends: tuple[tuple[Metre, ...], tuple[Metre, ...]]
    stiffness: NewtonPerMetre = 0.0
    rest: Metre | None = None
    damping: NewtonSecondPerMetre = 0.0

    def __post_init__(self) -> None:
        _require_positive(self)


@dataclass(frozen=True, slots=True, kw_only=True)
class TorsionSpring:
    """Spring, damper, or both, against the turning of a joint; the angle counts beyond a turn.

    Parameters
    ----------
    joint
        Name of a joint that turns about an axis, such as a :class:`~softway.mechanisms.Hinge`.
    stiffness
        Moment per angle [N m/rad].
    rest
        Angle without moment, from the start [rad].
    damping
        Moment per angular velocity [N m s/rad].

    Raises
    ------
    InputError
        If a value is negative or no number.

    Examples
    --------
    >>> TorsionSpring(joint="hinge", stiffness=2.0, rest=0.5).damping
    0.0
    """

    joint: str
    stiffness: NewtonMetrePerRadian = 0.0
    rest: Radian = 0.0
    damping: NewtonMetreSecondPerRadian = 0.0

    def __post_init__(self) -> None:
        _require_positive(self)
        _require_finite(self.rest, "rest", "an angle")


@dataclass(frozen=True, slots=True, kw_only=True)
class Torque:
    """Constant torque on a body.

    Parameters
    ----------
    on
        Name of the body.
    value
        Torque [N m]: one component in the plane, three in space.
    """

    on: str
    value: NewtonMetre | tuple[NewtonMetre, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class HingeTorque:
    """Motor of constant torque about the axis of a joint, on its second body and against the first.

    Parameters
    ----------
    joint
        Name of a joint that turns about an axis, such as a :class:`~softway.mechanisms.Hinge`.
    value
        Torque [N m], positive by the right-hand rule about the axis.

    Examples
    --------
    >>> HingeTorque(joint="axle", value=0.8).value
    0.8
    """

    joint: str
    value: NewtonMetre

    def __post_init__(self) -> None:
        _require_finite(self.value, "value", "a torque")


@dataclass(frozen=True, slots=True, kw_only=True)
class PointForce:
    """Force at a point of a body, constant in size and in direction in space (dead load).

    Parameters
    ----------
    on
        Name of the body.
    at
        The point at the start [m]; it moves with the body.
    value
        Force [N], as many components as the point.

    Raises
    ------
    InputError
        If the components do not fit, or are no numbers.

    Examples
    --------
    >>> PointForce(on="rod", at=(1.0, 0.0), value=(0.0, -20.0)).on
    'rod'
    """

    on: str
    at: tuple[Metre, ...]
    value: tuple[Newton, ...]

    def __post_init__(self) -> None:
        if len(self.value) != len(self.at) or not np.isfinite(self.value).all():
            raise InputError("value", f"{self.value} at {self.at}", f"{len(self.at)} finite components")


def _require_positive(it: Spring | TorsionSpring) -> None:
    """Refuse a negative stiffness or damping."""
    for name in ("stiffness", "damping"):
        if not (np.isfinite(getattr(it, name)) and getattr(it, name) >= 0.0):
            raise InputError(name, f"{getattr(it, name):g} is negative or no number", "zero or more")


def _require_finite(value: float, where: str, what: str) -> None:
    if not np.isfinite(value):
        raise InputError(where, f"{value:g} is not finite", what)
