"""Every name in a scenario that points at something else: bodies, tags, components, dimensions."""

from collections.abc import Iterable, Mapping
from math import isfinite

import numpy as np

from softway.bodies.fields import components, sample
from softway.bodies.loads import Gravity, Load, Traction
from softway.bodies.part import free_components
from softway.bodies.section import check_section
from softway.bodies.solid import Solid, Tool
from softway.contact.contact import Contact
from softway.errors import InputError, within
from softway.scenario.kinds import nearest
from softway.scenario.scales import section_of
from softway.scene import Scene
from softway.space.mesh import Mesh
from softway.typing import Array, BoolArray


def mesh_of(solid: Solid) -> Mesh:
    """The mesh of a solid whose mesh has been made."""
    if not isinstance(solid.mesh, Mesh):
        raise TypeError("the mesh has not been made: softway.scenario.scenario.built makes it")
    return solid.mesh


def solid_named(bodies: Mapping[str, Solid | Tool], name: str, where: str) -> Solid:
    """The deformable body of that name."""
    solids = [n for n, b in bodies.items() if isinstance(b, Solid)]
    if name not in bodies:
        raise InputError(where, f"there is no body {name!r}", nearest(name, solids))
    body = bodies[name]
    if not isinstance(body, Solid):
        raise InputError(where, f"{name!r} is a Tool, which has no nodes", nearest(name, solids))
    return body


def check_contact(bodies: Mapping[str, Solid | Tool], contact: Contact, where: str) -> None:
    """Refuse a contact of bodies or tags that do not exist, and one that names a tool first or by a tag."""
    path, (first, second) = f"{where}.between", contact.between
    opponent = bodies.get(contact.opponent)
    if isinstance(bodies.get(contact.body), Tool) and isinstance(opponent, Solid):
        raise InputError(
            path, f"{contact.body!r} is a Tool, which has no nodes", f'the solid first: ["{second}", "{first}"]'
        )
    solid_named(bodies, contact.body, path)
    if opponent is None:
        others = [n for n in bodies if n != contact.body]
        raise InputError(path, f"there is no body {contact.opponent!r}", nearest(contact.opponent, others))
    if isinstance(opponent, Tool) and second != contact.opponent:
        raise InputError(path, f"{second!r}: a Tool has no tags", f'its name: ["{first}", "{contact.opponent}"]')
    for name, tag in ((contact.body, contact.tag), (contact.opponent, contact.opponent_tag)):
        body = bodies[name]
        if isinstance(body, Solid):
            with within(f"{where}.between"):
                mesh_of(body).nodes(tag)


def entries(value: Iterable[float] | float, dim: int, where: str) -> Array:
    """A vector (d,), refused if it has another number of entries."""
    vector = np.atleast_1d(np.asarray(value, float))
    if vector.shape != (dim,):
        raise InputError(where, f"{vector.tolist()} has {vector.size} entries in {dim}D", f"{dim} numbers")
    return vector


def check_density(density: float, where: str) -> None:
    """Refuse a density that is not positive."""
    if not (isfinite(density) and density > 0.0):
        raise InputError(where, f"{density:g} kg/m^3 is not positive", 'a density such as "7850 kg/m^3"')


def check_dimensions(scene: Scene, solids: Mapping[str, Solid]) -> None:
    """Refuse bodies and obstacles that live in spaces of different dimension."""
    first = next(iter(solids))
    dim = mesh_of(solids[first]).dim
    for name, solid in solids.items():
        if mesh_of(solid).dim != dim:
            problem = f"a mesh in {mesh_of(solid).dim}D beside {first!r} in {dim}D"
            raise InputError(f"bodies.{name}.mesh", problem, "all bodies in the same space")
    for name, body in scene.bodies.items():
        if isinstance(body, Tool) and body.shape.dim != dim:
            problem = f"{type(body.shape).__name__} in {body.shape.dim}D beside {first!r} in {dim}D"
            raise InputError(f"bodies.{name}.shape", problem, f"{dim} coordinates")


def check_solid(solid: Solid, where: str) -> BoolArray:
    """Look at section, fields and supports; returns the supported components (n, d)."""
    mesh = mesh_of(solid)
    with within(where):
        check_section(mesh, section_of(solid, mesh))
    for name in ("velocity", "displacement"):
        with within(f"{where}.{name}"):
            sample(getattr(solid, name), mesh)
    with within(where):
        return ~free_components(solid.supports, mesh)


def check_loads(loads: tuple[Load, ...], where: str, solids: Mapping[str, Solid]) -> None:
    """Refuse loads of another dimension, or on what does not exist."""
    dim = mesh_of(next(iter(solids.values()))).dim
    for k, load in enumerate(loads):
        path = f"{where}[{k}]"
        if isinstance(load, Gravity):
            with within(path):
                load.vector(dim)
        elif isinstance(load, Traction):
            mesh = mesh_of(solid_named(solids, load.body, f"{path}.on"))
            with within(path):
                components("value", load.value, dim)
            with within(f"{path}.on"):
                covered = mesh.facets_on(load.tag)
            if not covered:
                raise InputError(f"{path}.on", f"{load.on!r} holds no whole facet", "a tag that covers a surface")


def check_contacts(contacts: tuple[Contact, ...]) -> None:
    """Refuse a second timing rule, a second contact of the same name, and one of the same two surfaces."""
    for k, contact in enumerate(contacts):
        if contact.timing != contacts[0].timing:
            problem = f"{contact.timing} beside {contacts[0].timing} of contacts[0]"
            raise InputError(f"contacts[{k}].timing", problem, "the same rule for all contacts of a scene")
        if contact.label in [c.label for c in contacts[:k]]:
            raise InputError(f"contacts[{k}].name", f"{contact.label!r} is taken", "another name")
        pairs = [_surfaces(c) for c in contacts[:k]]
        if _surfaces(contact) in pairs:
            first = pairs.index(_surfaces(contact))
            problem = f"{list(contact.between)} are the surfaces of contacts[{first}] too"
            raise InputError(f"contacts[{k}].between", problem, "one contact of them; both sides are looked at")


def _surfaces(contact: Contact) -> frozenset[tuple[str, str]]:
    return frozenset([(contact.body, contact.tag), (contact.opponent, contact.opponent_tag)])
