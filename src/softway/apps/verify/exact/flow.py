"""Forces and shapes of pressed or stretched viscous and plastic bodies in closed form."""

import numpy as np

from softway.arrays import Array


def upsetting(reduction: Array | float, m: float, half: float = 0.75) -> Array:
    """Force on a Norton-Hoff cylinder between smooth platens, ``pi R^2 sqrt(3) K (sqrt(3) V/H)^m``.

    The initial radius and the consistency K are 1. H is the current half height, with the initial value ``half``;
    V = 1 is the speed of the platen. The volume is constant.

    Examples
    --------
    >>> float(upsetting(0.5, 0.3).round(6))
    17.222623
    """
    height = half * (1.0 - np.asarray(reduction, float))
    return np.asarray(np.pi * half / height * np.sqrt(3.0) * (np.sqrt(3.0) / height) ** m)


def neck(thick: Array | float, m: float, first: float = 0.99) -> Array:
    """Area of the thinner of two bars in series when the area of the thicker one has fallen from 1 to ``thick``.

    The force ``A (-A'/A)^m`` is the same in both, so ``A1^(1/m) - A2^(1/m)`` is constant.

    Examples
    --------
    >>> float(neck(0.5, 0.3).round(6))
    0.442984
    """
    rest = 1.0 - first ** (1.0 / m)
    return np.asarray((np.asarray(thick, float) ** (1.0 / m) - rest) ** m)


def siebel(friction: float, radius: float, height: float) -> float:
    """Mean pressure on a plastic cylinder relative to the yield stress, by the slab method with Coulomb friction.

    The first terms are Siebel's ``1 + 2 mu R/(3 H)``.

    Examples
    --------
    >>> round(siebel(0.05, 1.0, 1.0), 6)
    1.034184
    """
    x = 2.0 * friction * radius / height
    return float(2.0 / x**2 * (np.exp(x) - x - 1.0))
