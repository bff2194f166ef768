"""Declaration of the explicit method."""

from dataclasses import dataclass

from softway.errors import InputError
from softway.solve.checks import check_accuracy
from softway.solve.device.library import check_device


@dataclass(frozen=True, slots=True, kw_only=True)
class Explicit:
    """Central differences: equations for the contact nodes only, slabs shorter than the time of a wave through a cell.

    The virtual time function is a peak at the start of the slab; ``x1 = x0 + h v`` with the velocity v in the middle of
    the slab.  Contact nodes have no inertia; they are in equilibrium at the end of the slab, as always with the
    Energy rule.  The energy oscillates with an amplitude proportional to the square of the slab length instead of being
    constant up to rounding.  Lumped masses make the method fast; consistent ones are factored.

    Parameters
    ----------
    safety
        Slab length for ``step = "auto"``, relative to the stability limit.
    tolerance
        Change of the contact nodes below which their equilibrium is accepted, relative to the greatest motion in the
        slab.
    limit
        Number of iterations of the equilibrium after which the slab is rejected.
    device
        Device that evaluates the forces, and keeps the state where it can, as for
        :class:`~softway.solve.Device`; None for the processor.

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
    device: str | None = None

    def __post_init__(self) -> None:
        if not 0.0 < self.safety <= 1.0:
            raise InputError("safety", f"{self.safety:g} of the stability limit", "a number above 0, at most 1")
        check_accuracy(self.tolerance, self.limit)
        if self.device is not None:
            check_device(self.device)
