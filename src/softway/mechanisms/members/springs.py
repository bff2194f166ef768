"""Springs, dampers and torques between the bodies of a mechanism."""

from dataclasses import dataclass

import numpy as np

from softway.errors import InputError
from softway.units import Metre, NewtonMetre, NewtonPerMetre, NewtonSecondPerMetre


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
        for name in ("stiffness", "damping"):
            if not (np.isfinite(getattr(self, name)) and getattr(self, name) >= 0.0):
                raise InputError(name, f"{getattr(self, name):g} is negative or no number", "zero or more")


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
