"""Tractions of contact nodes: force divided by surface area."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.bodies.discretised import DiscreteSolid
from softway.contact.contact import Contact
from softway.contact.friction_rows import POINT, DeclaredSurface, nodal_areas, surfaces_of


@dataclass(frozen=True, slots=True, eq=False)
class TractionMap:
    """Declared ``surfaces`` of each contact, for nodal tractions.

    A node without own area, such as a corner of a quadratic triangle, gets total force over total area of its facets;
    so does a corner of an eight-node facet, whose own area is negative.
    """

    surfaces: tuple[tuple[DeclaredSurface, ...], ...]

    def at(self, u: Array, force: Array) -> Array:
        """Force per present area (n, k) [Pa] of nodal forces (n, k) [N] at the displacement u (n, d) [m]."""
        area = np.zeros(len(u))
        for surfaces in self.surfaces:
            other = nodal_areas(surfaces, u)
            area = np.where(np.abs(other) > np.abs(area), other, area)
        bare = area <= POINT * float(area.max(initial=0.0))
        own = force / np.where(bare, 1.0, area)[:, None]
        total = self._over_facets(np.column_stack([force, area]))
        size = total[:, -1:]
        return np.where(bare[:, None], total[:, :-1] / np.where(size > 0.0, size, np.inf), own)

    def _over_facets(self, nodal: Array) -> Array:
        """Sums (n, k) over the nodes of all facets at a node."""
        out = np.zeros_like(nodal)
        for surface in (s for surfaces in self.surfaces for s in surfaces):
            mine = out[surface.nodes]
            for nodes in surface.facets.values():
                for column in nodes.T:
                    np.add.at(mine, column, nodal[surface.nodes][nodes].sum(axis=1))
        return out


def traction_map(contacts: Sequence[Contact], parts: Sequence[DiscreteSolid]) -> TractionMap:
    """Traction map of all contacts."""
    return TractionMap(tuple(surfaces_of(contact, parts) for contact in contacts))
