"""Contacts of a rank: all rows, on the local numbers of the nodes that may touch, of which every rank has copies."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from softway.arrays import Array, IntArray
from softway.cluster.cells.rank_mesh import local_nodes
from softway.contact.contact_set import ContactSet
from softway.contact.friction_rows import AreaPatch, DeclaredSurface, FrictionRows
from softway.contact.mortar.mortar import Mortar
from softway.contact.node_to_surface.admissible_pairs import AdmissiblePairs, Members
from softway.contact.node_to_surface.edge_to_edge import EdgeToEdge
from softway.contact.node_to_surface.node_to_facet import NodeToFacet
from softway.contact.node_to_surface.node_to_tool import NodeToTool
from softway.contact.node_to_surface.split_facets import OnSplitSurface, SplitSurface
from softway.contact.surfaces.boundary import ContactSurface, Edges
from softway.contact.surfaces.search_margin import SearchMargin
from softway.contact.tangential_rows import TangentialRows
from softway.model.model import Model
from softway.ranks.partition import Holding
from softway.ranks.space import RankSpace

METHODS = NodeToTool, NodeToFacet, EdgeToEdge, Mortar, OnSplitSurface
"""Methods of contact that have local numbers."""


def served(method: object) -> bool:
    """True if a method has local numbers."""
    return isinstance(method, METHODS)


def rank_contacts(contacts: ContactSet, held: Holding, space: RankSpace) -> ContactSet:
    """Contacts of a rank, all of whose methods are :func:`served`."""
    methods = tuple(_method(m, held) for m in contacts.methods if isinstance(m, METHODS))
    overlap = tuple(_method(m, held) for m in contacts.overlap_methods if isinstance(m, METHODS))
    points, rows = contacts.points[held.nodes], contacts.frictionless_rows
    found = replace(
        contacts,
        methods=methods,
        overlap_methods=overlap,
        margins=tuple(None if m is None else _margin(m, held) for m in contacts.margins),
        points=points,
        frictionless_rows=None if rows is None else TangentialRows.none(len(contacts.contact), *points.shape),
        space=space,
    )
    return replace(found, known=None, known_rows=None).with_known_rows()


def rank_friction(model: Model, held: Holding) -> FrictionRows:
    """Friction of the rows of a rank."""
    patches = tuple(_patch(patch, held) for patch in model.friction.patches)
    return replace(model.friction, patches=patches)


def _patch(patch: AreaPatch, held: Holding) -> AreaPatch:
    """Surfaces of rows on local nodes."""
    surfaces = tuple(rank_surface(surface, held) for surface in patch.surfaces)
    return replace(patch, node=held.local(patch.node), surfaces=surfaces)


def rank_surface(surface: DeclaredSurface, held: Holding) -> DeclaredSurface:
    """Declared surface with the local nodes of its solid."""
    own = local_nodes(surface.nodes, held)
    numbers = held.nodes[own] - surface.nodes.start
    facets = {kind: numbers.searchsorted(nodes) for kind, nodes in surface.facets.items()}
    return replace(surface, nodes=own, points=surface.points[numbers], facets=facets)


def _method(method: Any, held: Holding) -> Any:
    """Method on local nodes."""
    if isinstance(method, NodeToTool):
        return replace(method, node=held.local(method.node))
    if isinstance(method, NodeToFacet):
        own = None if method.own is None else _surface(method.own, held)
        return replace(
            method,
            slaves=held.local(method.slaves),
            side=_surface(method.side, held),
            own=own,
            thickness=_nodal(method.thickness, held),
            admissible=_admissible(method.admissible, held),
        )
    if isinstance(method, EdgeToEdge):
        first, second = (_edges(edges, held) for edges in (method.first, method.second))
        pairs, wall = _admissible(method.admissible, held), _nodal(method.thickness, held)
        return replace(method, first=first, second=second, thickness=wall, admissible=pairs)
    if isinstance(method, OnSplitSurface):
        given, (total, count) = method.surface.given, method.surface.means.shape
        centred = replace(held, nodes=np.concatenate([held.nodes, np.arange(count, total)]))
        surface = SplitSurface(given=_surface(given, held), count=len(held.nodes))
        return replace(method, method=_method(method.method, centred), surface=surface)
    return replace(
        method,
        slave_facets=_facets(method.slave_facets, held),
        master_facets=_facets(method.master_facets, held),
        thickness=_nodal(method.thickness, held),
        points=_nodal(method.points, held),
    )


def _admissible(pairs: AdmissiblePairs | None, held: Holding) -> AdmissiblePairs | None:
    """Pairs that may touch, on local nodes; no tie moves any of them."""
    if pairs is None:
        return None
    assert pairs.glue is None
    return AdmissiblePairs(
        points=pairs.points[held.nodes],
        body=pairs.body[held.nodes],
        side=_surface(pairs.side, held),
        members=_members(pairs.members, held),
        apart=tuple(_members(members, held) for members in pairs.apart),
        whole=None if pairs.whole is None else held.local(pairs.whole),
    )


def _members(members: Members, held: Holding) -> Members:
    """Surfaces that may touch each other, on local nodes."""
    return replace(members, nodes=members.nodes[held.nodes])


def _facets(facets: Mapping[str, IntArray], held: Holding) -> dict[str, IntArray]:
    """Facets on local nodes."""
    return {kind: held.local(nodes) for kind, nodes in facets.items()}


def _surface(surface: ContactSurface, held: Holding) -> ContactSurface:
    """Surface on local nodes."""
    return replace(surface, facets=_facets(surface.facets, held))


def _edges(edges: Edges, held: Holding) -> Edges:
    """Edges on local nodes."""
    return replace(edges, ends=held.local(edges.ends), wings=held.local(edges.wings))


def _margin(margin: SearchMargin, held: Holding) -> SearchMargin:
    """Margin of surfaces on local nodes."""
    return replace(margin, sides=tuple(_surface(side, held) for side in margin.sides))


def _nodal(field: Array | None, held: Holding) -> Array | None:
    """Field of local nodes; None without."""
    return None if field is None else field[held.nodes]
