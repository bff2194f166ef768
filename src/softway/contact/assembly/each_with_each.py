"""One contact method for many surfaces: all their nodes against all their facets, and in space edges against edges."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.assembly.body_surface import BodySurface
from softway.contact.assembly.methods import ContactMethods, margin_of
from softway.contact.contact import Contact, NodeToSurface
from softway.contact.node_to_surface.admissible_pairs import AdmissiblePairs, Members
from softway.contact.node_to_surface.edge_to_edge import EdgeToEdge
from softway.contact.node_to_surface.node_to_facet import NodeToFacet
from softway.contact.node_to_surface.split_facets import OnSplitSurface, SplitSurface
from softway.contact.stencils import SurfacePair
from softway.contact.surfaces.boundary import ContactSurface
from softway.errors import InputError
from softway.laws.friction_law import FrictionLaw


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Nodes:
    """Nodes: reference positions (n, d) [m], number (n,) of the solid and thickness (n,) behind each [m], and pattern
    (n, n) of those that ties move together.
    """

    points: Array
    body: IntArray
    thickness: Array
    glue: sp.csr_array | None


FLAT = {"tri3", "quad4"}
"""Kinds of facets with straight edges."""
SLOTS = 4
"""Rows of each edge: an edge over a quadrilateral crosses two of its diagonals and two of its edges."""


def each_with_each(
    contact: Contact, surfaces: Sequence[BodySurface], own: Sequence[Sequence[BodySurface]], nodes: Nodes
) -> ContactMethods:
    """Contact of the ``surfaces`` of a contact; one that the contact names twice may touch itself.

    ``own`` are the pairs of surfaces that have contacts of their own.

    Raises
    ------
    InputError
        If mortar, an impact rule with mass at contact nodes, or a friction law that needs the area of each row is asked
        for.
    """
    if contact.method is not None and not isinstance(contact.method, NodeToSurface):
        raise InputError(
            "method",
            f"{contact.method} for {contact.label!r}",
            "NodeToSurface, or a contact of two surfaces for each mortar",
        )
    if not contact.timing.massless:
        raise InputError("timing", f"{contact.timing} for {contact.label!r}", "Energy, or contacts of two solids")
    if not _follows_pressure(contact.friction):
        problem = f"{type(contact.friction).__name__} for {contact.label!r}, whose rows of both sides share the surface"
        raise InputError("friction", problem, "a law in proportion to the pressure, or contacts of two solids")
    side, meet = _joined([s.side for s in surfaces]), _meetings(contact)
    pairs = AdmissiblePairs(
        points=nodes.points,
        body=nodes.body,
        side=side,
        members=_members(surfaces, meet, side, len(nodes.body)),
        glue=nodes.glue,
        apart=tuple(_members(two, ~np.eye(2, dtype=bool), side, len(nodes.body)) for two in own),
    )
    found = _on_flat_facets(pairs, nodes.thickness) if set(side.facets) <= FLAT else _on_facets(pairs, nodes.thickness)
    lengths, margin = tuple(s.edge for s in surfaces), margin_of(surfaces, meet)
    return ContactMethods(methods=found, nodes=side.nodes, edges=lengths, margin=margin)


def _on_facets(pairs: AdmissiblePairs, thickness: Array) -> tuple[SurfacePair, ...]:
    """Nodes on facets and, in space, sharp edges on sharp edges."""
    side = pairs.side
    nodes = NodeToFacet(slaves=side.nodes, side=side, own=side, thickness=thickness, admissible=pairs)
    if side.dim < 3:
        return (nodes,)
    edges = side.sharp_edges(pairs.points)
    return (nodes, EdgeToEdge(first=edges, second=edges, admissible=pairs, thickness=thickness))


def _on_flat_facets(pairs: AdmissiblePairs, thickness: Array) -> tuple[SurfacePair, ...]:
    """Nodes on triangles and edges on all edges of triangles, of quadrilaterals split about their centres."""
    split = SplitSurface(given=pairs.side, count=len(pairs.points))
    quads, side = split.quads, split.side
    of_nodes = [np.concatenate([v, v[quads].all(axis=1)]) for v in (m.nodes for m in (pairs.members, *pairs.apart))]
    members = [
        Members(nodes=nodes, facets=split.of_facets(m.facets), meet=m.meet)
        for nodes, m in zip(of_nodes, (pairs.members, *pairs.apart), strict=True)
    ]
    body = np.concatenate([pairs.body, pairs.body[quads[:, 0]]])
    flat = AdmissiblePairs(
        points=split.positions(pairs.points), body=body, side=side, members=members[0], apart=tuple(members[1:])
    )
    wall = np.concatenate([thickness, thickness[quads].min(axis=1)])
    nodes = NodeToFacet(slaves=pairs.side.nodes, side=side, own=side, thickness=wall, admissible=flat, over=True)
    every = side.edges()
    own = np.asarray((every.ends < split.count).all(axis=1))
    first = every.subset(own)
    second = first.joined(every.subset(~own))
    edges = EdgeToEdge(first=first, second=second, admissible=flat, thickness=wall, slots=SLOTS)
    return tuple(OnSplitSurface(method=m, surface=split) for m in (nodes, edges))


def _follows_pressure(law: FrictionLaw) -> bool:
    """True for laws in proportion to the pressure: how two-sided rows share the surface makes no difference to them."""
    pressure, speed = np.array([1.0, 2.0]), np.ones(2)
    values = law.limit(pressure), law.resistance(speed, pressure)[0]
    return all(abs(two - 2.0 * one) <= 1e-9 * abs(two) for one, two in values)


def _meetings(contact: Contact) -> BoolArray:
    """Which surfaces (k, k) of a contact may touch each other."""
    given = list(zip(contact.bodies, contact.tags, strict=True))
    meet = ~np.eye(len(contact.surfaces), dtype=bool)
    np.fill_diagonal(meet, [given.count(surface) > 1 for surface in contact.surfaces])
    return meet


def _joined(sides: Sequence[ContactSurface]) -> ContactSurface:
    """All facets of some surfaces, each once."""
    kinds = dict.fromkeys(kind for side in sides for kind in side.facets)
    facets = {kind: np.concatenate([s.facets[kind] for s in sides if kind in s.facets]) for kind in kinds}
    ends = np.concatenate([s.ends for s in sides])
    first = {kind: np.sort(np.unique(np.sort(f, axis=1), axis=0, return_index=True)[1]) for kind, f in facets.items()}
    return ContactSurface(
        facets={kind: f[first[kind]] for kind, f in facets.items()}, ends=ends[first["point1"]] if len(ends) else ends
    )


def _members(surfaces: Sequence[BodySurface], meet: BoolArray, side: ContactSurface, nodes: int) -> Members:
    """Nodes and facets of the side that belong to each of the surfaces."""
    return Members(
        nodes=np.stack([np.isin(np.arange(nodes), s.side.nodes) for s in surfaces], axis=1),
        facets=np.stack([_among(side, s.side) for s in surfaces], axis=1),
        meet=meet,
    )


def _among(side: ContactSurface, other: ContactSurface) -> BoolArray:
    """True for facets (f,) of a side that another one has, too."""
    found = []
    for kind, facets in side.facets.items():
        rows = np.sort(np.concatenate([facets, other.facets.get(kind, facets[:0])]), axis=1)
        number = np.unique(rows, axis=0, return_inverse=True)[1].ravel()
        found.append(np.isin(number[: len(facets)], number[len(facets) :]))
    return np.concatenate(found)
