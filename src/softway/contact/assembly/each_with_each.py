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
from softway.contact.node_to_surface.split_facets import OnSplitSurface, SplitSurface, first_corner
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


SLOTS = 4
"""Rows of each edge: an edge over a bilinear facet crosses two of its diagonals and two of its edges."""


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
    found = (_in_plane if side.dim < 3 else _in_space)(pairs, nodes.thickness)
    lengths, margin = tuple(s.edge for s in surfaces), margin_of(contact, surfaces, meet)
    return ContactMethods(methods=found, nodes=side.nodes, edges=lengths, margin=margin)


def _in_plane(pairs: AdmissiblePairs, thickness: Array) -> tuple[SurfacePair, ...]:
    """Nodes on facets."""
    side = pairs.side
    return (NodeToFacet(slaves=side.nodes, side=side, own=side, thickness=thickness, admissible=pairs),)


def _in_space(pairs: AdmissiblePairs, thickness: Array) -> tuple[SurfacePair, ...]:
    """Nodes on facets, linear ones as triangles, and edges on all edges of the triangles that make up the facets."""
    split = SplitSurface(given=pairs.side, count=len(pairs.points))
    wall = split.with_centres(thickness, _least)
    on_side, on_flat = _split_pairs(pairs, split)
    side, slaves = split.side, pairs.side.nodes
    nodes = NodeToFacet(slaves=slaves, side=side, own=side, thickness=wall, admissible=on_side, over=True)
    every = split.flat.edges()
    own = np.asarray((every.ends < split.count).all(axis=1))
    first = every.subset(own)
    second = first.joined(every.subset(~own))
    edges = EdgeToEdge(first=first, second=second, admissible=on_flat, thickness=wall, slots=SLOTS)
    return tuple(OnSplitSurface(method=m, surface=split) for m in (nodes, edges))


def _split_pairs(pairs: AdmissiblePairs, split: SplitSurface) -> tuple[AdmissiblePairs, AdmissiblePairs]:
    """Pairs of nodes with the facets for nodes of a split surface, and pairs of edges of its triangles."""
    given, found = (pairs.members, *pairs.apart), []
    of_nodes = [split.with_centres(m.nodes, _every) for m in given]
    for side, of_facets in ((split.side, split.of_facets), (split.flat, split.of_triangles)):
        facets = [of_facets(m.facets) for m in given]
        members = [Members(nodes=n, facets=f, meet=m.meet) for n, f, m in zip(of_nodes, facets, given, strict=True)]
        found.append(
            AdmissiblePairs(
                points=split.positions(pairs.points),
                body=split.with_centres(pairs.body, first_corner),
                side=side,
                members=members[0],
                apart=tuple(members[1:]),
                glue=None if pairs.glue is None else split.with_alone(pairs.glue),
                whole=split.whole,
            )
        )
    return found[0], found[1]


def _least(values: Array) -> Array:
    return np.asarray(values.min(axis=1))


def _every(values: BoolArray) -> BoolArray:
    return np.asarray(values.all(axis=1))


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
