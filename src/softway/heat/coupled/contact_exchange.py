"""Heat across the contacts of solids in a slab: conductances of the rows, and the heat of friction at the nodes."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.assembled.heated_nodes import HeatedNodes
from softway.contact.contact import Contact, NodeToSurface
from softway.contact.friction_rows import surfaces_of
from softway.contact.impact_rule import Energy
from softway.errors import InputError, within
from softway.heat.coupled.contact_sides import ContactSides, contact_sides
from softway.heat.coupled.rows_of_contact import STILL, RowsOfContact
from softway.heat.heat_contact import HeatExchange
from softway.heat.heat_model import Lump
from softway.laws.heat.contact_heat import ContactHeat
from softway.model.field import FieldContact
from softway.model.model import Model


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ContactExchange:
    """Heat across the contacts of a model of n nodes, k of which have a temperature, and r rigid bodies that have one.

    Parameters
    ----------
    contacts
        Contacts across which heat passes.
    part_of
        (n,) number of the solid of each node.
    heated
        The nodes with a temperature.
    effusivity
        (n,) roots of conductivity, density and capacity [W s^(1/2)/(m^2 K)].
    lumps
        The rigid bodies.
    """

    contacts: tuple[RowsOfContact, ...]
    part_of: IntArray
    heated: HeatedNodes
    effusivity: Array
    lumps: tuple[Lump, ...] = ()

    @property
    def with_tools(self) -> BoolArray:
        """Contacts (c,) with tools, and with rigid bodies without a temperature."""
        return np.array([c.tool and c.lump is None for c in self.contacts], bool)

    @property
    def radiates(self) -> bool:
        """True if a gap radiates."""
        return any(c.heat.emissivity > 0.0 for c in self.contacts)

    def change(self, contact: FieldContact) -> bool:
        """True if a row closes or opens in a slab."""
        first, last = contact.before > 0.0, contact.after > 0.0
        return any(bool((first[c.rows] != last[c.rows]).any()) for c in self.contacts)

    def sides(self, contact: FieldContact) -> tuple[ContactSides, ...]:
        """Sides of the rows of each contact in a slab."""
        return tuple(contact_sides(contact.first, contact.last, c.rows, self.part_of) for c in self.contacts)

    def exchanges(
        self,
        contact: FieldContact,
        ends: tuple[Array, Array],
        sides: tuple[ContactSides, ...],
        temperature: Array,
        rigid: Array,
    ) -> dict[int, HeatExchange]:
        """Exchange of the contacts that pass heat in a slab, by their places among ``contacts``, with the areas in its
        middle.

        Parameters
        ----------
        contact
            Contact of the slab.
        ends
            (n, d) displacements at both ends [m].
        sides
            Sides of the rows.
        temperature, rigid
            (n,) temperatures of the nodes and (r,) of the rigid bodies, for the radiation [K].
        """
        found: dict[int, HeatExchange] = {}
        if not self.contacts:
            return found
        gaps, middle = (contact.first.gap(ends[0]), contact.last.gap(ends[1])), 0.5 * (ends[0] + ends[1])
        for k, (rows, of) in enumerate(zip(self.contacts, sides, strict=True)):
            tool = rows.opposite(of, rigid)
            area = rows.areas(middle, contact.last.normal)
            conductance = rows.conductances(contact, gaps, of, temperature, tool, area)
            here = np.flatnonzero((conductance > 0.0) & ((of.opponent >= 0) | ~np.isnan(tool)))
            if here.size:
                sign = np.where(self._begins(rows, of), 1.0, -1.0)[here]
                jump = self._with_rigid(sp.csr_array(sp.diags_array(sign) @ (of.mine[here] - of.theirs[here])), rows)
                ambient = np.where(np.isnan(tool) | (rows.lump is not None), 0.0, tool)[here]
                found[k] = HeatExchange(jump=jump, conductances=conductance[here], ambient=ambient)
        return found

    def _with_rigid(self, jump: sp.csr_array, rows: RowsOfContact) -> sp.csr_array:
        """Jumps (p, k + r) of rows whose nodes have the weights ``jump`` (p, n)."""
        own = self.heated.rows(jump)
        if rows.lump is None:
            return own
        one, at = np.ones(own.shape[0]), len(self.heated.number) + np.full(own.shape[0], rows.lump)
        return sp.csr_array(own - sp.csr_array((one, (np.arange(len(one)), at)), shape=own.shape))

    def spread(self, rubbed: Array, sides: tuple[ContactSides, ...]) -> tuple[Array, Array]:
        """Heat (k + r,) of friction at the nodes and in the rigid bodies, and that which the tools of each contact take
        [J], from the energies (m,) that friction dissipates at the rows [J].
        """
        out, taken = np.zeros(len(self.part_of)), np.zeros(len(self.contacts))
        rigid = np.zeros(len(self.lumps))
        for k, (rows, of) in enumerate(zip(self.contacts, sides, strict=True)):
            heat = rubbed[rows.rows]
            if heat.any():
                share = self._shares(rows, of)
                rest = (1.0 - share) * heat
                out += of.mine.T @ (share * heat) + of.theirs.T @ rest
                left = rest[of.opponent < 0].sum()
                if rows.lump is None:
                    taken[k] = left
                else:
                    rigid[rows.lump] += left
        own = self.heated.sums(out)
        own[len(self.heated.number) :] = rigid
        return own, taken

    def entropy_of_tools(self, taken: Array) -> float:
        """Entropy that the tools with a temperature gain with the heat (c,) of friction that they take [J/K]."""
        at = ((heat, rows.heat.tool_temperature) for heat, rows in zip(taken.tolist(), self.contacts, strict=True))
        return sum(heat / temperature for heat, temperature in at if temperature is not None)

    def _begins(self, rows: RowsOfContact, of: ContactSides) -> BoolArray:
        """Rows (r,) whose slave nodes are those of the solid that is named first."""
        mine, theirs = (rows.order[self.part_of[node]] for node in (rows.node, of.opponent))
        return np.asarray((of.opponent < 0) | (mine <= theirs))

    def _shares(self, rows: RowsOfContact, of: ContactSides) -> Array:
        """Shares (r,) of the heat of friction that go to the sides of the slave nodes."""
        tool, given = of.opponent < 0, rows.heat.share
        if given is None:
            mine, theirs = self.effusivity[rows.node], self.effusivity[of.opponent]
            other = None if rows.lump is None else self.lumps[rows.lump].effusivity
            return np.where(tool, 1.0 if other is None else mine / (mine + other), mine / (mine + theirs))
        return np.where(self._begins(rows, of), given, 1.0 - given)


def contact_exchange(
    model: Model, heated: HeatedNodes, effusivity: Mapping[str, float | Array], lumps: tuple[Lump, ...] = ()
) -> ContactExchange:
    """Heat across the contacts of a model whose nodes ``heated`` and rigid bodies ``lumps`` have a temperature.

    Parameters
    ----------
    effusivity
        Root of conductivity, density and capacity of each solid with heat, by its name, one number or one for each of
        its nodes [W s^(1/2)/(m^2 K)].

    Raises
    ------
    InputError
        If heat passes a contact with a solid that has no temperature, or nothing says how a rigid body shares the heat
        of friction.
    """
    names, found, rigid = [part.name for part in model.parts], [], [lump.name for lump in lumps]
    by_node = np.ones(len(model.part_of))
    for part in model.parts:
        by_node[part.nodes] = effusivity.get(part.name, 1.0)
    slave, edge = model.contacts.node, float(model.edge.min())
    for k, contact in enumerate(model.scene.contacts):
        if contact.heat is None:
            continue
        with within(f"contacts[{k}]"):
            opponent = contact.opponent if model.against_tool[k] else ""
            lump = rigid.index(opponent) if opponent in rigid else None
            _check(contact, contact.heat, bool(model.against_tool[k]))
            if lump is not None:
                _check_rigid(contact, contact.heat, lumps[lump])
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
                lump=lump,
            )
        )  # fmt: skip
    return ContactExchange(contacts=tuple(found), part_of=model.part_of, heated=heated, effusivity=by_node, lumps=lumps)


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


def _check_rigid(contact: Contact, heat: ContactHeat, lump: Lump) -> None:
    """Refuse a second temperature of a rigid body, and friction whose heat nobody shares."""
    if heat.tool_temperature is not None:
        problem = f"{heat.tool_temperature:g} K of {lump.name!r}, which has a temperature of its own"
        raise InputError("heat.tool_temperature", problem, f"omit it, or no thermal of bodies.{lump.name}")
    if heat.share is None and lump.effusivity is None and not contact.friction.frictionless:
        problem = f"missing: the effusivity of {lump.name!r}, by which friction would share its heat, is unknown"
        remedy = f"a share from 0 to 1, or density and thermal.conductivity of bodies.{lump.name}"
        raise InputError("heat.share", problem, remedy)


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
