"""Pile: balls, walls, gravity and the laws of their contact as plain data."""

from dataclasses import dataclass

import numpy as np

from softway.errors import InputError
from softway.piles.balls import Balls
from softway.piles.walls import Wall, require_coefficients
from softway.units import MetrePerSecondSquared, Pure


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Pile:
    """Balls that may touch each other and walls, under gravity.

    Parameters
    ----------
    balls
        The balls; every two of them may touch.
    walls
        Planes that all balls stay in front of; :func:`~softway.piles.box` makes them of a box.
    gravity
        Acceleration of gravity [m/s^2]; none by default.
    friction
        Coefficient of Coulomb's friction, at rest and in motion.
    restitution
        Coefficient of restitution (Newton), between 0 and 1.

    Raises
    ------
    InputError
        If dimensions do not fit, or a coefficient is out of its range.

    Examples
    --------
    >>> from softway.piles import box, lattice
    >>> balls = lattice(count=(2, 2, 2), radius=0.05, density=2500.0, lowest=(0.06, 0.06, 0.06), jitter=0.005)
    >>> walls = box(lower=(0.0, 0.0, 0.0), upper=(0.23, 0.23, None))
    >>> Pile(balls=balls, walls=walls, gravity=(0.0, 0.0, -9.81), friction=0.3).balls.count
    8
    """

    balls: Balls
    walls: tuple[Wall, ...] = ()
    gravity: tuple[MetrePerSecondSquared, ...] | None = None
    friction: Pure = 0.0
    restitution: Pure = 0.0

    def __post_init__(self) -> None:
        require_coefficients(self.friction, self.restitution)
        dim = self.balls.dim
        for k, wall in enumerate(self.walls):
            if len(wall.point) != dim:
                raise InputError(f"walls[{k}].point", f"{wall.point} in {dim}D", f"{dim} coordinates")
        if self.gravity is not None and (len(self.gravity) != dim or not np.isfinite(self.gravity).all()):
            raise InputError("gravity", f"{self.gravity} in {dim}D", f"{dim} finite components")
