"""Walls of a pile: planes that balls stay in front of, and boxes of them."""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from softway.errors import InputError
from softway.units import Metre, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class Wall:
    """Plane at rest that balls stay in front of.

    Parameters
    ----------
    point
        A point of the plane [m].
    normal
        Direction from the plane to the balls.
    friction, restitution
        Coefficients of the contact with balls; those of the pile by default.

    Raises
    ------
    InputError
        If the normal is no direction, or a coefficient is out of its range.

    Examples
    --------
    >>> Wall(point=(0.0, 0.0), normal=(0.0, 2.0)).friction is None
    True
    """

    point: tuple[Metre, ...]
    normal: tuple[float, ...]
    friction: Pure | None = None
    restitution: Pure | None = None

    def __post_init__(self) -> None:
        if len(self.point) not in (2, 3) or not np.isfinite(self.point).all():
            raise InputError("point", f"{self.point}", "two coordinates in the plane, three in space")
        size = float(np.linalg.norm(self.normal)) if len(self.normal) == len(self.point) else 0.0
        if not 0.0 < size < np.inf:
            raise InputError("normal", f"{self.normal} is no direction", f"{len(self.point)} components, not all zero")
        require_coefficients(self.friction, self.restitution)


Side = Metre | Literal["open"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Box:
    """Walls of a box along the axes, with balls inside.

    Parameters
    ----------
    lower, upper
        Lowest and greatest coordinates of the room [m]; "open" for a side without a wall.
    friction, restitution
        Coefficients of the contact with balls; those of the pile by default.

    Raises
    ------
    InputError
        If the sides do not fit, or a coefficient is out of its range.

    Examples
    --------
    >>> len(Box(lower=(0.0, 0.0, 0.0), upper=(1.0, 1.0, "open")).walls)
    5
    """

    lower: tuple[Side, ...]
    upper: tuple[Side, ...]
    friction: Pure | None = None
    restitution: Pure | None = None

    def __post_init__(self) -> None:
        require_coefficients(self.friction, self.restitution)
        if not self.walls:
            raise InputError("upper", "all sides are open", "a coordinate for one of them")

    @property
    def walls(self) -> tuple[Wall, ...]:
        """The walls."""
        lower, upper = (tuple(None if isinstance(s, str) else s for s in sides) for sides in (self.lower, self.upper))
        found = box(lower=lower, upper=upper)
        return tuple(replace(wall, friction=self.friction, restitution=self.restitution) for wall in found)


def box(*, lower: tuple[Metre | None, ...], upper: tuple[Metre | None, ...]) -> tuple[Wall, ...]:
    """Walls of a box along the axes; None for a side that is open.

    Examples
    --------
    >>> [wall.normal for wall in box(lower=(0.0, 0.0), upper=(1.0, None))]
    [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)]
    """
    if len(lower) not in (2, 3) or len(upper) != len(lower):
        raise InputError(
            "upper",
            f"{upper} for the lower sides {lower}",
            'as many sides, 2 or 3; None, or "open" in a scenario, for one without a wall',
        )
    for axis, (low, high) in enumerate(zip(lower, upper, strict=True)):
        if low is not None and high is not None and not low < high:
            raise InputError("upper", f"{high:g} m is not above {low:g} m along axis {axis}", "a greater coordinate")
    walls = []
    for sides, sign in ((lower, 1.0), (upper, -1.0)):
        for axis, side in enumerate(sides):
            if side is not None:
                along = np.eye(len(sides))[axis]
                point, normal = tuple((side * along).tolist()), tuple((sign * along + 0.0).tolist())
                walls.append(Wall(point=point, normal=normal))
    return tuple(walls)


def require_coefficients(friction: float | None, restitution: float | None) -> None:
    """Refuse coefficients of contact that are out of their ranges."""
    if friction is not None and not 0.0 <= friction < np.inf:
        raise InputError("friction", f"{friction:g} is negative, or not finite", "zero or more")
    if restitution is not None and not 0.0 <= restitution <= 1.0:
        raise InputError("restitution", f"{restitution:g} is not between 0 and 1", "0 for no rebound, 1 for no loss")
