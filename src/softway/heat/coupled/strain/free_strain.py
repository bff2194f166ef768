"""Free strain of the nodes of a solid: that of its temperature and of its liquid share, without stress."""

from dataclasses import dataclass

from softway.arrays import Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FreeStrain:
    """Strain along each axis that k nodes would have without stress.

    Parameters
    ----------
    reference, liquid
        (k,) temperatures [K] and liquid shares without stress.
    coefficient
        (k,) coefficients of linear thermal expansion [1/K].
    melting
        (k,) strains of the liquid relative to the solid.

    Examples
    --------
    >>> import numpy as np
    >>> solid = FreeStrain(reference=np.array([900.0]), liquid=np.array([0.0]), coefficient=np.array([2e-5]),
    ...                    melting=np.array([0.02]))
    >>> solid.of(np.array([1000.0]), np.array([1.0])).round(12).tolist()
    [0.022]
    """

    reference: Array
    liquid: Array
    coefficient: Array
    melting: Array

    def of(self, temperature: Array, share: Array | float) -> Array:
        """Free strain (k,) at temperatures (k,) [K] and liquid shares (k,)."""
        return self.coefficient * (temperature - self.reference) + self.melting * (share - self.liquid)
