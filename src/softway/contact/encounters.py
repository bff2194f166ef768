"""All contacts of a model: who may touch whom, searched afresh for every slab."""

import logging
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from softway.contact.candidates import Candidates
from softway.contact.edges import EdgeMeeting
from softway.contact.holding import HeldEdges, held
from softway.contact.meeting import Held
from softway.contact.meeting import Meeting as FaceMeeting
from softway.contact.nodes_on_tool import NodesOnTool, ToolMeeting
from softway.contact.shear import Shear, tangents
from softway.contact.stencils import Stencils
from softway.typing import Array, IntArray

log = logging.getLogger(__name__)

OVERLAP = 1e-12
"""Depth at the start, relative to the coordinates, that is rounding."""


class Meeting(Protocol):
    """Surfaces that may touch in one slab."""

    @property
    def found(self) -> int:
        """Number of pairs that the search came up with."""
        ...

    def at(self, x: Array) -> Stencils:
        """Gaps and their derivatives at positions ``x`` (n, d)."""
        ...


class Surfaces(Protocol):
    """A method of contact between deformable surfaces, with the same rows all through a march."""

    @property
    def node(self) -> IntArray:
        """Slave node (m,) of each row."""
        ...

    def meet(self, x0: Array, x1: Array, reach: float) -> Meeting:
        """What may touch in a slab from positions ``x0`` to about ``x1`` (n, d), within ``reach`` [m]."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Encounters:
    """The contacts of a model.

    Parameters
    ----------
    methods
        How each pair of surfaces meets; a contact may have several.
    contact
        (m,) number of the contact of each row, in the order of the methods.
    points
        (n, d) reference positions of all nodes [m].
    reach
        Distance beyond the predicted motion within which surfaces are paired [m].
    labels
        Names of the contacts.
    watchers
        Nodes of either surface against the faces of the other, for contacts whose methods see mean gaps only: they
        tell how far surfaces overlap, and carry no force.
    watched
        Number of the contact of each watcher.
    known
        The rows, where one linear form serves everywhere and at all times: resting half-spaces without friction.
    rough
        Whether a contact has friction; rows then have their :class:`~softway.contact.shear.Shear`.
    clearance
        (m,) gaps from which rows are counted [m]: below zero where what stands for curved facets overlaps at the start
        though the surfaces do not; None where nothing does.
    """

    methods: tuple[NodesOnTool | Surfaces, ...]
    contact: IntArray
    points: Array
    reach: float
    labels: tuple[str, ...]
    watchers: tuple[Surfaces, ...] = ()
    watched: tuple[int, ...] = ()
    known: Candidates | None = None
    rough: bool = False
    clearance: Array | None = None

    @property
    def node(self) -> IntArray:
        """Slave node (m,) of each row."""
        return np.concatenate([np.zeros(0, int), *(m.node for m in self.methods)])

    @property
    def fixed(self) -> bool:
        """Whether the rows never change."""
        return self.known is not None

    @property
    def paired(self) -> bool:
        """Whether deformable surfaces meet, whose rows are searched for in every slab."""
        return not all(isinstance(m, NodesOnTool) for m in self.methods)

    def of(self, contact: int) -> slice:
        """Rows of one contact."""
        found = np.flatnonzero(self.contact == contact)
        return slice(int(found[0]), int(found[-1]) + 1) if len(found) else slice(0, 0)

    def meet(self, u0: Array, u1: Array, start: float, end: float) -> "Pairs":
        """The search for a slab between two times, from displacement ``u0`` to about ``u1`` (n, d)."""
        if self.known is not None:
            return Pairs(encounters=self, meetings=(), watching=(), node=self.node, known=self.known)
        x0, x1 = self.points + u0, self.points + u1
        found = tuple(
            m.during(start, end) if isinstance(m, NodesOnTool) else m.meet(x0, x1, self.reach) for m in self.methods
        )
        watching = tuple(w.meet(x0, x1, self.reach) for w in self.watchers)
        return Pairs(encounters=self, meetings=found, watching=watching, node=self.node, known=None)

    def settled(self) -> "Encounters":
        """The same, with the rows known once and for all where they never change."""
        if self.rough or not all(isinstance(m, NodesOnTool) and m.fixed for m in self.methods):
            return self
        still = np.zeros_like(self.points)
        return replace(self, known=self.rest(still, 0.0).at(still))

    def cleared(self, u: Array, apart: Sequence[bool]) -> "Encounters":
        """The same, with mean gaps that are negative at the displacement ``u`` (n, d) counted from there, in contacts
        that start ``apart`` (c,) and of which no node overlaps a face.
        """
        if not self.watchers:
            return self
        pairs, least = self.rest(u, 0.0), -OVERLAP * float(np.abs(self.points + u).max())
        gap = pairs.at(u).gap(u)
        deep = np.array(apart, bool)[self.contact] & (gap < least)
        if deep.any():
            watched = pairs.watch(u)
            deep &= np.isin(self.contact, np.setdiff1d(self.watched, watched.contact[watched.gap(u) < least]))
        if not deep.any():
            return self
        log.info(
            "%d contact rows overlap at the start, by %.3g m at most: counted from there", deep.sum(), -gap[deep].min()
        )
        return replace(self, clearance=np.where(deep, gap, 0.0))

    def rest(self, u: Array, time: float) -> "Pairs":
        """The pairs of a body that does not move."""
        return self.meet(u, u, time, time)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Pairs:
    """What may touch in one slab; ``known`` are the rows where they are the same everywhere."""

    encounters: Encounters
    meetings: tuple[Meeting, ...]
    watching: tuple[Meeting, ...]
    node: IntArray
    known: Candidates | None

    @property
    def found(self) -> int:
        """Pairs of a node, facet or edge and its opponent that the search came up with."""
        return len(self.node) if self.known is not None else sum(m.found for m in self.meetings)

    def start(self, u: Array) -> Candidates:
        """The rows at the start of the slab, at the displacement ``u`` (n, d) there."""
        if self.known is not None:
            return self.known
        first = tuple(m.opening() if isinstance(m, ToolMeeting) else m for m in self.meetings)
        return replace(self, meetings=first).at(u)

    def at(self, u: Array) -> Candidates:
        """The rows at the end of the slab, exact in value and derivative at the displacement ``u`` (n, d)."""
        if self.known is not None:
            return self.known
        rows, clearance = self._rows(self.meetings, u, self.node, self.encounters.contact), self.encounters.clearance
        return rows if clearance is None else replace(rows, offset=rows.offset - clearance)

    def held(self, u: Array, before: "Pairs | None" = None) -> "Pairs":
        """The same with faces and edges kept as at the displacement ``u`` (n, d), and those kept ``before``."""
        x = self.encounters.points + u
        old = self.meetings if before is None else before.meetings
        kept = tuple(
            held(m, x, o if isinstance(o, Held | HeldEdges) else None)
            if isinstance(m, FaceMeeting | EdgeMeeting)
            else m
            for m, o in zip(self.meetings, old, strict=True)
        )
        return replace(self, meetings=kept)

    def overlap(self, u: Array) -> float:
        """Greatest depth at the displacement ``u`` (n, d) [m]; negative where nothing touches."""
        rows = self.at(u)
        return -float(rows.gap(u)[rows.near].min(initial=np.inf))

    def watch(self, u: Array) -> Candidates:
        """Rows that tell every overlap of nodes with faces, at the displacement ``u`` (n, d)."""
        if not self.watching:
            return self.at(u)
        encounters = self.encounters
        tools = [m for m in self.meetings if isinstance(m, ToolMeeting)]
        numbers = [encounters.contact[i] for i in self._tool_rows()]
        nodes = [w.node for w in encounters.watchers]
        numbers += [np.full(len(n), k) for n, k in zip(nodes, encounters.watched, strict=True)]
        nodes = [m.node for m in tools] + nodes
        return self._rows((*tools, *self.watching), u, np.concatenate(nodes), np.concatenate(numbers))

    def _tool_rows(self) -> list[slice]:
        """Rows of the methods against tools."""
        ends = np.cumsum([len(m.node) for m in self.encounters.methods])
        return [
            slice(int(end) - len(m.node), int(end))
            for m, end in zip(self.encounters.methods, ends, strict=True)
            if isinstance(m, NodesOnTool)
        ]

    def _rows(self, meetings: tuple[Meeting, ...], u: Array, node: IntArray, contact: IntArray) -> Candidates:
        x = self.encounters.points + u
        found = [m.at(x) for m in meetings]
        d = x.shape[1]
        normal = np.concatenate([np.zeros((0, d)), *(s.normal for s in found)])
        gradient = sp.vstack([sp.csr_array((0, x.size)), *(s.gradient() for s in found)], format="csr")
        gap = np.concatenate([np.zeros(0), *(s.gap for s in found)])
        drive = [
            m.drive(x, s.normal) if isinstance(m, ToolMeeting) else np.zeros(len(s.gap))
            for m, s in zip(meetings, found, strict=True)
        ]
        return Candidates(
            node=node,
            contact=contact,
            normal=normal,
            gradient=sp.csr_array(gradient),
            offset=gap - gradient @ u.ravel(),
            drive=np.concatenate([np.zeros(0), *drive]),
            labels=self.encounters.labels,
            shear=_shear(meetings, found, x, normal) if self.encounters.rough else None,
        )


def _shear(meetings: tuple[Meeting, ...], found: list[Stencils], x: Array, normal: Array) -> Shear:
    """The rows along the surfaces at positions ``x`` (n, d), with normals (m, d)."""
    moved = [
        m.moved(x) if isinstance(m, ToolMeeting) else np.zeros_like(s.normal)
        for m, s in zip(meetings, found, strict=True)
    ]
    weights = sp.vstack([sp.csr_array((0, len(x))), *(s.weights for s in found)], format="csr")
    return Shear(
        weights=sp.csr_array(weights),
        tangents=tangents(normal),
        moved=np.concatenate([np.zeros((0, x.shape[1])), *moved]),
    )
