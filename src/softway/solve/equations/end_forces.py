"""Displacements, forces and contact rows at the two ends of a slab."""

from dataclasses import dataclass

from softway.arrays import Array
from softway.contact.contact_rows import ContactRows


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class EndForces:
    """Data of a slab for its balances.

    ``u0``, ``u1``, ``f0``, ``f1`` (n, d) displacement and internal force at both ends, ``V0``, ``V1`` (parts,) stored
    energy, ``mean`` (n, d) the mean force to complete, ``v0`` (n, d) velocity at the start; ``rows0``, ``rows1`` and
    ``force0``, ``force1`` (m,) contact rows and normal forces at both ends, ``shear0``, ``shear1`` (m, d) tangential
    forces where there is friction; ``viscous`` (n, d) the part of the mean force that belongs to the mean rate;
    ``cancelled`` (parts,) the magnitude of energies that cancel in the stored energy.
    """

    u0: Array
    u1: Array
    f0: Array
    f1: Array
    V0: Array
    V1: Array
    mean: Array
    v0: Array
    rows0: ContactRows
    rows1: ContactRows
    force0: Array
    force1: Array
    shear0: Array
    shear1: Array
    viscous: Array | None = None
    cancelled: Array | float = 0.0

    @property
    def both(self) -> tuple[tuple[Array, ContactRows, Array], tuple[Array, ContactRows, Array]]:
        """Internal force (n, d), contact rows and normal forces (m,) at the two ends."""
        return (self.f0, self.rows0, self.force0), (self.f1, self.rows1, self.force1)

    @property
    def tangential(self) -> tuple[tuple[ContactRows, Array], tuple[ContactRows, Array]]:
        """Contact rows and tangential forces (m, d) at the two ends."""
        return (self.rows0, self.shear0), (self.rows1, self.shear1)

    @property
    def rubs(self) -> bool:
        """True if there is friction at one of the ends."""
        return bool(self.rows1.shear.count) and bool(self.shear0.any() or self.shear1.any())
