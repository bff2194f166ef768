"""Viscous and plastic bodies that are pressed or pulled: forces and shapes in closed form."""

import numpy as np

from softway.typing import Array


def upsetting(reduction: Array | float, m: float, half: float = 0.75) -> Array:
    """Force on a cylinder of Norton-Hoff's material between smooth platens, ``pi R^2 sqrt(3) K (sqrt(3) V/H)^m``.

    Radius and consistency K are 1, H is the ``half`` of the height times what is left of it, V = 1 the speed of the
    platen, and the volume is kept.

    Examples
    --------
    >>> float(upsetting(0.5, 0.3).round(6))
    17.222623
    """
    height = half * (1.0 - np.asarray(reduction, float))
    return np.asarray(np.pi * half / height * np.sqrt(3.0) * (np.sqrt(3.0) / height) ** m)


def neck(thick: Array | float, m: float, first: float = 0.99) -> Array:
    """Area of the thinner of two bars in line when that of the thicker one has fallen from 1 to ``thick``.

    The force ``A (-A'/A)^m`` is the same in both: ``A1^(1/m) - A2^(1/m)`` stays.

    Examples
    --------
    >>> float(neck(0.5, 0.3).round(6))
    0.442984
    """
    rest = 1.0 - first ** (1.0 / m)
    return np.asarray((np.asarray(thick, float) ** (1.0 / m) - rest) ** m)


def siebel(friction: float, radius: float, height: float) -> float:
    """Mean pressure on a plastic cylinder over the yield stress, by the slab method for Coulomb's friction.

    Its first terms are Siebel's ``1 + 2 mu R/(3 H)``.

    Examples
    --------
    >>> round(siebel(0.05, 1.0, 1.0), 6)
    1.034184
    """
    x = 2.0 * friction * radius / height
    return float(2.0 / x**2 * (np.exp(x) - x - 1.0))
