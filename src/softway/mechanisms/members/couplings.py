"""Couplings: gears between the motions that two joints leave, and heat between two bodies."""

from dataclasses import dataclass

import numpy as np

from softway.errors import InputError
from softway.units import Pure, WattPerKelvin


@dataclass(frozen=True, slots=True, kw_only=True)
class Gear:
    """Gear without play: the motion of one joint is that of another times a ratio.

    The motion of a hinge, cylindrical joint or screw is its angle [rad], that of a slider its travel [m], both from the
    start and of the second body against the first.  Two hinges are a pair of wheels, a hinge and a slider a pinion and
    a rack.  Angles count beyond a turn.

    Parameters
    ----------
    joints
        Names of the two joints; at least one has an angle.
    ratio
        Motion of the second over that of the first, not zero; negative for wheels that turn against each other.  For a
        rack driven by a pinion it is the radius [m/rad], with its sign.

    Raises
    ------
    InputError
        If the ratio is zero or not finite, or a joint is named twice.

    Examples
    --------
    >>> Gear(joints=("motor shaft", "wheel shaft"), ratio=-0.25).ratio
    -0.25
    """

    joints: tuple[str, str]
    ratio: float

    def __post_init__(self) -> None:
        if not (np.isfinite(self.ratio) and self.ratio != 0.0):
            raise InputError("ratio", f"{self.ratio:g} couples nothing", "a finite number other than zero")
        if self.joints[0] == self.joints[1]:
            raise InputError("joints", f"{self.joints[0]!r} twice", "two different joints")


@dataclass(frozen=True, slots=True, kw_only=True)
class HeatLink:
    """Heat between two rigid bodies with a temperature: always, as through a joint, or through a closed stop.

    Parameters
    ----------
    between
        Names of two bodies that always exchange heat.
    stop
        Name of a stop, in place of ``between``: its bodies exchange heat while it is closed, and what it dissipates by
        friction and impacts heats them.
    conductance
        Heat per time and difference of the temperatures [W/K].
    share
        Share of the dissipated energy of the stop that heats its first body; by default by the effusivities of both.

    Raises
    ------
    InputError
        If there are not either bodies or a stop, the conductance is negative or useless, or the share is not one.

    Examples
    --------
    >>> HeatLink(stop="floor", conductance=20.0, share=0.5).between is None
    True
    """

    between: tuple[str, str] | None = None
    stop: str | None = None
    conductance: WattPerKelvin = 0.0
    share: Pure | None = None

    def __post_init__(self) -> None:
        if (self.between is None) == (self.stop is None):
            given = "neither bodies nor a stop" if self.stop is None else "bodies and a stop"
            raise InputError("between", given, "between = two bodies, or stop = the name of one")
        if not 0.0 <= self.conductance < np.inf:
            raise InputError("conductance", f"{self.conductance:g} W/K", "zero or a positive number")
        if self.between is not None and not self.conductance:
            raise InputError("conductance", "no heat passes", "a positive number")
        if self.share is not None and (self.between is not None or not 0.0 <= self.share <= 1.0):
            raise InputError("share", f"{self.share:g}", "from 0 to 1, of a stop; or omit it")
