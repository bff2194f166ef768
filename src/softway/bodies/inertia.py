"""What the inertia of the bodies counts: all of it, none, or a multiple."""

from dataclasses import dataclass

from softway.errors import InputError
from softway.units import Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class Full:
    """The inertia of matter.

    Examples
    --------
    >>> Full().factor
    1.0
    """

    @property
    def factor(self) -> float:
        """What masses are multiplied with."""
        return 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Off:
    """No inertia: every slab ends in equilibrium, and time is no more than the clock of driving and of viscosity.

    Weight still acts.  Supports must hold every body against rigid motions.

    Examples
    --------
    >>> Off().factor
    0.0
    """

    @property
    def factor(self) -> float:
        """What masses are multiplied with."""
        return 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Scaled:
    """Inertia times a factor: longer slabs for slow processes, as long as the kinetic energy stays small.

    Weight is not scaled.  The ledger holds the kinetic energy of the scaled masses.

    Parameters
    ----------
    factor
        What masses are multiplied with, positive.

    Examples
    --------
    >>> Scaled(factor=100.0).factor
    100.0
    """

    factor: Pure

    def __post_init__(self) -> None:
        if not self.factor > 0.0:
            raise InputError("factor", f"{self.factor:g} is not positive", 'a positive number, or inertia = "Off"')


Inertia = Full | Off | Scaled
