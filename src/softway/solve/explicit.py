"""The explicit method, as plain data."""

from dataclasses import dataclass

from softway.errors import InputError
from softway.solve.settings import check_accuracy


@dataclass(frozen=True, slots=True, kw_only=True)
class Explicit:
    """Central differences: no equations but those of the contact nodes, slabs shorter than a wave needs for a cell.

    The member of the family whose virtual time function is a peak at the slab's start, with ``x1 = x0 + h v`` and v the
    velocity in the middle of the slab.  Contact nodes have no inertia; they are in equilibrium at the slab's end, as
    under the Energy rule always.  The energy is kept up to an oscillation of the square of the slab's length instead of
    to rounding.  Lumped masses make it fast; consistent ones are factored.

    Parameters
    ----------
    safety
        Slab length of ``step = "auto"``, relative to the stability limit.
    tolerance
        Change of the contact nodes at which their equilibrium is accepted, relative to the longest motion in the slab.
    limit
        Iterations of the equilibrium after which the slab is rejected.

    References
    ----------
    Belytschko, Liu, Moran (2000), Nonlinear finite elements for continua and structures, 6.2; Khenous, Laborde, Renard
    (2008), Mass redistribution method for finite element contact problems in elastodynamics, Eur. J. Mech. A 27,
    918-932.

    Examples
    --------
    >>> Explicit().safety
    0.8
    """

    safety: float = 0.8
    tolerance: float = 1e-5
    limit: int = 40

    def __post_init__(self) -> None:
        if not 0.0 < self.safety <= 1.0:
            raise InputError("safety", f"{self.safety:g} of the stability limit", "a number above 0, at most 1")
        check_accuracy(self.tolerance, self.limit)
