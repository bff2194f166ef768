"""Simple shear of a material with an objective rate: stress as a function of the shear gamma, shear modulus 1.

Elastic: Dienes, Acta Mechanica 32 (1979), and Atluri, Comput. Methods Appl. Mech. Eng. 43 (1984).
"""

import numpy as np
from scipy.integrate import solve_ivp

from softway.arrays import Array


def elastic(rate: str, gamma: Array | float) -> Array:
    """Stresses s11, s12 and s22 (3, ...) of a hypoelastic material.

    The rate is ``jaumann``, ``truesdell``, ``green_naghdi`` or ``log``.

    Examples
    --------
    >>> elastic("truesdell", 2.0).tolist()
    [4.0, 2.0, 0.0]
    """
    g = np.asarray(gamma, float)
    match rate:
        case "truesdell":
            return np.array([g * g, g, 0.0 * g])
        case "green_naghdi":
            b = np.arctan(g / 2.0)
            c = np.log(np.cos(b))
            s12 = 2.0 * np.cos(2.0 * b) * (2.0 * b - 2.0 * np.tan(2.0 * b) * c - np.tan(b))
            s11 = 4.0 * (np.cos(2.0 * b) * c + b * np.sin(2.0 * b) - np.sin(b) ** 2)
        case "log":
            s12 = 4.0 * np.arcsinh(g / 2.0) / np.sqrt(4.0 + g * g)
            s11 = 0.5 * g * s12
        case _:
            s11, s12 = 1.0 - np.cos(g), np.sin(g)
    return np.array([s11, s12, -s11])


def plastic(k: float, gamma: Array | float) -> Array:
    """Stresses s11 and s12 (2, ...) with the Jaumann rate and perfect plasticity, for increasing gamma.

    ``s11 = k sin(phi)`` and ``s12 = k cos(phi)`` with ``phi' = 1 - sin(phi)/k`` from the yield point
    ``sin(gamma/2) = k/2`` on; the limit is ``sin(phi) = k``. The shear yield stress is k.

    Examples
    --------
    >>> plastic(0.1, 5.0).round(4).tolist()
    [0.01, 0.0995]
    """
    g = np.atleast_1d(np.asarray(gamma, float))
    start = 2.0 * np.arcsin(0.5 * k)
    first = np.arctan2(1.0 - np.cos(start), np.sin(start))
    flow = solve_ivp(
        lambda _, y: 1.0 - np.sin(y) / k,
        (start, max(float(g.max()), start)),
        [first],
        rtol=1e-10,
        atol=1e-12,
        dense_output=True,
    )
    phi = flow.sol(np.maximum(g, start))[0]
    found = np.where(g < start, elastic("jaumann", g)[:2], k * np.array([np.sin(phi), np.cos(phi)]))
    return found.reshape(2, *np.shape(gamma))
