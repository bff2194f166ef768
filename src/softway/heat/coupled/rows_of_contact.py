"""Rows of a contact across which heat passes, and their conductances in a slab (time step)."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.friction_rows import DeclaredSurface
from softway.heat.coupled.contact_sides import ContactSides
from softway.heat.coupled.facing_areas import facing_areas
from softway.laws.heat.contact_heat import ContactHeat
from softway.model.field import FieldContact

STILL = 1e-9
"""Distance of surfaces that touch without a force, relative to the shortest edge: rows that others relieve."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RowsOfContact:
    """Rows of a contact across which heat passes.

    Parameters
    ----------
    heat
        Law of its heat.
    rows, node
        (r,) numbers of its rows, and their slave nodes.
    surfaces
        Declared surfaces of its solids.
    share
        Share of the area of its node that a row stands for: one half where the nodes of both surfaces have rows.
    order
        (parts,) place of each solid in the names of the contact.
    tool
        True if the opponent is a tool or a rigid body.
    still
        Distance of surfaces that touch without a force [m].
    lump
        Number of the opponent among the rigid bodies with a temperature; None for all others.
    """

    heat: ContactHeat
    rows: IntArray
    node: IntArray
    surfaces: tuple[DeclaredSurface, ...]
    share: float
    order: IntArray
    tool: bool
    still: float
    lump: int | None = None

    def areas(self, u: Array, normal: Array) -> Array:
        """Areas (r,) of the rows at the displacement ``u`` (n, d) [m], whose opponents have the unit normals (m, d)."""
        return self.share * facing_areas(self.surfaces, u, self.node).towards(normal[self.rows])

    def opposite(self, of: ContactSides, rigid: Array) -> Array:
        """Temperature (r,) of the tool, or of the rigid body, of which ``rigid`` are all; not a number for rows between
        solids, and for tools without a temperature [K].
        """
        given = np.nan if self.heat.tool_temperature is None else self.heat.tool_temperature
        return np.where(of.opponent < 0, given if self.lump is None else rigid[self.lump], np.nan)

    def conductances(
        self,
        contact: FieldContact,
        gaps: tuple[Array, Array],
        of: ContactSides,
        temperature: Array,
        tool: Array,
        area: Array,
    ) -> Array:
        """Conductances (r,) [W/K] in a slab.

        Rows of one node share its area: those that touch by the part of the slab in which they do, and what passes the
        open gap goes to the nearest one.

        Parameters
        ----------
        contact, gaps
            Contact of the slab, and the gaps (m,) at both ends [m].
        of
            Sides of the rows.
        temperature
            (n,) temperatures for the radiation [K].
        tool
            (r,) temperature of the tool or rigid body; not a number for rows between solids [K].
        area
            (r,) areas of the rows, see :meth:`areas` [m^2].
        """
        rows, heat = self.rows, self.heat
        group = np.unique(self.node, return_inverse=True)[1]
        touches = [
            (force[rows] > 0.0) | (gap[rows] <= self.still)
            for force, gap in zip((contact.before, contact.after), gaps, strict=True)
        ]
        closed = np.mean(touches, axis=0)
        whole = np.bincount(group, weights=closed)[group]
        share = closed / np.where(whole > 0.0, whole, 1.0)
        touching = np.minimum(whole, 1.0)
        own = area * share
        force = 0.5 * (contact.before[rows] + contact.after[rows])
        spots = own * heat.closed(force / np.where(own > 0.0, own, 1.0)) * (touching if heat.hardness is None else 1.0)
        gap = np.mean([np.maximum(g[rows], 0.0) for g in gaps], axis=0)
        through = heat.through_gas(gap)
        if heat.emissivity:
            mine = np.asarray(of.mine @ temperature)
            other = np.where(np.isnan(tool), of.theirs @ temperature, tool)
            through = through + (1.0 - touching) * heat.radiated(mine, other)
        return np.asarray(spots + area * np.where(_nearest(group, gap), through, 0.0))


def _nearest(group: IntArray, gap: Array) -> BoolArray:
    """Rows (r,) with the least gap of their group; none in a group without an opponent in reach."""
    order = np.lexsort((gap, group))
    first = order[np.unique(group[order], return_index=True)[1]]
    out = np.zeros(len(gap), bool)
    out[first] = np.isfinite(gap[first])
    return out
