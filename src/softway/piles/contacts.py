"""Contacts of a pile for scenario files: walls, friction and restitution."""

from dataclasses import dataclass

from softway.errors import InputError
from softway.piles.march import SWEEPS
from softway.piles.walls import Box, Wall, require_coefficients
from softway.units import Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class PileContacts:
    """Walls of a pile, and the laws of the contacts of its balls.

    Parameters
    ----------
    walls
        Planes and boxes that all balls stay inside of.
    friction
        Coefficient of Coulomb's friction, at rest and in motion.
    restitution
        Coefficient of restitution (Newton), between 0 and 1.
    sweeps
        Greatest number of sweeps for the friction, for places and for velocities each.

    Raises
    ------
    InputError
        If a coefficient is out of its range.

    Examples
    --------
    >>> PileContacts(walls=(Box(lower=(0.0, 0.0), upper=(1.0, "open")),), friction=0.3).planes[0].normal
    (1.0, 0.0)
    """

    walls: tuple[Wall | Box, ...] = ()
    friction: Pure = 0.0
    restitution: Pure = 0.0
    sweeps: int = SWEEPS

    def __post_init__(self) -> None:
        require_coefficients(self.friction, self.restitution)
        if self.sweeps < 1:
            raise InputError("sweeps", f"{self.sweeps}", "1 or more")

    @property
    def planes(self) -> tuple[Wall, ...]:
        """All walls, those of the boxes one by one."""
        return tuple(wall for part in self.walls for wall in (part.walls if isinstance(part, Box) else (part,)))
