"""Contact methods of one contact: of a solid with a tool, or of two solids."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.rigid_motion import RigidShape
from softway.bodies.solid import Tool
from softway.contact.assembly.body_surface import BodySurface
from softway.contact.contact import Contact, DualMortar, NodeToSurface
from softway.contact.mortar.mortar import Mortar
from softway.contact.node_to_surface.edge_to_edge import EdgeToEdge
from softway.contact.node_to_surface.node_to_facet import NodeToFacet
from softway.contact.node_to_surface.node_to_tool import NodeToTool
from softway.contact.stencils import SurfacePair
from softway.contact.surfaces.search_margin import FRACTION, SearchMargin
from softway.errors import InputError, within
from softway.meshes.mesh import Mesh


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ContactMethods:
    """Methods of one contact.

    Parameters
    ----------
    methods
        They make the rows of the contact.
    nodes
        (k,) nodes that may touch.
    edges
        Mean lengths of the edges of its deformable surfaces, if they are searched [m].
    overlap
        Methods that detect the overlap of nodes, where the rows are mean gaps.
    margin
        Margin of the search in a slab.
    """

    methods: tuple[NodeToTool | SurfacePair, ...]
    nodes: IntArray
    edges: tuple[float, ...] = ()
    overlap: tuple[SurfacePair, ...] = ()
    margin: SearchMargin | None = None

    @property
    def rows(self) -> int:
        """Number of rows."""
        return sum(len(m.node) for m in self.methods)


def with_tool(contact: Contact, part: DiscreteSolid, tool: Tool | RigidShape, buried: IntArray) -> ContactMethods:
    """Nodes of a solid against a tool, without those ``buried`` (k,) in ties."""
    if contact.method is not None and not isinstance(contact.method, NodeToSurface):
        raise InputError("method", f"{contact.method} against a tool", "NodeToSurface, or nothing")
    with within("between"):
        nodes = np.setdiff1d(_outer(part.mesh, part.mesh.nodes(contact.tag)) + part.nodes.start, buried)
        if not len(nodes):
            raise InputError("", f"ties cover all nodes of {contact.names[0]!r}", "a tag of its free surface")
    return ContactMethods(methods=(NodeToTool(node=nodes, tool=tool, name=contact.opponent),), nodes=nodes)


def _outer(mesh: Mesh, nodes: IntArray) -> IntArray:
    """Nodes (k,) of a tag that are on the surface, if any are; bars have their nodes on the outside."""
    if mesh.dim == 1 or mesh.cell_dim < mesh.dim:
        return nodes
    found = np.intersect1d(nodes, mesh.nodes("surface"))
    return found if len(found) else nodes


def of_two(contact: Contact, fine: BodySurface, coarse: BodySurface, thickness: Array, points: Array) -> ContactMethods:
    """Contact of two solids: ``fine`` is the slave; sharp corners and edges have their own rows.

    ``thickness`` (n,) is that of the bodies behind the nodes, ``points`` (n, d) are the reference positions [m].
    """
    located, dim = not contact.timing.massless, fine.side.dim
    method = contact.method or (NodeToSurface() if dim == 1 or located else DualMortar())
    found: list[SurfacePair]
    overlap: tuple[SurfacePair, ...] = ()
    raised = 0.0
    if isinstance(method, NodeToSurface):
        found = [
            _on(fine.side.nodes, fine, coarse, thickness),
            _on(coarse.side.nodes if method.nodes == "both" else coarse.corners, coarse, fine, thickness),
        ]
    elif dim == 1 or located:
        problem = f"DualMortar with {contact.timing}" if located else "DualMortar between bars in 1D"
        raise InputError("method", problem, "NodeToSurface, or nothing")
    else:
        _require_no_common_node(contact, fine, coarse)
        sides = fine.side.facets, coarse.side.facets
        mortar = Mortar(slave_facets=sides[0], master_facets=sides[1], thickness=thickness, points=points)
        raised, found = mortar.greatest_height, [mortar]
        found += [_on(fine.corners, fine, coarse, thickness), _on(coarse.corners, coarse, fine, thickness)]
        overlap = (_on(fine.side.nodes, fine, coarse, thickness), _on(coarse.side.nodes, coarse, fine, thickness))
    found = [m for m in found if len(m.node)]
    if fine.edges is not None and coarse.edges is not None and len(fine.edges.ends) and len(coarse.edges.ends):
        found.append(EdgeToEdge(first=fine.edges, second=coarse.edges))
    nodes = np.concatenate([fine.side.nodes, coarse.side.nodes])
    edges, margin = (fine.edge, coarse.edge), margin_of(contact, (fine, coarse), ~np.eye(2, dtype=bool), raised)
    return ContactMethods(methods=tuple(found), nodes=nodes, edges=edges, overlap=overlap, margin=margin)


def _require_no_common_node(contact: Contact, one: BodySurface, other: BodySurface) -> None:
    """Refuse mortar between two surfaces of a body that adjoin each other."""
    if len(np.intersect1d(one.side.nodes, other.side.nodes)):
        problem = f"DualMortar between {contact.names[0]!r} and {contact.names[1]!r}, which have nodes in common"
        raise InputError("method", problem, "NodeToSurface, or surfaces that are apart from each other")


def margin_of(contact: Contact, surfaces: Sequence[BodySurface], meet: BoolArray, raised: float = 0.0) -> SearchMargin:
    """Margin of the search of surfaces that may ``meet`` (k, k), which touch when their facets are ``raised`` [m] apart
    at most.  Where heat passes the gap it is a whole edge.
    """
    fraction = 1.0 if contact.heat is not None and contact.heat.crosses_gaps else FRACTION
    distance = fraction * max(s.edge for s in surfaces) + raised
    return SearchMargin(distance=distance, sides=tuple(s.side for s in surfaces), meet=meet, raised=raised)


def _on(nodes: IntArray, own: BodySurface, surface: BodySurface, thickness: Array) -> NodeToFacet:
    """Contact of nodes (k,) of the surface ``own`` with the facets of another surface."""
    return NodeToFacet(slaves=nodes, side=surface.side, own=own.side, thickness=thickness)
