"""From the declared contacts to the methods by which their surfaces meet."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from softway.bodies.part import Part
from softway.bodies.solid import Solid, Tool
from softway.contact.contact import Contact, DualMortar, NodeToSurface
from softway.contact.edges import EdgesOnEdges
from softway.contact.encounters import Encounters, Surfaces
from softway.contact.mortar import Mortar
from softway.contact.nodes_on_faces import NodesOnFaces
from softway.contact.nodes_on_tool import NodesOnTool
from softway.contact.roughness import rubbing
from softway.contact.rubbing import Rubbing
from softway.contact.side import Edges, Side, outward
from softway.contact.timing import Energy
from softway.errors import InputError, within
from softway.typing import Array, IntArray

REACH = 1.0
"""Distance, in mean edges of the coarser surface, within which surfaces are paired before a slab."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Pairing:
    """The contacts of a model.

    Parameters
    ----------
    encounters
        Methods and rows.
    opponents
        (contacts, 2) numbers of the two solids of each contact; -1 for a tool.
    nodes
        (k,) nodes of the model that may touch something.
    rubbing
        Friction of the rows; None where no contact has any.
    """

    encounters: Encounters
    opponents: IntArray
    nodes: IntArray
    rubbing: Rubbing | None


def pairing(contacts: Sequence[Contact], bodies: Mapping[str, Solid | Tool], parts: Sequence[Part]) -> Pairing:
    """Who meets whom, and how.

    Raises
    ------
    InputError
        With the place from ``contacts[k]`` on: unknown bodies, tags that hold no surface, a name given twice.
    """
    points = np.concatenate([p.mesh.points for p in parts])
    methods: list[NodesOnTool | Surfaces] = []
    number, opponents, nodes = [np.zeros(0, int)], [], [np.zeros(0, int)]
    sizes = [0.0]
    watchers: list[Surfaces] = []
    watched: list[int] = []
    for k, contact in enumerate(contacts):
        _check_shape(contact, bodies, points)
        with within(f"contacts[{k}]"):
            found, pair, touched, surfaces = _methods(contact, bodies, parts, points)
        methods += found
        if any(isinstance(m, Mortar) for m in found):
            fine, coarse = surfaces
            watchers += [_on(fine.side.nodes, fine, coarse), _on(coarse.side.nodes, coarse, fine)]
            watched += [k, k]
        number.append(np.full(sum(len(m.node) for m in found), k))
        opponents.append(pair)
        nodes.append(touched)
        sizes += [s.edge for s in surfaces]
    encounters = Encounters(
        methods=tuple(methods),
        contact=np.concatenate(number),
        points=points,
        reach=REACH * max(sizes),
        labels=_labels(contacts),
        watchers=tuple(watchers),
        watched=tuple(watched),
        rough=not all(c.friction.frictionless for c in contacts),
    )
    return Pairing(
        encounters=encounters.settled(),
        opponents=np.array(opponents, int).reshape(-1, 2),
        nodes=np.unique(np.concatenate(nodes)),
        rubbing=rubbing(contacts, methods, number[1:], parts),
    )


def _check_shape(contact: Contact, bodies: Mapping[str, Solid | Tool], points: Array) -> None:
    """Refuse a tool of another dimension than the solids."""
    tool = bodies.get(contact.opponent)
    if isinstance(tool, Tool):
        with within(f"bodies.{contact.opponent}.shape"):
            tool.shape.gap(points[:1])


def _labels(contacts: Sequence[Contact]) -> tuple[str, ...]:
    """The names of the contacts, each given once."""
    labels = tuple(c.label for c in contacts)
    for k, label in enumerate(labels):
        if label in labels[:k]:
            raise InputError(f"contacts[{k}].name", f"'{label}' is the name of an earlier contact", "a name of its own")
    return labels


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Surface:
    """A deformable surface with its sharp features at the reference positions, and its mean edge [m]."""

    side: Side
    corners: IntArray
    edges: Edges | None
    edge: float


