"""Neumann's solution: water at 5 degrees Celsius freezes from a surface that is put to -10."""

import numpy as np
from scipy.special import erf, erfc

import softway as sw
from softway.arrays import Array

MELTING, HEAT, DENSITY = 273.15, 338e3, 1000.0
WATER = sw.heat.Conduction(conductivity=0.556, capacity=4226.0)
ROOT = 0.15145327101974576
"""Front over 2 sqrt(diffusivity of ice times time), from the catalogue of cases."""


def ice(half_range: float = 0.0) -> sw.heat.Conduction:
    """Ice that melts."""
    latent = sw.heat.Latent(heat=HEAT, melting=MELTING, half_range=half_range, liquid=WATER)
    return sw.heat.Conduction(conductivity=2.22, capacity=1762.0, latent=latent)


def front(time: float) -> float:
    """Depth of the front [m]."""
    return float(2.0 * ROOT * np.sqrt(2.22 / (DENSITY * 1762.0) * time))


def neumann(x: Array, time: float) -> Array:
    """Temperatures [K] at depths x [m]."""
    solid, liquid = 2.22 / (DENSITY * 1762.0), 0.556 / (DENSITY * 4226.0)
    frozen = -10.0 + 10.0 * erf(x / (2.0 * np.sqrt(solid * time))) / erf(ROOT)
    water = 5.0 - 5.0 * erfc(x / (2.0 * np.sqrt(liquid * time))) / erfc(ROOT * np.sqrt(solid / liquid))
    return np.asarray(MELTING + np.where(x < front(time), frozen, water))
