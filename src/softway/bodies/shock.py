"""Bulk viscosity: a pressure against fast compression, that spreads a shock over a few cells.

    q = density L (b1 c |e'| + b2^2 L e'^2)   where matter is compressed, the linear part also where it expands

with ``e'`` the rate of ln J, c the speed of dilatational waves, L the shortest edge of the cell.  It is taken in the
middle of the slab, so that its work, never negative, is a known dissipation.
"""

from dataclasses import dataclass

import numpy as np

from softway.bodies.internal import InternalForce
from softway.bodies.rate_force import RateForce
from softway.bodies.section import wave_speed
from softway.errors import InputError
from softway.space.mesh import Mesh
from softway.typing import Array
from softway.units import Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class BulkViscosity:
    """Linear and quadratic bulk viscosity.

    Parameters
    ----------
    linear
        b1, against ringing behind a front.
    quadratic
        b2, against the front itself; only in compression.

    References
    ----------
    von Neumann, Richtmyer (1950), A method for the numerical calculation of hydrodynamic shocks, J. Appl. Phys. 21,
    232-237; Landshoff (1955), Los Alamos report LA-1930.

    Examples
    --------
    >>> BulkViscosity()
    BulkViscosity(linear=0.06, quadratic=1.2)
    """

    linear: Pure = 0.06
    quadratic: Pure = 1.2

    def __post_init__(self) -> None:
        for name in ("linear", "quadratic"):
            if not getattr(self, name) >= 0.0:
                raise InputError(name, f"{getattr(self, name):g} is negative", "zero or more")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Shock:
    """The bulk viscosity of one body.

    Parameters
    ----------
    viscosity
        Its numbers.
    density
        Mass per reference volume [kg/m^3].
    speed
        Speed of dilatational waves [m/s].
    size
        (p,) shortest edge of the cell of each point [m].
    """

    viscosity: BulkViscosity
    density: float
    speed: float
    size: Array

    def force(self, internal: InternalForce | RateForce, middle: Array, change: Array, span: float) -> Array:
        """Force (n, d) [N] on the nodes, as an internal force.

        Parameters
        ----------
        middle
            (n, d) displacement in the middle of the slab [m].
        change
            (n, d) by which it changes in the slab [m].
        span
            Length of the slab [s].
        """
        sampling = internal.sampling
        f = internal.directions + sampling.plain_derivatives(middle)
        with np.errstate(all="ignore"):
            inner = f @ np.swapaxes(f, 1, 2)
            slope = np.linalg.solve(inner, f)  # d ln J / dH
            ratio = np.sqrt(np.linalg.det(inner))
            rate = np.einsum("pJi,pJi->p", slope, sampling.plain_derivatives(change)) / span
            return sampling.unweighted(-(self._pressure(rate, ratio) * ratio)[:, None, None] * slope)

    def _pressure(self, rate: Array, ratio: Array) -> Array:
        """Pressure (p,) [Pa] for the rate (p,) of ln J [1/s] at the volume ``ratio`` (p,)."""
        fast = self.size * np.abs(rate)
        squared = np.where(rate < 0.0, (self.viscosity.quadratic * fast) ** 2, 0.0)
        return -np.sign(rate) * self.density / ratio * (self.viscosity.linear * self.speed * fast + squared)


def shock_of(
    viscosity: BulkViscosity | None, mesh: Mesh, density: float, internal: InternalForce | RateForce
) -> Shock | None:
    """The :class:`Shock` of a body, None without bulk viscosity."""
    if viscosity is None:
        return None
    speed = wave_speed(internal.material, density, internal.section)
    pairs = zip(mesh.cell_edges(), internal.sampling.rows, strict=True)
    size = np.concatenate([np.repeat(edges, table.shape[1]) for edges, table in pairs])
    return Shock(viscosity=viscosity, density=density, speed=speed, size=size)
