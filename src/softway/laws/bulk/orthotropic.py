"""Orthotropic elasticity: wood, laminates, rolled sheet."""

from dataclasses import dataclass
from math import sqrt

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.kernels.linalg import tensors
from softway.kernels.linalg.spectral import moduli_in_axes
from softway.laws.elasticity.elastic_constants import wave_modulus
from softway.laws.strain_measures import Measure, Small
from softway.units import Pascal, Pure

_NAMES = ("12", "13", "23")
_OF_PAIR = ((0, 1), (0, 2), (1, 2))


@dataclass(frozen=True, slots=True, kw_only=True)
class LinearOrthotropic:
    """Orthotropic law ``W = e:C:e/2`` with three planes of symmetry; the stress is linear in the strain.

    In the material axes ``e_11 = (S_11 - nu12 S_22 - nu13 S_33)/E1``, ..., ``2 e_12 = S_12/G12``, with
    ``nu_ij/E_i = nu_ji/E_j``.  Tension along axis i shortens axis j by nu_ij times the elongation.

    Parameters
    ----------
    E
        Young's moduli along the three material axes [Pa], positive.
    nu
        Poisson's ratios nu12, nu13, nu23.
    G
        Shear moduli G12, G13, G23 [Pa], positive.
    axes
        First and second material axis, perpendicular; the third completes a right-handed set.  The axes are directions
        in space, for the body after its placement; in a bar the first direction is along the bar.  Bars and plates in
        plane stress have no shear strain of their section: with axes tilted out of it they are too stiff.
    measure
        ``Small`` for small rotations, with a force that is linear in the displacement; ``Green`` for any rotation
        (orthotropic St. Venant-Kirchhoff).

    References
    ----------
    Lekhnitskii (1963), Theory of elasticity of an anisotropic elastic body, Holden-Day, chapter 1.

    Examples
    --------
    >>> law = LinearOrthotropic(E=(10.0, 2.0, 1.0), nu=(0.3, 0.4, 0.2), G=(1.0, 0.8, 0.5))
    >>> strain = np.diag([0.1, -0.03, -0.04])  # what a pull along the first axis makes
    >>> np.abs(law.stress(strain).diagonal()).round(9).tolist()
    [1.0, 0.0, 0.0]
    """

    E: tuple[Pascal, Pascal, Pascal]
    nu: tuple[Pure, Pure, Pure]
    G: tuple[Pascal, Pascal, Pascal]
    axes: tuple[tuple[Pure, Pure, Pure], tuple[Pure, Pure, Pure]] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    measure: Measure = Small()

    def __post_init__(self) -> None:
        _positive("E", self.E)
        _positive("G", self.G)
        for k, (i, j) in enumerate(_OF_PAIR):
            most = sqrt(self.E[i] / self.E[j])
            if not abs(self.nu[k]) < most:
                problem = f"nu{_NAMES[k]} = {self.nu[k]:g} is not below sqrt(E{i + 1}/E{j + 1}) = {most:.4g}"
                raise InputError(f"nu[{k}]", problem, f"nu{_NAMES[k]} of tension along axis {i + 1}")
        least = float(np.linalg.eigvalsh(self._scaled())[0])
        if least <= 0.0:
            problem = f"{list(self.nu)} give no positive energy (eigenvalue {least:.3g} of the scaled compliance)"
            raise InputError("nu", problem, "smaller Poisson's ratios")
        first, second = np.array(self.axes, float)
        sizes = np.linalg.norm(first), np.linalg.norm(second)
        if not (np.isfinite(sizes).all() and min(sizes) > 0.0 and abs(first @ second) < 1e-9 * sizes[0] * sizes[1]):
            raise InputError("axes", f"{self.axes} are not perpendicular", "two perpendicular directions in space")

    @property
    def linear(self) -> bool:
        """True if the force is linear in the displacement, with the small strain."""
        return isinstance(self.measure, Small)

    def energy(self, E: Array) -> Array:
        """Energy per reference volume (...,) [J/m^3] of the strain E (..., 3, 3)."""
        return 0.5 * tensors.double_dot(self.stress(E), E)

    def stress(self, E: Array) -> Array:
        """Stress C:E, (..., 3, 3) [Pa]."""
        return (E.reshape(*E.shape[:-2], 9) @ self.moduli().reshape(9, 9)).reshape(E.shape)

    def tangent(self, E: Array) -> Array:
        """Constant moduli, (..., 3, 3, 3, 3) [Pa]."""
        return np.broadcast_to(self.moduli(), (*E.shape, 3, 3))

    def moduli(self) -> Array:
        """Moduli C in the axes of space, (3, 3, 3, 3) [Pa]."""
        root = np.sqrt(self.E)
        normal = np.linalg.inv(self._scaled()) * np.outer(root, root)
        shear = np.zeros((3, 3))
        for k, (i, j) in enumerate(_OF_PAIR):
            shear[i, j] = shear[j, i] = 2.0 * self.G[k]
        first, second = (np.array(a) / np.linalg.norm(a) for a in self.axes)
        return moduli_in_axes(0.5 * (normal + normal.T), shear, np.stack([first, second, np.cross(first, second)], -1))

    def wave_speed(self, density: float) -> float:
        """Speed of the fastest wave in any direction in the undeformed volume [m/s]."""
        return sqrt(wave_modulus(self.moduli()) / density)

    def youngs(self) -> float:
        """Young's modulus along the first direction of space [Pa], by default the first material axis."""
        return float(1.0 / np.linalg.pinv(self.moduli().reshape(9, 9), hermitian=True)[0, 0])

    def _scaled(self) -> Array:
        """Compliance (3, 3) of the normal components, scaled by ``sqrt(E_i E_j)``."""
        scaled = np.eye(3)
        for k, (i, j) in enumerate(_OF_PAIR):
            scaled[i, j] = scaled[j, i] = -self.nu[k] * sqrt(self.E[j] / self.E[i])
        return scaled


def _positive(where: str, values: tuple[float, ...]) -> None:
    for k, value in enumerate(values):
        if not 0.0 < value < np.inf:
            raise InputError(f"{where}[{k}]", f"{value:g} Pa is not positive", "a positive modulus")
