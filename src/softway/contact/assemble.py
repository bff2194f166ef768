"""Assembly of contacts: the contact methods of all declared contacts, with their friction."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.assembled.vector_space import VectorSpace
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.rigid_motion import RigidShape
from softway.bodies.solid import Solid, Tool
from softway.contact.contact import Contact, DualMortar, NodeToSurface
from softway.contact.contact_set import ContactSet, SurfacePair
from softway.contact.friction_rows import AreaPatch, FrictionRows, surfaces_of
from softway.contact.mortar.mortar import Mortar
from softway.contact.node_to_surface.edge_to_edge import EdgeToEdge
from softway.contact.node_to_surface.node_to_facet import NodeToFacet
from softway.contact.node_to_surface.node_to_tool import NodeToTool
from softway.contact.surfaces.boundary import ContactSurface, Edges, outward
from softway.contact.surfaces.wall_thickness import nodal_thickness
from softway.contact.tangential_rows import TangentialRows
from softway.errors import InputError, within

Body = Solid | Tool | RigidShape

REACH = 1.0
"""Distance, in mean edges of the coarser surface, within which surfaces are paired before a slab."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ContactAssembly:
    """The contacts of a model.

    Parameters
    ----------
    contacts
        Contact methods and rows.
    opponents
        (contacts, 2) numbers of the two solids of each contact; -1 for a tool.
    nodes
        (k,) nodes of the model that may come into contact.
    friction
        Friction laws of the rows.
    """

    contacts: ContactSet
    opponents: IntArray
    nodes: IntArray
    friction: FrictionRows


def assemble_contacts(
    contacts: Sequence[Contact], bodies: Mapping[str, Body], parts: Sequence[DiscreteSolid], space: VectorSpace
) -> ContactAssembly:
    """Assemble the contact methods and friction laws of the declared contacts.

    Raises
    ------
    InputError
        If a body is unknown, a tag contains no facet, or a name is given twice; the place begins with ``contacts[k]``.
    """
    points = np.concatenate([p.mesh.points for p in parts])
    thickness = _thickness(contacts, parts, points)
    methods: list[NodeToTool | SurfacePair] = []
    number, opponents, nodes = [np.zeros(0, int)], [], [np.zeros(0, int)]
    sizes, frictionless = [0.0], all(c.friction.frictionless for c in contacts)
    overlap: list[tuple[SurfacePair, int]] = []
    for k, contact in enumerate(contacts):
        _check_shape(contact, bodies, points)
        with within(f"contacts[{k}]"):
            found, pair, touched, surfaces = _methods(contact, bodies, parts, points, thickness)
        methods += found
        if any(isinstance(m, Mortar) for m in found):
            turns = zip(surfaces, reversed(surfaces), strict=True)
            overlap += [(_on(one.side.nodes, one, other, thickness), k) for one, other in turns]
        number.append(np.full(sum(len(m.node) for m in found), k))
        opponents.append(pair)
        nodes.append(touched)
        sizes += [s.edge for s in surfaces]
    row_contact = np.concatenate(number)
    contact_set = ContactSet(
        methods=tuple(methods),
        contact=row_contact,
        points=points,
        reach=REACH * max(sizes),
        labels=_labels(contacts),
        overlap_methods=tuple(method for method, _ in overlap),
        overlap_contact=tuple(k for _, k in overlap),
        frictionless_rows=TangentialRows.none(len(row_contact), *points.shape) if frictionless else None,
        space=space,
    )
    return ContactAssembly(
        contacts=contact_set.with_fixed_rows(),
        opponents=np.array(opponents, int).reshape(-1, 2),
        nodes=np.unique(np.concatenate(nodes)),
        friction=assemble_friction(contacts, methods, number[1:], parts),
    )


