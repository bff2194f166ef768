"""Heat across the contacts of solids in a slab: conductances of the rows, and the heat of friction at the nodes."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.contact import Contact, NodeToSurface
from softway.contact.friction_rows import DeclaredSurface, surfaces_of
from softway.contact.impact_rule import Energy
from softway.errors import InputError, within
from softway.heat.coupled.contact_sides import ContactSides, contact_sides
from softway.heat.coupled.facing_areas import FacingAreas, facing_areas
from softway.heat.heat_contact import HeatExchange
from softway.laws.heat.contact_heat import ContactHeat
from softway.model.field import FieldContact
from softway.model.model import Model

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
        True if the opponent is a tool.
    still
        Distance of surfaces that touch without a force [m].
    facing
        Areas at the start of a slab; None outside.
    """

    heat: ContactHeat
    rows: IntArray
    node: IntArray
    surfaces: tuple[DeclaredSurface, ...]
    share: float
    order: IntArray
    tool: bool
    still: float
    facing: FacingAreas | None = None

    def at(self, u: Array) -> "RowsOfContact":
        """Rows with their areas at the displacement ``u`` (n, d) [m]."""
        return replace(self, facing=facing_areas(self.surfaces, u, self.node))

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
        assert self.facing is not None
        rows, heat = self.rows, self.heat
        area = self.share * self.facing.towards(contact.last.normal[rows])
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

    def change(self, contact: FieldContact) -> bool:
        """True if a row closes or opens in a slab."""
        first, last = contact.before > 0.0, contact.after > 0.0
        return any(bool((first[c.rows] != last[c.rows]).any()) for c in self.contacts)

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
                sign = np.where(self._begins(rows, of), 1.0, -1.0)[here]
                jump = sp.diags_array(sign) @ (of.mine[here] - of.theirs[here])
                ambient = np.where(np.isnan(tool), 0.0, tool)[here]
                found[k] = HeatExchange(
                    jump=sp.csr_array(jump[:, self.nodes]), conductances=conductance[here], ambient=ambient
                )
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

    def _begins(self, rows: RowsOfContact, of: ContactSides) -> BoolArray:
        """Rows (r,) whose slave nodes are those of the solid that is named first."""
        mine, theirs = (rows.order[self.part_of[node]] for node in (rows.node, of.opponent))
        return np.asarray((of.opponent < 0) | (mine <= theirs))

    def _shares(self, rows: RowsOfContact, of: ContactSides) -> Array:
        """Shares (r,) of the heat of friction that go to the sides of the slave nodes."""
        tool, given = of.opponent < 0, rows.heat.share
        if given is None:
            mine, theirs = self.effusivity[rows.node], self.effusivity[of.opponent]
            return np.where(tool, 1.0, mine / (mine + theirs))
        return np.where(self._begins(rows, of), given, 1.0 - given)


def contact_exchange(model: Model, nodes: IntArray, effusivity: Mapping[str, float | Array]) -> ContactExchange:
    """Heat across the contacts of a model whose ``nodes`` (k,) have a temperature.

    Parameters
    ----------
    effusivity
        Root of conductivity, density and capacity of each solid with heat, by its name, one number or one for each of
        its nodes [W s^(1/2)/(m^2 K)].

    Raises
    ------
    InputError
        If heat passes a contact with a solid that has no temperature.
    """
    names, found = [part.name for part in model.parts], []
    by_node = np.ones(len(model.part_of))
    for part in model.parts:
        by_node[part.nodes] = effusivity.get(part.name, 1.0)
    slave, edge = model.contacts.node, float(model.edge.min())
    for k, contact in enumerate(model.scene.contacts):
        if contact.heat is None:
            continue
        with within(f"contacts[{k}]"):
            _check(contact, contact.heat, bool(model.against_tool[k]))
            cold = [name for name in contact.bodies if name in names and name not in effusivity]
            if cold:
                problem = f"heat across a contact with {cold[0]!r}, which has no temperature"
                raise InputError("heat", problem, f"bodies.{cold[0]}.thermal, or a contact without heat")
        rows, tool = _rows(model, k), bool(model.against_tool[k])
        order = np.array([contact.bodies.index(name) if name in contact.bodies else 0 for name in names])
        found.append(
            RowsOfContact(
                heat=contact.heat, rows=rows, node=slave[rows], order=order,
                share=0.5 if _of_both(contact) and not tool else 1.0,
                surfaces=surfaces_of(contact, model.parts), tool=tool, still=STILL * edge,
            )
        )  # fmt: skip
    return ContactExchange(contacts=tuple(found), part_of=model.part_of, nodes=nodes, effusivity=by_node)


def _check(contact: Contact, heat: ContactHeat, tool: bool) -> None:
    """Refuse heat of a contact that has no meaning for it."""
    if not isinstance(contact.timing, Energy):
        problem = f"heat with {type(contact.timing).__name__}, whose impacts do not heat"
        raise InputError("timing", problem, "the timing Energy, or a contact without heat")
    if contact.many and heat.share is not None:
        problem = f"a share of the heat of friction in {contact.label!r}, which has no first body"
        raise InputError("heat.share", problem, "no share, or contacts of two bodies")
    if heat.tool_temperature is not None and not tool and not contact.many:
        raise InputError("heat.tool_temperature", f"{contact.label!r} has no tool", "omit it, or a contact with a tool")


def _of_both(contact: Contact) -> bool:
    """True if the nodes of either surface have rows."""
    return contact.many or (isinstance(contact.method, NodeToSurface) and contact.method.nodes == "both")


def _rows(model: Model, number: int) -> IntArray:
    """Rows (r,) of a contact that stand for a part of its surface: between two solids those of the finer one, without
    those of corners and edges beside them.
    """
    contact, ends = model.scene.contacts[number], np.cumsum([len(m.node) for m in model.contacts.methods])
    found = [
        np.arange(end - len(method.node), end)
        for method, k, end in zip(model.contacts.methods, model.contacts.numbers, ends.tolist(), strict=True)
        if k == number and len(method.node)
    ]
    return np.concatenate([np.zeros(0, int), *(found if _of_both(contact) else found[:1])])
