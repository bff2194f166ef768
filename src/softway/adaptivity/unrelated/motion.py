"""Motion of a solid on a mesh that replaces another one, with its momentum, spin and kinetic energy."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.adaptivity.balances import balanced, rest_energy, rigid_motions_of
from softway.adaptivity.unrelated.fields import projected
from softway.arrays import Array
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.dof_map import DofMap
from softway.bodies.elements.section import Section

MOST = 0.8
"""Greatest ``|s^2 - 1|`` of the scalar s between unrelated meshes: masses of contact nodes are on other nodes there, so
that momenta of the same velocity differ by up to some percent, and with them the energy of the rigid motion.
"""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeavySolid:
    """Solid with its inertia in a march: mass (n, n) [kg], and velocities (n, n) of all nodes from those with mass."""

    part: DiscreteSolid
    mass: sp.csr_array
    follow: sp.csr_array

    @property
    def points(self) -> Array:
        """Reference places (n, d) of the nodes [m]."""
        return self.part.mesh.points

    @property
    def dofs(self) -> DofMap:
        """Velocities of the nodes from the unknowns."""
        return self.part.dofs

    @property
    def section(self) -> Section:
        """Section of the solid."""
        return self.part.internal.section

    def kinetic(self, velocity: Array) -> float:
        """Kinetic energy [J] at a velocity (n, d) [m/s]."""
        return 0.5 * float((velocity * (self.mass @ velocity)).sum())

    def following(self, velocity: Array) -> Array:
        """Velocity (n, d) in which massless nodes move as the nodes behind them, but for their supports."""
        moved = np.asarray(self.follow @ velocity)
        return np.asarray(moved + self.part.dofs.supported(velocity - moved))


def moved_on(before: HeavySolid, after: HeavySolid, displacement: Array, field: Array) -> Array:
    """Velocity or acceleration (m, d) on the new mesh: the projection of that (n, d) on the old one."""
    if not field.any():
        return np.zeros(after.points.shape)
    given = before.following(field) if before.mass.nnz > 0 else field
    return projected(before.part, before.points + displacement, after.part, given)


def balanced_on(
    before: HeavySolid, after: HeavySolid, displacement: Array, velocities: tuple[Array, Array], kinetic: float
) -> Array:
    """Velocity (m, d) on the new mesh with the momentum and spin before, and where a scalar allows it a kinetic energy.

    Parameters
    ----------
    before, after
        The solid on both meshes.
    displacement
        (n, d) displacement on the old mesh [m].
    velocities
        (n, d) velocity on the old mesh, and (m, d) its projection [m/s].
    kinetic
        Kinetic energy to have [J].
    """
    old, found = velocities
    if before.mass.nnz == 0 or not old.any():
        return found
    rigid = rigid_motions_of(before, after, (before.points + displacement, after.points))
    momenta = rigid.before.T @ (before.mass @ old).ravel()
    rest = rest_energy(before, rigid.before, old)
    return after.following(balanced(after, rigid.after, after.following(found), momenta, kinetic, MOST, before=rest)[0])
