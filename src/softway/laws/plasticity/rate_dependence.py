"""Rate dependence of plastic flow: flow stress as a function of the yield stress and the plastic strain rate."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.units import Pascal, PerSecond, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class RateIndependent:
    """No rate dependence: the flow stress is the yield stress.

    Examples
    --------
    >>> RateIndependent().stress(np.array([2.0]), np.array([5.0]))[0].tolist()
    [2.0]
    """

    def stress(self, still: Array, rate: Array) -> tuple[Array, Array, Array]:
        """Flow stress, and its derivatives by the yield stress ``still`` [Pa] and the plastic strain ``rate``."""
        return still, np.ones_like(still), np.zeros_like(still)


@dataclass(frozen=True, slots=True, kw_only=True)
class Perzyna:
    """Overstress model of Perzyna, ``s = s_y + drag (rate/reference)^(1/N)``.

    Parameters
    ----------
    drag
        Overstress at the reference rate [Pa], not negative.
    reference
        Reference rate of the plastic strain [1/s], positive.
    exponent
        Exponent N, at least 1.

    References
    ----------
    Perzyna (1966), Fundamental problems in viscoplasticity, Adv. Appl. Mech. 9, 243-377.

    Examples
    --------
    >>> Perzyna(drag=3.0, reference=1.0, exponent=1.0).stress(np.array([2.0]), np.array([1.0]))[0].tolist()
    [5.0]
    """

    drag: Pascal
    reference: PerSecond
    exponent: Pure = 1.0

    def __post_init__(self) -> None:
        if not self.drag >= 0.0:
            raise InputError("drag", f"{self.drag:g} Pa is negative", "zero or more")
        if not self.reference > 0.0:
            raise InputError("reference", f"{self.reference:g} 1/s is not positive", "a positive rate")
        if not self.exponent >= 1.0:
            raise InputError("exponent", f"{self.exponent:g} is below 1", "1 or more")

    def stress(self, still: Array, rate: Array) -> tuple[Array, Array, Array]:
        """Flow stress, and its derivatives by the yield stress ``still`` [Pa] and the plastic strain ``rate``."""
        power = 1.0 / self.exponent
        x = np.maximum(rate, 0.0) / self.reference
        slope = self.drag * power / self.reference * np.maximum(x, 1e-30) ** (power - 1.0)
        return still + self.drag * x**power, np.ones_like(still), slope


@dataclass(frozen=True, slots=True, kw_only=True)
class JohnsonCook:
    """Logarithmic rate dependence ``s = s_y (1 + C ln(rate/reference))``; none below the reference rate.

    Parameters
    ----------
    C
        Rate constant, not negative.
    reference
        Reference rate of the plastic strain [1/s], positive.

    References
    ----------
    Johnson, Cook (1983), Proc. 7th Int. Symp. Ballistics, 541-547.

    Examples
    --------
    >>> JohnsonCook(C=0.5).stress(np.array([2.0]), np.array([np.e]))[0].tolist()
    [3.0]
    """

    C: Pure
    reference: PerSecond = 1.0

    def __post_init__(self) -> None:
        if not self.C >= 0.0:
            raise InputError("C", f"{self.C:g} is negative", "zero or more, 0.01 to 0.03 for metals")
        if not self.reference > 0.0:
            raise InputError("reference", f"{self.reference:g} 1/s is not positive", "a positive rate")

    def stress(self, still: Array, rate: Array) -> tuple[Array, Array, Array]:
        """Flow stress, and its derivatives by the yield stress ``still`` [Pa] and the plastic strain ``rate``."""
        fast = rate > self.reference
        factor = 1.0 + self.C * np.log(np.where(fast, rate, self.reference) / self.reference)
        slope = np.where(fast, self.C / np.where(fast, rate, self.reference), 0.0)
        return still * factor, factor, still * slope


@dataclass(frozen=True, slots=True, kw_only=True)
class NortonFlow:
    """Power-law overstress ``s = s_y + sqrt(3)^(m+1) K rate^m``.

    With a yield stress of zero this is the elasto-viscoplastic law of Norton and Hoff.

    Parameters
    ----------
    K
        Consistency [Pa s^m], positive.
    m
        Rate sensitivity, above 0 and at most 1.

    Examples
    --------
    >>> NortonFlow(K=1.0, m=1.0).stress(np.array([0.0]), np.array([2.0]))[0].round(12).tolist()
    [6.0]
    """

    K: Pure
    m: Pure

    def __post_init__(self) -> None:
        if not self.K > 0.0:
            raise InputError("K", f"{self.K:g} is not positive", "a positive consistency")
        if not 0.0 < self.m <= 1.0:
            raise InputError("m", f"{self.m:g} is not in (0, 1]", "a rate sensitivity such as 0.2")

    def stress(self, still: Array, rate: Array) -> tuple[Array, Array, Array]:
        """Flow stress, and its derivatives by the yield stress ``still`` [Pa] and the plastic strain ``rate``."""
        scale = self.K * np.sqrt(3.0) ** (self.m + 1.0)
        x = np.maximum(rate, 0.0)
        return still + scale * x**self.m, np.ones_like(still), scale * self.m * np.maximum(x, 1e-30) ** (self.m - 1.0)


Flow = RateIndependent | Perzyna | JohnsonCook | NortonFlow
