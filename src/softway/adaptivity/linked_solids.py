"""Solids that ties link, on adapted meshes: one motion, whose balances are closed as one."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import scipy.sparse as sp

from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.arrays import Array
from softway.bodies.dof_map import DofMap
from softway.bodies.elements.section import Section


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Glue:
    """Ties that break: springs between the solids that they link.

    Parameters
    ----------
    rows
        (m, n) jumps of a component of the displacement.
    stiffness
        (m,) stiffnesses that the damage leaves [N/m].
    leaps
        (m, d) jumps to have [m].
    """

    rows: sp.csr_array
    stiffness: Array
    leaps: Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LinkedSolids:
    """Solids that share unknowns, or touch with nodes that have inertia; n nodes together in d dimensions.

    Parameters
    ----------
    solids
        The solids.
    dofs
        Velocities of their nodes from their unknowns.
    mass, follow
        As of :class:`~softway.adaptivity.adapted_solid.AdaptedSolid`, for all of them.
    glue
        Their ties that break.
    touching
        True for solids that touch: each of them has rigid motions of its own.
    """

    solids: tuple[AdaptedSolid, ...]
    dofs: DofMap
    mass: sp.csr_array
    follow: sp.csr_array
    glue: tuple[Glue, ...] = ()
    touching: bool = False

    @property
    def points(self) -> Array:
        """Reference places (n, d) of the nodes [m]."""
        return np.concatenate([solid.points for solid in self.solids])

    @property
    def section(self) -> Section:
        """Section of the solids."""
        return self.solids[0].section

    @property
    def crossing(self) -> float:
        """Time in which the slowest wave crosses the slowest of them [s]."""
        return max(solid.crossing for solid in self.solids)

    def kinetic(self, velocity: Array) -> float:
        """Kinetic energy [J] at a velocity (n, d) [m/s]."""
        return 0.5 * float((velocity * (self.mass @ velocity)).sum())

    def following(self, velocity: Array) -> Array:
        """Velocity (n, d) in which massless nodes move as the nodes behind them, but for their supports."""
        moved = self.fitting(np.asarray(self.follow @ velocity))
        return np.asarray(moved + self.dofs.supported(velocity - moved))

    def fitting(self, field: Array) -> Array:
        """The field (n, d) with the nodes that ties glue where those are that they follow."""
        follow = getattr(self.dofs, "follow", None)
        return field if follow is None else np.asarray(follow @ field.ravel()).reshape(field.shape)

    def split(self, field: Array) -> list[Array]:
        """Fields of the solids."""
        ends = np.cumsum([0, *(len(solid.points) for solid in self.solids)])
        return [field[a:b] for a, b in pairwise(ends)]

    def stretched(self, field: Array) -> Array:
        """Forces (n, d) of a small displacement (n, d) of the undeformed solids, without their ties [N]."""
        pairs = zip(self.solids, self.split(field), strict=True)
        return np.concatenate([solid.stretched(own) for solid, own in pairs])

    def stiffness(self) -> sp.csc_array:
        """Stiffness (n d, n d) of the undeformed solids and their ties [N/m]."""
        total = sp.csc_array(sp.block_diag([solid.stiffness() for solid in self.solids], format="csc"))
        for one in self.glue:
            springs = one.rows.T @ sp.diags_array(one.stiffness) @ one.rows
            total = sp.csc_array(total + sp.kron(springs, sp.eye_array(self.points.shape[1])))
        return total

    def pulled(self, field: Array) -> Array:
        """Forces (n, d) of the ties that break from the displacement (n, d) towards the jumps to have [N]."""
        total = np.zeros_like(field)
        for one in self.glue:
            total += one.rows.T @ (one.stiffness[:, None] * (one.leaps - one.rows @ field))
        return total

    def consistent_mass(self) -> sp.csr_array:
        """Consistent mass matrix (n, n) [kg]."""
        return sp.csr_array(sp.block_diag([solid.consistent_mass() for solid in self.solids], format="csr"))


AnyBody = AdaptedSolid | LinkedSolids
"""A solid by itself, or several that ties or contacts link."""


def solids_of(body: AnyBody) -> Sequence[AdaptedSolid]:
    """The solids of a body."""
    return body.solids if isinstance(body, LinkedSolids) else (body,)
