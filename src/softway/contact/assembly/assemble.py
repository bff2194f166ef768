"""Assembly of contacts: the contact methods of all contacts of a model, with their friction."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.assembled.vector_space import VectorSpace
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.rigid_motion import RigidShape
from softway.bodies.solid import Solid, Tool
from softway.contact.assembly.body_surface import BodySurface, body_surface, covered, finer_first, part_named
from softway.contact.assembly.each_with_each import Nodes, each_with_each
from softway.contact.assembly.friction import assemble_friction
from softway.contact.assembly.methods import ContactMethods, of_two, with_tool
from softway.contact.contact import Contact
from softway.contact.contact_set import ContactSet
from softway.contact.friction_rows import FrictionRows
from softway.contact.surfaces.boundary import ContactSurface
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
    solids
        Numbers of the solids of each contact.
    rigid
        (contacts,) True for contacts with a tool or a rigid body.
    nodes
        (k,) nodes of the model that may come into contact.
    friction
        Friction laws of the rows.
    """

    contacts: ContactSet
    solids: tuple[tuple[int, ...], ...]
    rigid: BoolArray
    nodes: IntArray
    friction: FrictionRows


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Joined:
    """Surfaces that ties glue to each other.

    Parameters
    ----------
    sealed
        Covered facets: cell name -> (f, b) nodes of the model.
    neighbours
        (n, n) pattern of nodes that move together, and of each node with itself.
    """

    sealed: Mapping[str, IntArray]
    neighbours: sp.csr_array


def assemble_contacts(
    contacts: Sequence[Contact],
    bodies: Mapping[str, Body],
    parts: Sequence[DiscreteSolid],
    space: VectorSpace,
    joined: Joined | None = None,
    slaves: Mapping[int, str] = MappingProxyType({}),
) -> ContactAssembly:
    """Assemble the contact methods and friction laws of contacts, see
    :func:`~softway.contact.assembly.declared.resolved`.

    ``slaves`` are the solids whose surfaces are the slaves of some contacts, by number; those of the others are the
    finer ones.

    Raises
    ------
    InputError
        If a body is unknown, a tag contains no facet, or a name is given twice; the place begins with ``contacts[k]``.
    """
    points = np.concatenate([p.mesh.points for p in parts])
    given = _Given(contacts=contacts, bodies=bodies, parts=parts, points=points, joined=joined, slaves=slaves)
    thickness, found = _thickness(given), []
    for k, contact in enumerate(contacts):
        _check_shape(contact, bodies, points)
        with within(f"contacts[{k}]"):
            found.append(_methods(k, contact, given, thickness))
    number = [np.full(f.rows, k) for k, f in enumerate(found)]
    methods = tuple(method for f in found for method in f.methods)
    row_contact = np.concatenate([np.zeros(0, int), *number])
    frictionless = all(c.friction.frictionless for c in contacts)
    contact_set = ContactSet(
        methods=methods,
        contact=row_contact,
        points=points,
        reach=REACH * max((edge for f in found for edge in f.edges), default=0.0),
        labels=_labels(contacts),
        overlap_methods=tuple(method for f in found for method in f.overlap),
        overlap_contact=tuple(k for k, f in enumerate(found) for _ in f.overlap),
        frictionless_rows=TangentialRows.none(len(row_contact), *points.shape) if frictionless else None,
        space=space,
        margins=tuple(f.margin for f in found),
    )
    names = [p.name for p in parts]
    return ContactAssembly(
        contacts=contact_set.with_known_rows(),
        solids=tuple(tuple(sorted({names.index(n) for n in c.bodies if n in names})) for c in contacts),
        rigid=np.array([given.tool(c) is not None for c in contacts], bool),
        nodes=np.unique(np.concatenate([np.zeros(0, int), *(f.nodes for f in found)])),
        friction=assemble_friction(contacts, methods, number, parts),
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Given:
    """Contacts, the bodies and meshes of a scene, and its reference positions ``points`` (n, d) [m]."""

    contacts: Sequence[Contact]
    bodies: Mapping[str, Body]
    parts: Sequence[DiscreteSolid]
    points: Array
    joined: Joined | None
    slaves: Mapping[int, str]

    def tool(self, contact: Contact) -> Tool | RigidShape | None:
        """Tool or rigid body of a contact."""
        body = None if contact.many else self.bodies.get(contact.opponent)
        return body if isinstance(body, Tool | RigidShape) else None

    def surfaces(self, contact: Contact) -> list[BodySurface]:
        """Surfaces of the solids of a contact."""
        sealed = None if self.joined is None else self.joined.sealed
        return [body_surface(self.parts, name, tag, self.points, sealed) for name, tag in contact.surfaces]

    def buried(self, part: DiscreteSolid) -> IntArray:
        """Nodes (k,) of the model that are on covered facets of a solid only."""
        if self.joined is None:
            return np.zeros(0, int)
        inside, outside = [np.zeros(0, int)], [np.zeros(0, int)]
        for kind, facets in part.mesh.boundary().items():
            found = facets + part.nodes.start
            under = covered(found, kind, self.joined.sealed)
            inside.append(found[under].ravel())
            outside.append(found[~under].ravel())
        return np.setdiff1d(np.concatenate(inside), np.concatenate(outside))


def _methods(number: int, contact: Contact, given: _Given, thickness: Array) -> ContactMethods:
    """Methods of the contact of a number."""
    tool = given.tool(contact)
    if tool is not None:
        part = given.parts[part_named(given.parts, contact.body, "between")]
        return with_tool(contact, part, tool, given.buried(part))
    surfaces = given.surfaces(contact)
    if not contact.many:
        _require_apart(contact, surfaces, given.joined)
        return of_two(contact, *_slave_first(contact, surfaces, given.slaves.get(number)), thickness, given.points)
    own = [given.surfaces(c) for c in given.contacts if not c.many and given.tool(c) is None]
    body = np.repeat(np.arange(len(given.parts)), [p.mesh.n_nodes for p in given.parts])
    glue = None if given.joined is None else given.joined.neighbours
    nodes = Nodes(points=given.points, body=body, thickness=thickness, glue=glue)
    return each_with_each(contact, surfaces, own, nodes)


def _slave_first(
    contact: Contact, surfaces: Sequence[BodySurface], slave: str | None
) -> tuple[BodySurface, BodySurface]:
    """The slave of two surfaces, which is that of the solid ``slave`` or else the finer one, and the other one."""
    one, two = surfaces
    if slave is None or len(set(contact.bodies)) == 1:
        return finer_first(one, two)
    return (one, two) if contact.bodies[0] == slave else (two, one)


def _require_apart(contact: Contact, surfaces: Sequence[BodySurface], joined: Joined | None) -> None:
    """Refuse a contact of two surfaces that a tie glues together at their rims."""
    if joined is None:
        return
    one, two = (s.side.nodes for s in surfaces)
    if joined.neighbours[one][:, two].nnz:
        problem = f"{contact.names[0]!r} and {contact.names[1]!r} meet at a tie"
        raise InputError("between", problem, '"all", which leaves neighbours out')


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


def _thickness(given: _Given) -> Array:
    """Thickness (n,) of the solids that may touch one another behind their surface nodes [m]."""
    met = {name for c in given.contacts if given.tool(c) is None for name in c.bodies}
    walls = [
        ContactSurface(facets={kind: f + part.nodes.start for kind, f in part.mesh.boundary().items()})
        for part in given.parts
        if part.name in met and part.mesh.dim > 1
    ]
    return nodal_thickness(given.points, walls)