def assemble_friction(
    contacts: Sequence[Contact],
    methods: Sequence[NodeToTool | SurfacePair],
    number: Sequence[IntArray],
    parts: Sequence[DiscreteSolid],
) -> FrictionRows:
    """Assemble the friction laws of all rows.

    Arguments: the methods of all contacts in order, and the number ``k`` of each contact, repeated for its rows.

    Raises
    ------
    InputError
        If a contact of bars has friction: their ends have no tangential direction.
    """
    contact = np.concatenate([np.zeros(0, int), *number])
    laws = tuple(c.friction for c in contacts)
    if all(law.frictionless for law in laws):
        return FrictionRows(laws=laws, contact=contact, area=np.ones(len(contact)))
    if parts[0].mesh.dim == 1:
        raise InputError("contacts[0].friction", "friction in 1D", "a mesh of two or three dimensions")
    patches, start = [], 0
    for method in methods:
        rows = np.arange(start, start + len(method.node))
        k = int(contact[start]) if len(method.node) else 0
        beside = any(isinstance(m, Mortar) for m in _of(contact, methods, k)) and not isinstance(method, Mortar)
        if not beside and len(rows):
            patches.append(AreaPatch(rows=rows, node=method.node, surfaces=surfaces_of(contacts[k], parts)))
        start += len(rows)
    none = np.zeros(sum(p.mesh.n_nodes for p in parts) * parts[0].mesh.dim).reshape(-1, parts[0].mesh.dim)
    rough = FrictionRows(laws=laws, contact=contact, area=np.ones(len(contact)), patches=tuple(patches))
    return rough.at(none)


def _of(contact: IntArray, methods: Sequence[NodeToTool | SurfacePair], k: int) -> list[NodeToTool | SurfacePair]:
    """Methods of a contact."""
    starts = np.cumsum([0, *(len(m.node) for m in methods)])[:-1]
    return [m for m, s in zip(methods, starts, strict=True) if len(m.node) and contact[s] == k]


def _check_shape(contact: Contact, bodies: Mapping[str, Body], points: Array) -> None:
    """Refuse a tool whose dimension differs from that of the solids."""
    tool = bodies.get(contact.opponent)
    if isinstance(tool, Tool | RigidShape):
        with within(f"bodies.{contact.opponent}.shape"):
            tool.shape.gap(points[:1])


def _labels(contacts: Sequence[Contact]) -> tuple[str, ...]:
    """Names of the contacts; each may be given only once."""
    labels = tuple(c.label for c in contacts)
    for k, label in enumerate(labels):
        if label in labels[:k]:
            raise InputError(f"contacts[{k}].name", f"'{label}' is the name of an earlier contact", "another name")
    return labels


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Surface:
    """Deformable surface with its sharp corners and edges at the reference positions, and its mean edge length [m]."""

    side: ContactSurface
    corners: IntArray
    edges: Edges | None
    edge: float


def _thickness(contacts: Sequence[Contact], parts: Sequence[DiscreteSolid], points: Array) -> Array:
    """Thickness (n,) of the solids that may touch one another behind their surface nodes [m]."""
    names = {part.name for part in parts}
    met = {name for c in contacts if c.opponent in names for name in (c.body, c.opponent)}
    walls = [
        ContactSurface(facets={kind: f + part.nodes.start for kind, f in part.mesh.boundary().items()})
        for part in parts
        if part.name in met and part.mesh.dim > 1
    ]
    return nodal_thickness(points, walls)


