"""Virtual time functions g of eq. (2.5): choice of the virtual velocity in time.

With the velocity linear in a slab, ``v = v0 (1 - tau) + v1 tau``, and ``int g = 1``, an oscillator of frequency omega
depends on g only through two moments, ``mu1 = int g tau`` and ``mu2 = int g tau^2``.  With ``x1 = x0 + h (v0 + v1)/2``
the scheme is stable iff

    mu1 >= 1/2   and   (omega h)^2 (mu1 - mu2) <= 2.

Therefore for g >= 0 only peaks at the two ends are stable for every step (docs/theory/time/time.md).
"""

from dataclasses import dataclass
from math import inf, sqrt

import numpy as np

from softway.arrays import Array
from softway.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class Momentum:
    """g constant: the momentum theorem, exact for forces linear in position; stable for omega h <= 2 sqrt(3).

    Parameters
    ----------
    points
        Gauss points in time, at least 2; two integrate the quadratic path of a linear force exactly.

    Examples
    --------
    >>> round(limit(Momentum()), 6)
    3.464102
    """

    points: int = 2

    def __post_init__(self) -> None:
        if self.points < 2:
            raise InputError("points", f"{self.points} time points cannot integrate a quadratic path", "2 or more")


@dataclass(frozen=True, slots=True, kw_only=True)
class Collocation:
    """Dirac peaks: the equation of motion at chosen instants.

    Parameters
    ----------
    at
        Instants tau in [0, 1].
    weights
        Their weights; they sum to 1.

    Examples
    --------
    >>> round(limit(Collocation(at=(0.5,), weights=(1.0,))), 6)
    2.828427
    """

    at: tuple[float, ...] = (0.5,)
    weights: tuple[float, ...] = (1.0,)

    def __post_init__(self) -> None:
        if len(self.at) != len(self.weights) or not self.at:
            raise InputError("weights", f"{len(self.weights)} weights for {len(self.at)} peaks", "one weight per peak")
        if any(not 0.0 <= t <= 1.0 for t in self.at):
            raise InputError("at", f"{list(self.at)} is outside the slab", "instants between 0 and 1")
        if abs(sum(self.weights) - 1.0) > 1e-12:
            raise InputError("weights", f"they sum to {sum(self.weights):g}", "weights that sum to 1")


@dataclass(frozen=True, slots=True, kw_only=True)
class EndPeaks:
    """Peaks of weight 1 - theta and theta at the two ends of the slab; stable for every step.

    Parameters
    ----------
    theta
        Weight of the later end, in [1/2, 1]; 1/2 dissipates nothing and is of second order.

    Examples
    --------
    >>> limit(EndPeaks())
    inf
    """

    theta: float = 0.5

    def __post_init__(self) -> None:
        if not 0.5 <= self.theta <= 1.0:
            raise InputError("theta", f"{self.theta:g} is unstable or outside the slab", "a value in [0.5, 1]")


TimeWeight = Momentum | Collocation | EndPeaks


def peaks(weight: TimeWeight) -> tuple[Array, Array]:
    """Instants tau (p,) and weights (p,) by which the force is sampled in the slab."""
    match weight:
        case Momentum(points=p):
            x, w = np.polynomial.legendre.leggauss(p)
            return 0.5 * (x + 1.0), 0.5 * w
        case Collocation(at=at, weights=weights):
            return np.array(at, float), np.array(weights, float)
        case EndPeaks(theta=theta):
            return np.array([0.0, 1.0]), np.array([1.0 - theta, theta])


def moments(weight: TimeWeight) -> tuple[float, float]:
    """Moments mu1, mu2 of g."""
    if isinstance(weight, EndPeaks):
        return weight.theta, weight.theta
    tau, w = peaks(weight)
    return float(w @ tau), float(w @ tau**2)


def limit(weight: TimeWeight) -> float:
    """Greatest stable omega h; infinite if every step is stable, zero if none is."""
    mu1, mu2 = moments(weight)
    if mu1 < 0.5 - 1e-12:
        return 0.0
    return inf if mu1 - mu2 <= 1e-14 else sqrt(2.0 / (mu1 - mu2))


def amplification(weight: TimeWeight, z: float) -> Array:
    """Amplification matrix (2, 2) of (x, h v) for the oscillator x'' + w^2 x = 0 with z = w h."""
    mu1, mu2 = moments(weight)
    d = 1.0 + 0.5 * z**2 * mu2
    a = np.array([-(z**2) / d, 1.0 - z**2 * mu1 / d])
    return np.array([[1.0 + 0.5 * a[0], 0.5 + 0.5 * a[1]], a])
