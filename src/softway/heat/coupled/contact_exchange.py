"""Heat across the contacts of solids in a slab: conductances of the rows, and the heat of friction at the nodes."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.friction_rows import DeclaredSurface, row_areas, surfaces_of
from softway.contact.mortar.mortar import Mortar
from softway.errors import InputError
from softway.heat.coupled.contact_sides import ContactSides, contact_sides
from softway.heat.heat_contact import HeatExchange
from softway.laws.heat.contact_heat import ContactHeat
from softway.model.field import FieldContact
from softway.model.model import Model


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RowsOfContact:
    """Rows of a contact across which heat passes.

    Parameters
    ----------
    number
        Number of the contact.
    heat
        Its law.
    rows, node
        (r,) numbers of its rows, and their slave nodes.
    surfaces
        Declared surfaces of its solids.
    share
        Share of the area of its node that a row stands for: one half where the nodes of both surfaces have rows.
    first
        Number of the solid that is named first.
    tool
        True if the opponent is a tool.
    area
        (r,) areas of the rows at the start of the slab [m^2].
    """

    number: int
    heat: ContactHeat
    rows: IntArray
    node: IntArray
    surfaces: tuple[DeclaredSurface, ...]
    share: float
    first: int
    tool: bool
    area: Array

    def at(self, u: Array) -> "RowsOfContact":
        """Rows with their areas at the displacement ``u`` (n, d) [m]."""
        return replace(self, area=self.share * np.maximum(row_areas(self.surfaces, u)[self.node], 0.0))

    def conductances(
        self, contact: FieldContact, gaps: tuple[Array, Array], of: ContactSides, temperature: Array, tool: Array
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
            (r,) temperature of the tool; not a number for rows between solids [K].
        """
        rows, heat = self.rows, self.heat
        group = np.unique(self.node, return_inverse=True)[1]
        closed = 0.5 * ((contact.before[rows] > 0.0).astype(float) + (contact.after[rows] > 0.0))
        whole = np.bincount(group, weights=closed)[group]
        share = closed / np.where(whole > 0.0, whole, 1.0)
        touching = np.minimum(whole, 1.0)
        own = self.area * share
        force = 0.5 * (contact.before[rows] + contact.after[rows])
        spots = own * heat.closed(force / np.where(own > 0.0, own, 1.0)) * (touching if heat.hardness is None else 1.0)
        with np.errstate(invalid="ignore"):
            gap = 0.5 * sum(np.maximum(g[rows], 0.0) for g in gaps)
        through: Array = heat.through_gas(gap)
        if heat.emissivity:
            other = np.where(np.isnan(tool), of.theirs @ temperature, tool)
            through = through + (1.0 - touching) * heat.radiated(of.mine @ temperature, other)
        return np.asarray(spots + self.area * np.where(_nearest(group, gap), through, 0.0))


