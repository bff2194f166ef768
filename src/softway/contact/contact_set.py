"""All contacts of a model, with the contact search of every slab (time step)."""

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.assembled.vector_space import LocalSpace, VectorSpace
from softway.bodies.rigid_motion import RigidShape
from softway.contact.contact_rows import ContactRows
from softway.contact.node_to_surface.edge_to_edge import EdgeContact
from softway.contact.node_to_surface.joined_rows import joined_rows
from softway.contact.node_to_surface.kept_facets import KeptEdges, keep_facets
from softway.contact.node_to_surface.node_to_tool import NodeToTool, ToolContact
from softway.contact.node_to_surface.slab_pairs import KeptFacets, NodeFacetContact
from softway.contact.node_to_surface.slab_search import SlabSearch
from softway.contact.node_to_surface.split_facets import OnSplitSurface, SplitContact
from softway.contact.stencils import NoPairs, PairedSurfaces, SurfacePair
from softway.contact.surfaces.search_margin import SearchMargin
from softway.contact.tangential_rows import TangentialRows
from softway.tolerances import DEPTH

log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ContactSet:
    """Contacts of a model.

    Parameters
    ----------
    methods
        Methods of the pairs of surfaces; a contact may have several.
    contact
        (m,) number of the contact of each row, in the order of the methods.
    points
        (n, d) reference positions of all nodes [m].
    reach
        Distance beyond the predicted motion within which surfaces are paired [m].
    labels
        Names of the contacts.
    frictionless_rows
        Tangential parts of rows without friction, without directions; None with friction: they depend on positions.
    overlap_methods
        Nodes of either surface against facets of the other, without forces, for contacts that use mean gaps only.
    overlap_contact
        Number of the contact of each overlap method.
    margins
        Margin of the search of each contact in a slab; None for contacts with tools.
    known
        (m,) rows that are linear and never change: resting half-spaces, if no contact has friction.
    known_rows
        All rows where the others are open; None if a row that is not known has an opponent everywhere.
    clearance
        (m,) offsets of the gaps [m], negative where surfaces overlap at the start although the curved facets do not.
    space
        Gathers the positions of surfaces for the search.
    """

    methods: tuple[NodeToTool | SurfacePair, ...]
    contact: IntArray
    points: Array
    reach: float
    labels: tuple[str, ...]
    frictionless_rows: TangentialRows | None
    overlap_methods: tuple[SurfacePair, ...] = ()
    overlap_contact: tuple[int, ...] = ()
    margins: tuple[SearchMargin | None, ...] = ()
    known: BoolArray | None = None
    known_rows: ContactRows | None = None
    clearance: Array | None = None
    space: VectorSpace = LocalSpace(())

    @property
    def node(self) -> IntArray:
        """Slave node (m,) of each row."""
        return np.concatenate([np.zeros(0, int), *(m.node for m in self.methods)])

    @property
    def fixed(self) -> bool:
        """True if the rows never change."""
        return self.known_rows is not None and self.known is not None and bool(self.known.all())

    @property
    def numbers(self) -> tuple[int, ...]:
        """Number of the contact of each method; 0 for one without rows."""
        ends = np.cumsum([len(m.node) for m in self.methods]).tolist()
        return tuple(int(self.contact[end - 1]) if end else 0 for end in ends)

    @property
    def changing(self) -> IntArray:
        """Nodes (k,) that may touch in rows that change, ascending."""
        sides = [side.nodes for m in self.margins if m is not None for side in m.sides]
        tools = [m.node for m in self.methods if isinstance(m, NodeToTool) and not m.fixed]
        return np.unique(np.concatenate([np.zeros(0, int), *sides, *tools]))

    @property
    def paired(self) -> bool:
        """True if deformable surfaces may touch, whose rows are searched for in every slab."""
        return not all(isinstance(m, NodeToTool) for m in self.methods)

    @property
    def crossing_edges(self) -> bool:
        """True if all edges have rows: many of them are redundant, and pairs change often."""
        return any(isinstance(m, OnSplitSurface) for m in self.methods)

    def rows_of(self, contact: int) -> slice:
        """Rows of one contact."""
        found = np.flatnonzero(self.contact == contact)
        return slice(int(found[0]), int(found[-1]) + 1) if len(found) else slice(0, 0)

    def meet(
        self, u0: Array, u1: Array, start: float, end: float, margins: tuple[float, ...] | None = None
    ) -> "SlabContacts":
        """Search the contacts of a slab between two times, from displacement ``u0`` to about ``u1`` (n, d).

        With ``margins`` (c,) [m] of the contacts, only rows with an opponent within the margin have pairs;
        :meth:`SlabContacts.missed` checks them afterwards.
        """
        if self.fixed:
            return self._known_alone(None)
        x0, x1 = self.space.gather(self.points + u0), self.space.gather(self.points + u1)
        search = SlabSearch(u0=u0, u1=u1, start=start, end=end, reach=self.reach, margins=margins)
        found = search.all_met(self.methods, self.numbers, self.margins, (x0, x1))
        met = any(m.found for m in found if not isinstance(m, ToolContact))
        if margins is not None and self.known_rows is not None and not met:
            overlap = search.all_met(self.overlap_methods, self.overlap_contact, self.margins, (x0, x1))
            if not any(m.found for m in overlap):
                return self._known_alone(search)
        return SlabContacts(contacts=self, surfaces=found, node=self.node, search=search)

    def _known_alone(self, search: SlabSearch | None) -> "SlabContacts":
        """Contacts of a slab in which the known rows alone have opponents."""
        alone = SlabContacts(contacts=self, surfaces=(), node=self.node, search=search)
        return replace(alone, fixed_rows=self.known_rows)

    @property
    def closest(self) -> tuple[float, ...]:
        """Least margins (c,) of the search in a slab [m]."""
        return tuple(0.0 if m is None else m.distance for m in self.margins)

    def with_shapes(self, shapes: Mapping[str, RigidShape]) -> "ContactSet":
        """Contacts with other motions of rigid bodies, by their names."""
        methods = tuple(
            replace(m, tool=shapes[m.name]) if isinstance(m, NodeToTool) and m.name in shapes else m
            for m in self.methods
        )
        return replace(self, methods=methods)

    def with_known_rows(self) -> "ContactSet":
        """Contacts with the rows that never change computed in advance."""
        if self.frictionless_rows is None:
            return self
        of = [np.full(len(m.node), isinstance(m, NodeToTool) and m.fixed) for m in self.methods]
        known = np.concatenate([np.zeros(0, bool), *of])
        if not all(m.fixed for m in self.methods if isinstance(m, NodeToTool)):
            return replace(self, known=known)
        tools = (m.during(0.0, 0.0) if isinstance(m, NodeToTool) else NoPairs(rows=len(m.node)) for m in self.methods)
        alone = SlabContacts(contacts=self, surfaces=tuple(tools), node=self.node)
        return replace(self, known=known, known_rows=alone.at(np.zeros_like(self.points)))

    def cleared(self, u: Array, apart: Sequence[bool]) -> "ContactSet":
        """Contacts whose negative mean gaps at the displacement ``u`` (n, d) become offsets of the gaps.

        This holds for contacts that start ``apart`` (c,) and have no node that overlaps a facet.
        """
        if not self.overlap_methods:
            return self
        pairs, least = self.rest(u, 0.0), -DEPTH * self.space.greatest(self.points + u)
        gap = pairs.at(u).gap(u)
        deep = np.array(apart, bool)[self.contact] & (gap < least)
        if deep.any():
            rows = pairs.overlap_rows(u)
            deep &= np.isin(self.contact, np.setdiff1d(self.overlap_contact, rows.contact[rows.gap(u) < least]))
        if not deep.any():
            return self
        log.info("%d contact rows overlap at the start, by at most %.3g m: offset", deep.sum(), -gap[deep].min())
        return replace(self, clearance=np.where(deep, gap, 0.0))

    def rest(self, u: Array, time: float) -> "SlabContacts":
        """Pairs of bodies that do not move."""
        return self.meet(u, u, time, time)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SlabContacts:
    """Contacts found for one slab.

    Parameters
    ----------
    contacts
        Contacts of the model.
    surfaces
        Surfaces that may come into contact, by the methods of ``contacts``.
    node
        Slave node (m,) of each row.
    fixed_rows
        The rows if they do not change in the slab.
    search
        The search, whose margins have to be checked.
    """

    contacts: ContactSet
    surfaces: tuple[PairedSurfaces, ...]
    node: IntArray
    fixed_rows: ContactRows | None = None
    search: SlabSearch | None = None

    @property
    def found(self) -> int:
        """Number of pairs of a node, facet or edge and its opponent that the search found."""
        if self.fixed_rows is not None:
            return int(np.count_nonzero(self.fixed_rows.near))
        return sum(m.found for m in self.surfaces)

    def start(self, u: Array) -> ContactRows:
        """Contact rows at the start of the slab, at the displacement ``u`` (n, d) there."""
        if self.fixed_rows is not None:
            return self.fixed_rows
        first = tuple(m.opening() if isinstance(m, ToolContact) else m for m in self.surfaces)
        return replace(self, surfaces=first).at(u)

    def at(self, u: Array) -> ContactRows:
        """Contact rows at the end of the slab, exact in value and derivative at the displacement ``u`` (n, d)."""
        if self.fixed_rows is not None:
            return self.fixed_rows
        contacts, clearance = self.contacts, self.contacts.clearance
        places, numbers = (contacts.points + u, u), (self.node, contacts.contact)
        rows = joined_rows(self.surfaces, places, numbers, contacts.labels, contacts.frictionless_rows)
        return rows if clearance is None else replace(rows, offset=rows.offset - clearance)

    def with_kept_facets(self, u: Array, before: "SlabContacts | None" = None) -> "SlabContacts":
        """Contacts with facets and edges kept as at the displacement ``u`` (n, d), and those kept ``before``."""
        x = self.contacts.points + u
        old = self.surfaces if before is None else before.surfaces
        kept = tuple(
            keep_facets(m, x, o if isinstance(o, KeptFacets | KeptEdges | SplitContact) else None)
            if isinstance(m, NodeFacetContact | EdgeContact | SplitContact)
            else m
            for m, o in zip(self.surfaces, old, strict=True)
        )
        return replace(self, surfaces=kept)

    def missed(self, u: Array) -> "SlabContacts | None":
        """Contacts found with greater margins, if the displacement ``u`` (n, d) at the end of the slab leaves more than
        the margin of a contact to the expected one, and a row that was not found overlaps there; None otherwise.
        """
        search, contacts = self.search, self.contacts
        if search is None or search.margins is None:
            return None
        deviation = np.linalg.norm(contacts.space.gather(u - search.u1), axis=1)
        margins = search.wanted(contacts.margins, deviation)
        if margins is None:
            return None
        wider = contacts.meet(search.u0, search.u1, search.start, search.end, margins)
        if wider.found == self.found:
            return None
        log.debug("search with margins of %s m", margins)
        least = -DEPTH * contacts.space.greatest(contacts.points + u)
        old, new = (pairs.at(u).gap(u) for pairs in (self, wider))
        return wider if ((new < least) & (new != old)).any() else None

    def apart(self, u: Array) -> bool:
        """True if no surfaces overlap at the displacement ``u`` (n, d) beyond rounding."""
        return self.overlap(u) <= DEPTH * self.contacts.space.greatest(self.contacts.points + u)

    def overlap(self, u: Array) -> float:
        """Greatest overlap at the displacement ``u`` (n, d) [m]; negative if nothing touches."""
        rows = self.at(u)
        return -float(rows.gap(u)[rows.near].min(initial=np.inf))

    def overlap_rows(self, u: Array, of_tools: bool = False) -> ContactRows:
        """Rows that detect every overlap of nodes with facets, at the displacement ``u`` (n, d), or those ``of_tools``
        only; without friction where they are not the contact rows.
        """
        contacts, search = self.contacts, self.search
        if search is None or self.fixed_rows is not None or not contacts.overlap_methods:
            return self.at(u)
        x0, x1 = (contacts.space.gather(contacts.points + v) for v in (search.u0, search.u1))
        tools = [m for m in self.surfaces if isinstance(m, ToolContact)]
        methods: tuple[SurfacePair, ...] = () if of_tools else contacts.overlap_methods
        of = () if of_tools else contacts.overlap_contact
        surfaces = (*tools, *search.all_met(methods, of, contacts.margins, (x0, x1)))
        numbers = [contacts.contact[i] for i in self._tool_rows()]
        numbers += [np.full(len(m.node), k) for m, k in zip(methods, of, strict=True)]
        node = np.concatenate([np.zeros(0, int), *(m.node for m in tools), *(m.node for m in methods)])
        both = node, np.concatenate([np.zeros(0, int), *numbers])
        frictionless = TangentialRows.none(len(node), *u.shape)
        return joined_rows(surfaces, (contacts.points + u, u), both, contacts.labels, frictionless)

    def _tool_rows(self) -> list[slice]:
        """Rows of the methods for contact with tools."""
        ends = np.cumsum([len(m.node) for m in self.contacts.methods])
        return [
            slice(int(end) - len(m.node), int(end))
            for m, end in zip(self.contacts.methods, ends, strict=True)
            if isinstance(m, NodeToTool)
        ]
