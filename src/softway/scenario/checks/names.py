"""Checks of the references in a scenario: bodies, tags, components, dimensions."""

import json
from collections.abc import Iterable, Mapping, Sequence
from math import isfinite

from softway.bodies.discretised import free_components
from softway.bodies.elements.section import check_section
from softway.bodies.setup.initial_fields import components, sample
from softway.bodies.setup.loads import Gravity, Load, Traction
from softway.bodies.solid import Solid, Tool
from softway.contact.assembly.tie import Tie
from softway.contact.contact import Contact
from softway.errors import InputError, within
from softway.mechanisms.members.rigid import Rigid
from softway.meshes.mesh import Mesh
from softway.scenario.checks.scales import section_of
from softway.scenario.hints.type_hints import nearest
from softway.scenario.scenario import Body


def mesh_of(solid: Solid) -> Mesh:
    """Mesh of a solid whose mesh has been built."""
    if not isinstance(solid.mesh, Mesh):
        raise TypeError("the mesh has not been built: call softway.scenario.built.built first")
    return solid.mesh


def solid_named(bodies: Mapping[str, Body], name: str, where: str) -> Solid:
    """Deformable body with a given name."""
    solids = [n for n, b in bodies.items() if isinstance(b, Solid)]
    if name not in bodies:
        raise InputError(where, f"there is no body {name!r}", nearest(name, solids))
    body = bodies[name]
    if not isinstance(body, Solid):
        raise InputError(where, f"{name!r} is a {type(body).__name__}, which has no nodes", nearest(name, solids))
    return body


def check_names(bodies: Iterable[str]) -> None:
    """Refuse names of bodies that no contact, load or probe could name, or that no line could show."""
    for name in bodies:
        if not name.strip() or "." in name or not name.isprintable():
            problem = f"{name!r:.60} cannot be the name of a body"
            raise InputError("bodies", problem, "letters, digits and blanks; a dot stands between a body and its tag")


def check_contact(bodies: Mapping[str, Body], contact: Contact, where: str) -> None:
    """Refuse a contact with unknown bodies or tags, with a tool in the first place, or with a tag of a tool."""
    path, names = f"{where}.between", list(contact.names)
    if contact.between != "all" and len(names) < 2:
        remedy = f'two names or more: {_listed(names * 2)} for a body with itself, or "all"'
        raise InputError(path, f"{_listed(names)} has one name" if names else "it is empty", remedy)
    for name, body_name in zip(names, contact.bodies, strict=True):
        body = bodies.get(body_name)
        if body is None:
            others = [n for n in bodies if len(names) > 2 or n not in contact.bodies]
            raise InputError(path, f"there is no body {body_name!r}", nearest(body_name, others))
        if isinstance(body, Tool | Rigid) and name != body_name:
            problem = f"{name!r}: a {type(body).__name__} has no tags"
            raise InputError(path, problem, f"its name: {_listed([body_name if n == name else n for n in names])}")
        if isinstance(body, Rigid) and body.shape is None:
            remedy = f"bodies.{body_name}.shape, a surface at the place of the body"
            raise InputError(path, f"{body_name!r} has no surface", remedy)
    _check_solids(bodies, contact, path)


def _listed(names: Sequence[str]) -> str:
    """List of names as a scenario has it."""
    return json.dumps(list(names))


def _check_solids(bodies: Mapping[str, Body], contact: Contact, path: str) -> None:
    """Refuse a contact without a solid, with a tool before the solid, or with unknown tags."""
    kinds = [type(bodies[name]) for name in contact.bodies]
    if kinds and Solid not in kinds:
        solid_named(bodies, contact.body, path)
    if len(kinds) == 2 and kinds[0] is not Solid:
        problem = f"{contact.body!r} is a {kinds[0].__name__}, which has no nodes"
        raise InputError(path, problem, f"the solid first: {_listed(contact.names[::-1])}")
    for name, tag in zip(contact.bodies, contact.tags, strict=True):
        body = bodies[name]
        if isinstance(body, Solid):
            with within(path):
                mesh_of(body).nodes(tag)


