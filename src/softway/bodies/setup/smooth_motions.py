"""Smooth motions of rigid tools along a line and about an axis."""

from dataclasses import dataclass

import numpy as np

from softway.bodies.setup.motion_laws import MotionLaw, Travel, Turn, value_and_rate
from softway.bodies.setup.pose import Pose, require_axis, turned_about, vector
from softway.errors import InputError
from softway.units import Metre, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class Sliding:
    """Smooth translation along a straight line.

    Parameters
    ----------
    direction
        Direction of the line, of any length; one number in one dimension.
    travel
        Displacement along it since t = 0 [m] as a function of time.

    Examples
    --------
    >>> from softway.bodies.setup.motion_laws import SmoothSteps
    >>> press = Sliding(direction=(0.0, -3.0), travel=SmoothSteps(times=(0.0, 1.0), points=(0.0, 1.0)))
    >>> [press.at(t).shift.tolist() for t in (0.5, 2.0)]
    [[0.0, -0.5], [0.0, -1.0]]
    """

    direction: tuple[Pure, ...]
    travel: Travel

    def __post_init__(self) -> None:
        if not np.linalg.norm(vector("direction", self.direction)) > 0.0:
            raise InputError("direction", f"{list(self.direction)} is not a direction", "numbers that are not all zero")

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return len(self.direction)

    def at(self, time: float) -> Pose:
        """Pose at a time [s]."""
        along = np.asarray(self.direction, float)
        return Pose(rotation=np.array(1.0), shift=_since_start(self.travel, time) * (along / np.linalg.norm(along)))


@dataclass(frozen=True, slots=True, kw_only=True)
class Swinging:
    """Smooth rotation about a fixed axis.

    Parameters
    ----------
    point
        Point on the axis [m].
    angle
        Angle since t = 0 [rad] as a function of time.
    axis
        Direction of the axis, right-hand rule; empty in 2D, where a positive angle turns x to y.

    Examples
    --------
    >>> from softway.bodies.setup.motion_laws import Spline
    >>> door = Swinging(point=(1.0, 0.0), angle=Spline(times=(0.0, 2.0), points=(0.0, np.pi)))
    >>> door.at(1.0).place(np.array([2.0, 0.0])).round(12).tolist()
    [1.0, 1.0]
    """

    point: tuple[Metre, ...]
    angle: Turn
    axis: tuple[Pure, ...] = ()

    def __post_init__(self) -> None:
        require_axis(self.point, self.axis)

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return len(self.point)

    def at(self, time: float) -> Pose:
        """Pose at a time [s]."""
        return turned_about(self.point, self.axis, _since_start(self.angle, time))


def _since_start(law: MotionLaw, time: float) -> float:
    """Change of the value of a law since t = 0."""
    return value_and_rate(law.pieces, time)[0] - value_and_rate(law.pieces, 0.0)[0]
