"""From contact forces of nodes to force per area of the surface around them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from softway.bodies.part import Part
from softway.contact.contact import Contact
from softway.contact.roughness import surfaces_of
from softway.contact.rubbing import POINT, Surface, around
from softway.typing import Array


@dataclass(frozen=True, slots=True, eq=False)
class Spread:
    """The declared ``surfaces`` of each contact.

    A node with no area of its own, such as a corner of a quadratic triangle, gets force over area of the facets around.
    """

    surfaces: tuple[tuple[Surface, ...], ...]

    def at(self, u: Array, force: Array) -> Array:
        """Force per present area (n, k) [Pa] of nodal forces (n, k) [N] at the displacement u (n, d) [m]."""
        area = np.zeros(len(u))
        for surfaces in self.surfaces:
            area = np.maximum(area, around(surfaces, u))
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


def spread(contacts: Sequence[Contact], parts: Sequence[Part]) -> Spread:
    """The surfaces of all contacts."""
    return Spread(tuple(surfaces_of(contact, parts) for contact in contacts))
