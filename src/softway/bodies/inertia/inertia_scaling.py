"""Inertia of the bodies: full, none, or scaled by a factor."""

from dataclasses import dataclass

from softway.errors import InputError
from softway.units import Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class Full:
    """Full inertia.

    Examples
    --------
    >>> Full().factor
    1.0
    """

    @property
    def factor(self) -> float:
        """Factor of the masses."""
        return 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Off:
    """No inertia: every time step (slab) ends in equilibrium; time matters for loads, prescribed motions and viscosity.

    Gravity still acts.  Supports must prevent the rigid-body motions of every body.

    Examples
    --------
    >>> Off().factor
    0.0
    """

    @property
    def factor(self) -> float:
        """Factor of the masses."""
        return 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Scaled:
    """Inertia times a factor (mass scaling): allows longer time steps for slow processes with small kinetic energy.

    Waves are slower by the root of the factor, and the step ``auto`` is longer by it.  Gravity is not scaled.  The
    ledger contains the kinetic energy of the scaled masses.

    Parameters
    ----------
    factor
        Factor of the masses, positive.

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