def check_density(density: float | Mapping[str, float], where: str) -> None:
    """Refuse a density that is not positive, of the body or of a region."""
    if isinstance(density, Mapping):
        for region, one in density.items():
            check_density(one, f"{where}.{region}")
    elif not (isfinite(density) and density > 0.0):
        raise InputError(where, f"{density:g} kg/m^3 is not positive", 'a density such as "7850 kg/m^3"')


def check_dimensions(bodies: Mapping[str, Body], solids: Mapping[str, Solid]) -> None:
    """Refuse bodies and obstacles of different space dimensions."""
    first = next(iter(solids))
    dim = mesh_of(solids[first]).dim
    for name, solid in solids.items():
        if mesh_of(solid).dim != dim:
            problem = f"a mesh in {mesh_of(solid).dim}D together with {first!r} in {dim}D"
            raise InputError(f"bodies.{name}.mesh", problem, "all bodies in the same space")
    for name, body in bodies.items():
        if isinstance(body, Rigid) and body.dim != dim:
            problem = f"a Rigid in {body.dim}D together with {first!r} in {dim}D"
            raise InputError(f"bodies.{name}.centre", problem, f"{dim} coordinates")
        if isinstance(body, Tool) and body.shape.dim != dim:
            problem = f"{type(body.shape).__name__} in {body.shape.dim}D together with {first!r} in {dim}D"
            raise InputError(f"bodies.{name}.shape", problem, f"{dim} coordinates")


def check_solid(solid: Solid, where: str) -> None:
    """Check section, initial fields and supports."""
    mesh = mesh_of(solid)
    with within(where):
        check_section(mesh, section_of(solid, mesh))
    for name in ("velocity", "displacement"):
        with within(f"{where}.{name}"):
            sample(getattr(solid, name), mesh)
    with within(where):
        free_components(solid.supports, mesh)


def check_loads(loads: tuple[Load, ...], where: str, solids: Mapping[str, Solid]) -> None:
    """Refuse loads of a wrong dimension, or on unknown bodies or tags."""
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
                raise InputError(f"{path}.on", f"{load.on!r} contains no whole facet", "a tag that covers a surface")


def check_ties(bodies: Mapping[str, Body], ties: tuple[Tie, ...]) -> None:
    """Refuse ties of bodies that are no solids, or of unknown tags, and a second tie of the same surfaces."""
    for k, tie in enumerate(ties):
        path = f"ties[{k}].between"
        if sorted(tie.between) in [sorted(t.between) for t in ties[:k]]:
            raise InputError(path, f"{list(tie.between)} have a tie already", "a single tie for two surfaces")
        for name in tie.between:
            body, _, tag = name.partition(".")
            mesh = mesh_of(solid_named(bodies, body, path))
            with within(path):
                mesh.nodes(tag)


def check_contacts(contacts: tuple[Contact, ...]) -> None:
    """Refuse different timing rules, two contacts with the same name, and two contacts of the same surfaces."""
    for k, contact in enumerate(contacts):
        if contact.timing != contacts[0].timing:
            problem = f"{contact.timing} differs from {contacts[0].timing} of contacts[0]"
            raise InputError(f"contacts[{k}].timing", problem, "the same timing rule for all contacts")
        if contact.label in [c.label for c in contacts[:k]]:
            raise InputError(f"contacts[{k}].name", f"{contact.label!r} is already in use", "another name")
        pairs = [_surfaces(c) for c in contacts[:k]]
        if _surfaces(contact) in pairs:
            first = pairs.index(_surfaces(contact))
            problem = f"{list(contact.names) or 'all'} are also the surfaces of contacts[{first}]"
            raise InputError(f"contacts[{k}].between", problem, "a single contact: it checks both surfaces")


def _surfaces(contact: Contact) -> tuple[tuple[str, str], ...]:
    return tuple(sorted(zip(contact.bodies, contact.tags, strict=True)))
