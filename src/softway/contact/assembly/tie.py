"""Declaration of a tie: two surfaces that are glued, for good or until they break."""

from dataclasses import dataclass
from math import inf, isfinite

from softway.errors import InputError, real
from softway.laws.cohesive_law import BilinearCohesive
from softway.units import WattPerSquareMetreKelvin


@dataclass(frozen=True, slots=True, kw_only=True)
class Tie:
    """Tie of the surfaces of two solids, which are glued where they lie at rest.

    The nodes of the finer surface follow the other one in all components, with dual mortar weights: the meshes need not
    match.  There is neither a penalty nor an unknown for the force of the glue (docs/theory/contact/ties.md).

    A tie that ``breaks`` has a cohesive law instead: the glue opens by its stiffness and fails at its strength, and its
    fracture energy is dissipated (docs/theory/contact/cohesion.md).

    Parameters
    ----------
    between
        The two surfaces, ``("plate.top", "glass.bottom")``.  One of them has to lie on the other completely.
    tolerance
        Greatest gap or overlap of the surfaces at rest, in mean edges of the coarser surface; the nodes that follow are
        moved onto the other surface.
    breaks
        Cohesive law of the glue; none for a permanent tie.
    conductance
        Conductance of the glue between solids with heat [W/(m^2 K)]; by default heat passes a permanent tie nearly
        freely: the glue has a thousandth of the resistance of a cell.  A tie that breaks conducts by the share that
        still holds, and heats both solids by what it dissipates; without a conductance it does neither.

    Raises
    ------
    InputError
        If there are not two surfaces with a tag, or the tolerance or the conductance is negative.

    Examples
    --------
    >>> import softway as sw
    >>> Tie(between=("plate.top", "glass.bottom")).label
    'plate.top-glass.bottom'
    >>> glue = sw.BilinearCohesive(strength=1e6, energy=100.0, stiffness=1e13)
    >>> Tie(between=("plate.top", "glass.bottom"), breaks=glue).breaks.energy
    100.0
    """

    between: tuple[str, str]
    tolerance: float = 0.05
    breaks: BilinearCohesive | None = None
    conductance: WattPerSquareMetreKelvin | None = None

    def __post_init__(self) -> None:
        if self.conductance is not None:
            real(self.conductance, "conductance")
            if not 0.0 <= self.conductance < inf:
                raise InputError("conductance", f"{self.conductance:g}", "zero or a positive number")
        real(self.tolerance, "tolerance")
        if not (isfinite(self.tolerance) and self.tolerance >= 0.0):
            raise InputError("tolerance", f"{self.tolerance:g} is no fraction of an edge", "a fraction such as 0.05")
        remedy = 'two surfaces of solids, such as ["plate.top", "glass.bottom"]'
        if len(self.between) != 2:
            raise InputError("between", f"{len(self.between)} names", remedy)
        for name in self.between:
            if not all(name.partition(".")[::2]):
                raise InputError("between", f"{name!r} names no surface", remedy)
        if self.between[0] == self.between[1]:
            raise InputError("between", f"{self.between[0]!r} with itself", remedy)

    @property
    def label(self) -> str:
        """Name of the tie in messages."""
        return "-".join(self.between)

    @property
    def bodies(self) -> tuple[str, str]:
        """Names of the bodies."""
        one, two = (name.partition(".")[0] for name in self.between)
        return one, two

    @property
    def tags(self) -> tuple[str, str]:
        """Tags of the surfaces."""
        one, two = (name.partition(".")[2] for name in self.between)
        return one, two