def _methods(
    contact: Contact, bodies: Mapping[str, Solid | Tool], parts: Sequence[Part], points: Array
) -> tuple[list[NodesOnTool | Surfaces], tuple[int, int], IntArray, list[_Surface]]:
    """Methods of one contact, its two solids, its nodes, and its deformable surfaces, the finer one first."""
    one = _part(parts, contact.body, "between")
    names = [p.name for p in parts]
    tool = bodies.get(contact.opponent)
    if isinstance(tool, Tool):
        if contact.method is not None and not isinstance(contact.method, NodeToSurface):
            raise InputError("method", f"{contact.method} against a tool", "NodeToSurface, or nothing")
        with within("between"):
            nodes = one.mesh.nodes(contact.tag) + one.rows.start
        return [NodesOnTool(node=nodes, tool=tool)], (names.index(one.name), -1), nodes, []
    other = _part(parts, contact.opponent, "between")
    if other is one:
        raise InputError("between", f"{one.name!r} against itself", "two bodies")
    found = [_surface(one, contact.tag, points), _surface(other, contact.opponent_tag, points)]
    fine, coarse = sorted(found, key=lambda s: s.edge)
    nodes = np.concatenate([s.side.nodes for s in found])
    pair = names.index(one.name), names.index(other.name)
    return _between(contact, fine, coarse, points.shape[1]), pair, nodes, [fine, coarse]


def _between(contact: Contact, fine: _Surface, coarse: _Surface, dim: int) -> list[NodesOnTool | Surfaces]:
    """How two solids meet: the finer surface is the slave; sharp features of the coarser one have rows of their own."""
    located = not isinstance(contact.timing, Energy)
    method = contact.method or (NodeToSurface() if dim == 1 or located else DualMortar())
    found: list[NodesOnTool | Surfaces]
    if isinstance(method, NodeToSurface):
        found = [
            _on(fine.side.nodes, fine, coarse),
            _on(coarse.side.nodes if method.nodes == "both" else coarse.corners, coarse, fine),
        ]
    elif dim == 1 or located:
        problem = f"DualMortar with {contact.timing}" if located else "DualMortar between bars in 1D"
        raise InputError("method", problem, "NodeToSurface, or nothing")
    else:
        found = [Mortar(slave_facets=fine.side.facets, master_facets=coarse.side.facets)]
        found += [_on(fine.corners, fine, coarse), _on(coarse.corners, coarse, fine)]
    found = [m for m in found if len(m.node)]
    if fine.edges is not None and coarse.edges is not None and len(fine.edges.ends) and len(coarse.edges.ends):
        found.append(EdgesOnEdges(first=fine.edges, second=coarse.edges))
    return found


def _on(nodes: IntArray, own: _Surface, surface: _Surface) -> NodesOnFaces:
    """Nodes (k,) of their ``own`` surface against the faces of another one."""
    return NodesOnFaces(slaves=nodes, side=surface.side, own=own.side)


def _surface(part: Part, tag: str, points: Array) -> _Surface:
    """The boundary facets of a tag, in the numbering of the model."""
    with within("between"):
        facets = part.mesh.facets_on(tag)
        if not facets:
            raise InputError("", f"tag {tag!r} of {part.name!r} holds no whole facet", "a tag that covers a surface")
    first = part.rows.start
    dim = points.shape[1]
    bars = np.concatenate([c[:, :2] for c in part.mesh.blocks.values()])
    ends = outward(bars, facets["point1"]) if "point1" in facets else np.zeros(0)
    side = Side(facets={name: f + first for name, f in facets.items()}, ends=ends)
    if dim == 1:
        return _Surface(side=side, corners=np.zeros(0, int), edges=None, edge=part.mesh.edge())
    lengths = np.linalg.norm(points[side.table[:, 1]] - points[side.table[:, 0]], axis=1)
    edges = side.sharp_edges(points) if dim == 3 else None
    corners = side.sharp_corners(points) if edges is None else np.unique(edges.ends)
    return _Surface(side=side, corners=corners, edges=edges, edge=float(lengths.mean()))


def _part(parts: Sequence[Part], name: str, where: str) -> Part:
    for part in parts:
        if part.name == name:
            return part
    raise InputError(where, f"no solid '{name}'", f"one of {[p.name for p in parts]}")
