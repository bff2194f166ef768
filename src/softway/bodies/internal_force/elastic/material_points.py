"""Material points of an elastic body: energy, flux and moduli from displacement derivatives."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.kernels.linalg import tensors
from softway.laws.elasticity.free_faces import completed, condensed
from softway.laws.law import StoredEnergy

_ROUNDING = 16.0 * float(np.finfo(float).eps)  # relative rounding error of the energies of two states
_CHORD = 3  # Gauss points on a path of strains: the error is of seventh order in its length


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MaterialPoints:
    """Points p of an elastic material, with m reference directions in a space of D dimensions.

    Arguments ``H`` are displacement derivatives (p, m, D), see :mod:`softway.laws.strain_measures`.

    Parameters
    ----------
    law
        Stored energy per reference volume.
    free
        Axes outside the element whose normal stress is zero.
    directions
        (p, m, D) or (1, m, D) orthonormal reference directions.

    Examples
    --------
    >>> from softway.laws.bulk import LinearElastic
    >>> bar = MaterialPoints(law=LinearElastic(E=2.0), free=(1, 2), directions=np.ones((1, 1, 1)))
    >>> bar.energy(np.array([[[0.1]]])).round(12), bar.flux(np.array([[[0.1]]])).ravel().round(12)
    (array([0.01]), array([0.2]))
    """

    law: StoredEnergy
    free: tuple[int, ...]
    directions: Array

    def strain(self, H: Array) -> Array:
        """Strain (p, m, m) along the element; ``nan`` where the material is inverted."""
        E = self.law.measure.strain(H, self.directions)
        admissible = self.law.measure.admissible(H, self.directions)
        return E if admissible.all() else np.where(admissible[:, None, None], E, np.nan)

    def complete(self, E: Array) -> Array:
        """Complete strain (p, 3, 3), with the strains of the free faces."""
        return completed(self.law, E, self.free)

    def energy(self, H: Array) -> Array:
        """Energy per reference volume, (p,) [J/m^3]."""
        return _energy(self.law, self.complete(self.strain(H)))

    def stress(self, E: Array) -> Array:
        """Stress (p, m, m) along the element for the complete strain E (p, 3, 3) [Pa]."""
        m = self.directions.shape[-2]
        return self.law.stress(E)[:, :m, :m]

    def energy_and_flux(self, H: Array) -> tuple[Array, Array]:
        """Energy (p,) [J/m^3] and its derivative with respect to H, (p, m, D) [Pa]."""
        E = self.complete(self.strain(H))
        return _energy(self.law, E), self.stress(E) @ self.law.measure.carrier(H, self.directions)

    def flux(self, H: Array) -> Array:
        """First Piola-Kirchhoff stress along the directions, (p, m, D) [Pa]."""
        return self.stress(self.complete(self.strain(H))) @ self.law.measure.carrier(H, self.directions)

    def moduli(self, H: Array) -> Array:
        """Derivative of the flux, (p, m, D, m, D) [Pa]."""
        measure, (m, size) = self.law.measure, H.shape[1:]
        E = self.complete(self.strain(H))
        f = measure.carrier(H, self.directions)
        C = condensed(self.law.tangent(E), m, self.free).reshape(-1, m * m * m, m)
        right = (C @ f).reshape(-1, m, m, m * size)  # C_JMLN f_Nl
        material = np.swapaxes(f, -1, -2)[:, None] @ right  # f_Mi C_JMLN f_Nl
        return material.reshape(-1, m, size, m, size) + measure.geometric(self.stress(E), size)

    def discrete_flux(self, H0: Array, H1: Array) -> Array:
        """Flux (p, m, D) [Pa] whose work on ``H1 - H0`` is the difference of the energies.

        Discrete gradient of Gonzalez in the strain of the law, which keeps angular momentum as well as energy:
        ``Q = S* f((H0 + H1)/2)`` with ``S* = S_mean + (dW - S_mean : dE) dE/(dE : dE)``.  S_mean is the stress averaged
        along the straight path of strains.  For a small increment its work equals dW up to rounding; the quotient would
        only amplify rounding there, and is left out.
        """
        middle = self.law.measure.carrier(0.5 * (H0 + H1), self.directions)
        E0, E1 = self.strain(H0), self.strain(H1)
        step = E1 - E0
        mean = chord_average(lambda E: self.stress(self.complete(E)), E0, E1, _CHORD)
        W0, W1 = (_energy(self.law, self.complete(E)) for E in (E0, E1))
        with np.errstate(invalid="ignore", divide="ignore"):
            missing = W1 - W0 - tensors.double_dot(mean, step)
            square = tensors.double_dot(step, step)
            known = np.abs(missing) > _ROUNDING * (np.abs(W0) + np.abs(W1))
            factor = np.where(known & (square > 0.0), missing / square, 0.0)
        return (mean + factor[:, None, None] * step) @ middle

    def cauchy(self, H: Array) -> tuple[Array, Array]:
        """Complete Cauchy stress (p, 3, 3) [Pa], and the volume ratio (p,) that it refers to."""
        m, size = H.shape[1:]
        measure, E = self.law.measure, self.complete(self.strain(H))
        S, f = self.law.stress(E), measure.carrier(H, self.directions)
        J = measure.dilation(E)
        sigma = np.zeros((len(H), 3, 3))
        sigma[:, :size, :size] = np.swapaxes(f, -1, -2) @ S[:, :m, :m] @ f
        for axis in range(size, 3):
            if axis not in self.free:
                sigma[:, axis, axis] += S[:, axis, axis]
        return sigma / J[:, None, None], J

    def volume_ratio(self, H: Array) -> Array:
        """det F, (p,); zero or less where the material is inverted."""
        E = self.complete(self.law.measure.strain(H, self.directions))
        return self.law.measure.ratio(H, self.directions, E)


def chord_average(function: Callable[[Array], Array], start: Array, end: Array, points: int) -> Array:
    """Average of a function along the straight path between two arrays, by Gauss points.

    Examples
    --------
    >>> chord_average(lambda x: x**3, np.array([0.0]), np.array([2.0]), 2)
    array([2.])
    """
    chord = [
        0.5 * weight * function(start + 0.5 * (1.0 + place) * (end - start))
        for place, weight in zip(*np.polynomial.legendre.leggauss(points), strict=True)
    ]
    return np.sum(chord, axis=0)


def _energy(law: StoredEnergy, E: Array) -> Array:
    """Energy (p,) [J/m^3], infinite where the strain is not finite."""
    W = law.energy(E)
    return np.where(np.isfinite(W), W, np.inf)
