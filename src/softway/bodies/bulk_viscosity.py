"""Bulk viscosity: a pressure against fast compression that spreads a shock over a few elements.

    q = density L (b1 c |e'| + b2^2 L e'^2)   in compression; the linear part alone, as a tension, in expansion

with ``e'`` the rate of ln J, c the speed of dilatational waves, and L the shortest edge of the element.  The pressure
is evaluated in the middle of the slab.  Its work is never negative, and is booked as dissipation.
"""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.bodies.internal_force.body_force import BodyForce
from softway.bodies.internal_force.materials import Materials
from softway.errors import InputError
from softway.meshes.mesh import Mesh
from softway.units import Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class BulkViscosity:
    """Linear and quadratic bulk viscosity.

    Parameters
    ----------
    linear
        b1, damps the oscillations behind a wave front.
    quadratic
        b2, spreads the wave front; acts in compression only.

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
class BulkViscosityForce:
    """Force of the bulk viscosity on one body.

    Parameters
    ----------
    viscosity
        Coefficients.
    density
        Mass per reference volume [kg/m^3]; (p,) in a body with several materials.
    speed
        Speed of dilatational waves [m/s]; (p,) likewise.
    size
        (p,) shortest edge of the element of each point [m].
    """

    viscosity: BulkViscosity
    density: float | Array
    speed: float | Array
    size: Array

    def force(self, internal: BodyForce, middle: Array, change: Array, span: float) -> Array:
        """Nodal force (n, d) of the bulk viscosity, with the sign of an internal force [N].

        Parameters
        ----------
        internal
            Internal force of the body.
        middle
            (n, d) displacement in the middle of the slab [m].
        change
            (n, d) change of the displacement in the slab [m].
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
        """Pressure (p,) [Pa] for the rate (p,) of ln J [1/s] at the volume ratio (p,)."""
        fast = self.size * np.abs(rate)
        squared = np.where(rate < 0.0, (self.viscosity.quadratic * fast) ** 2, 0.0)
        return np.asarray(-np.sign(rate) * self.density / ratio * (self.viscosity.linear * self.speed * fast + squared))


def bulk_viscosity_force(
    viscosity: BulkViscosity | None, mesh: Mesh, materials: Materials, internal: BodyForce
) -> BulkViscosityForce | None:
    """Build the :class:`BulkViscosityForce` of a body; None without bulk viscosity."""
    if viscosity is None:
        return None
    speeds, rows = materials.speeds(internal.section), internal.sampling.rows
    size = np.concatenate([np.repeat(edges, g.shape[1]) for edges, g in zip(mesh.cell_edges(), rows, strict=True)])
    if materials.owner is None:
        return BulkViscosityForce(viscosity=viscosity, density=materials.densities[0], speed=speeds[0], size=size)
    owner = np.repeat(materials.owner, np.concatenate([np.full(len(g), g.shape[1]) for g in rows]))
    density, speed = np.array(materials.densities)[owner], np.array(speeds)[owner]
    return BulkViscosityForce(viscosity=viscosity, density=density, speed=speed, size=size)
