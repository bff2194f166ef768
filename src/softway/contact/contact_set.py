"""All contacts of a model, with the contact search of every slab (time step)."""

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.bodies.assembled.vector_space import LocalSpace, VectorSpace
from softway.bodies.rigid_motion import RigidShape
from softway.contact.contact_rows import ContactRows
from softway.contact.node_to_surface.edge_to_edge import EdgeContact
from softway.contact.node_to_surface.kept_facets import KeptEdges, keep_facets
from softway.contact.node_to_surface.node_to_tool import NodeToTool, ToolContact
from softway.contact.node_to_surface.slab_pairs import KeptFacets, NodeFacetContact
from softway.contact.stencils import Stencils
from softway.contact.tangential_rows import TangentialRows, tangents
from softway.tolerances import DEPTH

log = logging.getLogger(__name__)


class PairedSurfaces(Protocol):
    """Surfaces that may come into contact in one slab."""

    @property
    def found(self) -> int:
        """Number of pairs found by the search."""
        ...

    def at(self, x: Array) -> Stencils:
        """Gaps and their derivatives at positions ``x`` (n, d)."""
        ...


class SurfacePair(Protocol):
    """Contact method between deformable surfaces; its rows stay the same throughout a march."""

    @property
    def node(self) -> IntArray:
        """Slave node (m,) of each row."""
        ...

    def meet(self, x0: Array, x1: Array, reach: float) -> PairedSurfaces:
        """Pairs that may touch in a slab from positions ``x0`` to about ``x1`` (n, d), within ``reach`` [m]."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ContactSet:
    """Contacts of a model.

    Parameters
    ----------
    methods
        Contact methods of the pairs of surfaces; a contact may have several.
    contact
        (m,) number of the contact of each row, in the order of the methods.
    points
        (n, d) reference positions of all nodes [m].
    reach
        Distance beyond the predicted motion within which surfaces are paired [m].
    labels
        Names of the contacts.
    frictionless_rows
        Tangential parts of the rows if no contact has friction, without directions; None with friction, where they
        depend on the positions.
    overlap_methods
        Nodes of either surface against the facets of the other, for contacts whose methods use mean gaps only: they
        measure the overlap of the surfaces and transmit no force.
    overlap_contact
        Number of the contact of each overlap method.
    fixed_rows
        Contact rows that are linear and never change: resting half-spaces without friction; None for other contacts.
    clearance
        (m,) offsets of the gaps [m]: negative where the linear surfaces in place of curved facets overlap at the start
        although the curved surfaces do not; None without such overlaps.
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
    fixed_rows: ContactRows | None = None
    clearance: Array | None = None
    space: VectorSpace = LocalSpace(())

    @property
    def node(self) -> IntArray:
        """Slave node (m,) of each row."""
        return np.concatenate([np.zeros(0, int), *(m.node for m in self.methods)])

    @property
    def fixed(self) -> bool:
        """True if the rows never change."""
        return self.fixed_rows is not None

    @property
    def paired(self) -> bool:
        """True if deformable surfaces may touch, whose rows are searched for in every slab."""
        return not all(isinstance(m, NodeToTool) for m in self.methods)

    def rows_of(self, contact: int) -> slice:
        """Rows of one contact."""
        found = np.flatnonzero(self.contact == contact)
        return slice(int(found[0]), int(found[-1]) + 1) if len(found) else slice(0, 0)

    def meet(self, u0: Array, u1: Array, start: float, end: float) -> "SlabContacts":
        """Search the contacts of a slab between two times, from displacement ``u0`` to about ``u1`` (n, d)."""
        if self.fixed_rows is not None:
            return SlabContacts(
                contacts=self, surfaces=(), overlap_surfaces=(), node=self.node, fixed_rows=self.fixed_rows
            )
        x0, x1 = self.space.gather(self.points + u0), self.space.gather(self.points + u1)
        found = tuple(
            m.during(start, end) if isinstance(m, NodeToTool) else m.meet(x0, x1, self.reach) for m in self.methods
        )
        overlap = tuple(m.meet(x0, x1, self.reach) for m in self.overlap_methods)
        return SlabContacts(contacts=self, surfaces=found, overlap_surfaces=overlap, node=self.node, fixed_rows=None)

    def with_shapes(self, shapes: Mapping[str, RigidShape]) -> "ContactSet":
        """Contacts with other motions of rigid bodies, by the name of the body."""
        methods = tuple(
            replace(m, tool=shapes[m.name]) if isinstance(m, NodeToTool) and m.name in shapes else m
            for m in self.methods
        )
        return replace(self, methods=methods)

    def with_fixed_rows(self) -> "ContactSet":
        """Contacts with their rows computed in advance if these never change."""
        if self.frictionless_rows is None or not all(isinstance(m, NodeToTool) and m.fixed for m in self.methods):
            return self
        still = np.zeros_like(self.points)
        return replace(self, fixed_rows=self.rest(still, 0.0).at(still))

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
    surfaces, overlap_surfaces
        Surfaces that may come into contact, by the methods and by the overlap methods of ``contacts``.
    node
        Slave node (m,) of each row.
    fixed_rows
        The rows if they never change.
    """

    contacts: ContactSet
    surfaces: tuple[PairedSurfaces, ...]
    overlap_surfaces: tuple[PairedSurfaces, ...]
    node: IntArray
    fixed_rows: ContactRows | None

    @property
    def found(self) -> int:
        """Number of pairs of a node, facet or edge and its opponent that the search found."""
        return len(self.node) if self.fixed_rows is not None else sum(m.found for m in self.surfaces)

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
        rows = self._rows(self.surfaces, u, self.node, contacts.contact, contacts.frictionless_rows)
        return rows if clearance is None else replace(rows, offset=rows.offset - clearance)

    def with_kept_facets(self, u: Array, before: "SlabContacts | None" = None) -> "SlabContacts":
        """Contacts with facets and edges kept as at the displacement ``u`` (n, d), and those kept ``before``."""
        x = self.contacts.points + u
        old = self.surfaces if before is None else before.surfaces
        kept = tuple(
            keep_facets(m, x, o if isinstance(o, KeptFacets | KeptEdges) else None)
            if isinstance(m, NodeFacetContact | EdgeContact)
            else m
            for m, o in zip(self.surfaces, old, strict=True)
        )
        return replace(self, surfaces=kept)

    def apart(self, u: Array) -> bool:
        """True if no surfaces overlap at the displacement ``u`` (n, d) beyond rounding."""
        return self.overlap(u) <= DEPTH * self.contacts.space.greatest(self.contacts.points + u)

    def overlap(self, u: Array) -> float:
        """Greatest overlap at the displacement ``u`` (n, d) [m]; negative if nothing touches."""
        rows = self.at(u)
        return -float(rows.gap(u)[rows.near].min(initial=np.inf))

    def overlap_rows(self, u: Array) -> ContactRows:
        """Rows that detect every overlap of nodes with facets, at the displacement ``u`` (n, d); without friction where
        they are not the contact rows.
        """
        if not self.overlap_surfaces:
            return self.at(u)
        contacts = self.contacts
        tools = [m for m in self.surfaces if isinstance(m, ToolContact)]
        numbers = [contacts.contact[i] for i in self._tool_rows()]
        nodes = [m.node for m in contacts.overlap_methods]
        numbers += [np.full(len(n), k) for n, k in zip(nodes, contacts.overlap_contact, strict=True)]
        node = np.concatenate([m.node for m in tools] + nodes)
        surfaces, frictionless = (*tools, *self.overlap_surfaces), TangentialRows.none(len(node), *u.shape)
        return self._rows(surfaces, u, node, np.concatenate(numbers), frictionless)

    def _tool_rows(self) -> list[slice]:
        """Rows of the methods for contact with tools."""
        ends = np.cumsum([len(m.node) for m in self.contacts.methods])
        return [
            slice(int(end) - len(m.node), int(end))
            for m, end in zip(self.contacts.methods, ends, strict=True)
            if isinstance(m, NodeToTool)
        ]

    def _rows(
        self,
        surfaces: tuple[PairedSurfaces, ...],
        u: Array,
        node: IntArray,
        contact: IntArray,
        frictionless: TangentialRows | None,
    ) -> ContactRows:
        x = self.contacts.points + u
        found = [m.at(x) for m in surfaces]
        d = x.shape[1]
        normal = np.concatenate([np.zeros((0, d)), *(s.normal for s in found)])
        gradient = sp.vstack([sp.csr_array((0, x.size)), *(s.gradient() for s in found)], format="csr")
        gap = np.concatenate([np.zeros(0), *(s.gap for s in found)])
        tool_motion = [
            m.normal_motion(x, s.normal) if isinstance(m, ToolContact) else np.zeros(len(s.gap))
            for m, s in zip(surfaces, found, strict=True)
        ]
        return ContactRows(
            node=node,
            contact=contact,
            normal=normal,
            gradient=sp.csr_array(gradient),
            offset=gap - gradient @ u.ravel(),
            tool_motion=np.concatenate([np.zeros(0), *tool_motion]),
            labels=self.contacts.labels,
            shear=_shear(surfaces, found, x, normal) if frictionless is None else frictionless,
        )


def _shear(surfaces: tuple[PairedSurfaces, ...], found: list[Stencils], x: Array, normal: Array) -> TangentialRows:
    """Tangential parts of the rows at positions ``x`` (n, d), with normals (m, d)."""
    moved = [
        m.moved(x) if isinstance(m, ToolContact) else np.zeros_like(s.normal)
        for m, s in zip(surfaces, found, strict=True)
    ]
    weights = sp.vstack([sp.csr_array((0, len(x))), *(s.weights for s in found)], format="csr")
    return TangentialRows(
        weights=sp.csr_array(weights),
        tangents=tangents(normal),
        moved=np.concatenate([np.zeros((0, x.shape[1])), *moved]),
    )