def _methods(
    contact: Contact,
    bodies: Mapping[str, Body],
    parts: Sequence[DiscreteSolid],
    points: Array,
    thickness: Array,
) -> tuple[list[NodeToTool | SurfacePair], tuple[int, int], IntArray, list[_Surface]]:
    """Methods of one contact, its two solids, its nodes, and its deformable surfaces, the finer one first."""
    one = _part(parts, contact.body, "between")
    names = [p.name for p in parts]
    tool = bodies.get(contact.opponent)
    if isinstance(tool, Tool | RigidShape):
        if contact.method is not None and not isinstance(contact.method, NodeToSurface):
            raise InputError("method", f"{contact.method} against a tool", "NodeToSurface, or nothing")
        with within("between"):
            nodes = one.mesh.nodes(contact.tag) + one.nodes.start
        return [NodeToTool(node=nodes, tool=tool, name=contact.opponent)], (names.index(one.name), -1), nodes, []
    other = _part(parts, contact.opponent, "between")
    if other is one:
        raise InputError("between", f"{one.name!r} against itself", "two bodies")
    found = [_surface(one, contact.tag, points), _surface(other, contact.opponent_tag, points)]
    fine, coarse = sorted(found, key=lambda s: s.edge)
    nodes = np.concatenate([s.side.nodes for s in found])
    pair = names.index(one.name), names.index(other.name)
    return _between(contact, fine, coarse, thickness), pair, nodes, [fine, coarse]


def _between(contact: Contact, fine: _Surface, coarse: _Surface, thickness: Array) -> list[NodeToTool | SurfacePair]:
    """Contact methods between two solids: the finer surface is the slave; sharp corners and edges have own rows."""
    located, dim = not contact.timing.massless, fine.side.dim
    method = contact.method or (NodeToSurface() if dim == 1 or located else DualMortar())
    found: list[NodeToTool | SurfacePair]
    if isinstance(method, NodeToSurface):
        found = [
            _on(fine.side.nodes, fine, coarse, thickness),
            _on(coarse.side.nodes if method.nodes == "both" else coarse.corners, coarse, fine, thickness),
        ]
    elif dim == 1 or located:
        problem = f"DualMortar with {contact.timing}" if located else "DualMortar between bars in 1D"
        raise InputError("method", problem, "NodeToSurface, or nothing")
    else:
        found = [Mortar(slave_facets=fine.side.facets, master_facets=coarse.side.facets, thickness=thickness)]
        found += [_on(fine.corners, fine, coarse, thickness), _on(coarse.corners, coarse, fine, thickness)]
    found = [m for m in found if len(m.node)]
    if fine.edges is not None and coarse.edges is not None and len(fine.edges.ends) and len(coarse.edges.ends):
        found.append(EdgeToEdge(first=fine.edges, second=coarse.edges))
    return found


def _on(nodes: IntArray, own: _Surface, surface: _Surface, thickness: Array) -> NodeToFacet:
    """Contact of nodes (k,) of the surface ``own`` with the facets of another surface."""
    return NodeToFacet(slaves=nodes, side=surface.side, own=own.side, thickness=thickness)


def _surface(part: DiscreteSolid, tag: str, points: Array) -> _Surface:
    """Boundary facets of a tag, in the node numbers of the model."""
    with within("between"):
        facets = part.mesh.facets_on(tag)
        if not facets:
            raise InputError("", f"tag {tag!r} of {part.name!r} contains no whole facet", "a tag that covers a surface")
    first = part.nodes.start
    dim = points.shape[1]
    bars = np.concatenate([c[:, :2] for c in part.mesh.blocks.values()])
    ends = outward(bars, facets["point1"]) if "point1" in facets else np.zeros(0)
    side = ContactSurface(facets={name: f + first for name, f in facets.items()}, ends=ends)
    if dim == 1:
        return _Surface(side=side, corners=np.zeros(0, int), edges=None, edge=part.mesh.edge())
    lengths = np.linalg.norm(points[side.table[:, 1]] - points[side.table[:, 0]], axis=1)
    edges = side.sharp_edges(points) if dim == 3 else None
    corners = side.sharp_corners(points) if edges is None else np.unique(edges.ends)
    return _Surface(side=side, corners=corners, edges=edges, edge=float(lengths.mean()))


def _part(parts: Sequence[DiscreteSolid], name: str, where: str) -> DiscreteSolid:
    for part in parts:
        if part.name == name:
            return part
    raise InputError(where, f"no solid '{name}'", f"one of {[p.name for p in parts]}")
