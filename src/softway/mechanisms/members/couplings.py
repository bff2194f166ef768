"""Gears: couplings of the motions that two joints leave."""

from dataclasses import dataclass

import numpy as np

from softway.errors import InputError


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