def _nearest(group: IntArray, gap: Array) -> BoolArray:
    """Rows (r,) with the least gap of their group; none in a group without an opponent in reach."""
    order = np.lexsort((gap, group))
    first = order[np.unique(group[order], return_index=True)[1]]
    out = np.zeros(len(gap), bool)
    out[first] = np.isfinite(gap[first])
    return out


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ContactExchange:
    """Heat across the contacts of a model of n nodes, k of which have a temperature.

    Parameters
    ----------
    contacts
        Contacts across which heat passes.
    part_of
        (n,) number of the solid of each node.
    nodes
        (k,) nodes with a temperature.
    effusivity
        (n,) roots of conductivity, density and capacity [W s^(1/2)/(m^2 K)].
    """

    contacts: tuple[RowsOfContact, ...]
    part_of: IntArray
    nodes: IntArray
    effusivity: Array

    @property
    def with_tools(self) -> BoolArray:
        """Contacts (c,) with tools."""
        return np.array([c.tool for c in self.contacts], bool)

    @property
    def radiates(self) -> bool:
        """True if a gap radiates."""
        return any(c.heat.emissivity > 0.0 for c in self.contacts)

    def at(self, u: Array) -> "ContactExchange":
        """Exchange with the areas at the displacement ``u`` (n, d) [m]."""
        return replace(self, contacts=tuple(c.at(u) for c in self.contacts))

    def sides(self, contact: FieldContact) -> tuple[ContactSides, ...]:
        """Sides of the rows of each contact in a slab."""
        return tuple(contact_sides(contact.first, contact.last, c.rows, self.part_of) for c in self.contacts)

    def exchanges(
        self, contact: FieldContact, ends: tuple[Array, Array], sides: tuple[ContactSides, ...], temperature: Array
    ) -> dict[int, HeatExchange]:
        """Exchange of the contacts that pass heat in a slab, by their places among ``contacts``.

        Parameters
        ----------
        contact
            Contact of the slab.
        ends
            (n, d) displacements at both ends [m].
        sides
            Sides of the rows.
        temperature
            (n,) temperatures for the radiation [K].
        """
        gaps = contact.first.gap(ends[0]), contact.last.gap(ends[1])
        found = {}
        for k, (rows, of) in enumerate(zip(self.contacts, sides, strict=True)):
            given = np.nan if rows.heat.tool_temperature is None else rows.heat.tool_temperature
            tool = np.where(of.opponent < 0, given, np.nan)
            conductance = rows.conductances(contact, gaps, of, temperature, tool)
            here = np.flatnonzero((conductance > 0.0) & ((of.opponent >= 0) | ~np.isnan(tool)))
            if here.size:
                jump = sp.csr_array(of.jump[here][:, self.nodes])
                ambient = np.where(np.isnan(tool), 0.0, tool)[here]
                found[k] = HeatExchange(jump=jump, conductances=conductance[here], ambient=ambient)
        return found

    def spread(self, rubbed: Array, sides: tuple[ContactSides, ...]) -> tuple[Array, Array]:
        """Heat (k,) of friction at the nodes, and that which the tools of each contact take [J], from the energies (m,)
        that friction dissipates at the rows [J].
        """
        out, taken = np.zeros(len(self.part_of)), np.zeros(len(self.contacts))
        for k, (rows, of) in enumerate(zip(self.contacts, sides, strict=True)):
            heat = rubbed[rows.rows]
            if heat.any():
                share = self._shares(rows, of)
                rest = (1.0 - share) * heat
                out += of.mine.T @ (share * heat) + of.theirs.T @ rest
                taken[k] = rest[of.opponent < 0].sum()
        return out[self.nodes], taken

    def _shares(self, rows: RowsOfContact, of: ContactSides) -> Array:
        """Shares (r,) of the heat of friction that go to the sides of the slave nodes."""
        tool, given = of.opponent < 0, rows.heat.share
        if given is None:
            mine, theirs = self.effusivity[rows.node], self.effusivity[of.opponent]
            return np.where(tool, 1.0, mine / (mine + theirs))
        return np.where(tool | (self.part_of[rows.node] == rows.first), given, 1.0 - given)


def contact_exchange(model: Model, nodes: IntArray, effusivity: Mapping[str, float]) -> ContactExchange:
    """Heat across the contacts of a model whose ``nodes`` (k,) have a temperature.

    Parameters
    ----------
    effusivity
        Root of conductivity, density and capacity of each solid with heat, by its name [W s^(1/2)/(m^2 K)].

    Raises
    ------
    InputError
        If heat passes a contact with a solid that has no temperature.
    """
    names, found = [part.name for part in model.parts], []
    by_node = np.array([effusivity.get(name, 1.0) for name in names])[model.part_of]
    slave = model.contacts.node
    for k, contact in enumerate(model.scene.contacts):
        if contact.heat is None:
            continue
        cold = [name for name in contact.bodies if name in names and name not in effusivity]
        if cold:
            problem = f"heat across a contact with {cold[0]!r}, which has no temperature"
            raise InputError(f"contacts[{k}].heat", problem, f"bodies.{cold[0]}.thermal, or a contact without heat")
        rows = _rows(model, k)
        solids = model.contact_solids[k]
        both = len(np.unique(model.part_of[slave[rows]])) > 1 or (len(solids) == 1 and not model.against_tool[k])
        first = next(names.index(name) for name in contact.bodies if name in names)
        found.append(
            RowsOfContact(
                number=k, heat=contact.heat, rows=rows, node=slave[rows], share=0.5 if both else 1.0, first=first,
                surfaces=surfaces_of(contact, model.parts), tool=bool(model.against_tool[k]), area=np.zeros(len(rows)),
            )
        )  # fmt: skip
    return ContactExchange(contacts=tuple(found), part_of=model.part_of, nodes=nodes, effusivity=by_node)


def _rows(model: Model, number: int) -> IntArray:
    """Rows (r,) of a contact that stand for a part of its surface: with mortar not those of corners beside it."""
    contacts, start, found = model.contacts, 0, []
    of = [(m, k) for m, k in zip(contacts.methods, contacts.numbers, strict=True) if len(m.node)]
    mortar = any(isinstance(m, Mortar) for m, k in of if k == number)
    for method, k in of:
        end = start + len(method.node)
        if k == number and (isinstance(method, Mortar) or not mortar):
            found.append(np.arange(start, end))
        start = end
    return np.concatenate([np.zeros(0, int), *found])
