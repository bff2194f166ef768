"""Initial state of a march: as given, or in static equilibrium, with massless nodes relaxed."""

import logging

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.assembled import material_states
from softway.bodies.assembled.nodal_loads import dead_load
from softway.bodies.assembled.rigid_body_modes import HeldParts, free_motions
from softway.bodies.elements.section import Axisymmetric
from softway.contact.assembly.declared import at_declared
from softway.contact.contact import NodeToSurface
from softway.errors import Cancel, InputError
from softway.marching.results.trying import TryWatch, watched
from softway.marching.start.initial_overlap import deepest, shrunk
from softway.marching.state.model_state import ModelState
from softway.model.field import in_states
from softway.model.model import Model
from softway.model.scene import StaticStart
from softway.solve.effort import Effort
from softway.solve.equations.slab_values import SlabStart
from softway.solve.static.static_equilibrium import (
    InitialFriction,
    InitialSlip,
    NoInitialSlip,
    StaticState,
    equilibrium,
    fitted,
)
from softway.tolerances import DEPTH

log = logging.getLogger(__name__)

SOON = 1e-6
"""Time interval from which the initial velocity of a driven tool is computed [s]."""
DEEPEST = 0.85
"""Greatest depth of a press fit between solids, relative to the distance within which surfaces are paired; of nodes and
facets, relative to the shortest edge at the deepest node: deeper ones may be paired with the wrong facets."""
TOGETHER = 1e-7
"""Relative velocity of surfaces at the start, relative to the greatest speed, that is rounding."""


def initial_state(
    model: Model, span: float = 1.0, cancel: Cancel | None = None, trying: TryWatch | None = None
) -> ModelState:
    """State at t = 0; path-dependent materials reach their initial displacement in one slab of length ``span`` [s].

    Raises
    ------
    InputError
        If a body overlaps an obstacle, or a static start leaves rigid motions free.
    Cancelled
        If ``cancel`` requests it at an iteration of an equilibrium.
    """
    model = model.during((), span)
    with at_declared(model.declared):
        rest = _resting(model, cancel, Effort(tell=watched(trying)))
    return _at_rest(model, rest, span)


def without_contact(model: Model, span: float = 1.0) -> ModelState:
    """State at the given displacement, at t = 0, without forces of contacts: it has the sizes of all states."""
    model = model.during((), span)
    return _at_rest(model, StaticState.apart(model.displacement, len(model.contacts.contact)), span)


def _at_rest(model: Model, rest: StaticState, span: float) -> ModelState:
    """State at t = 0 with the initial velocities."""
    u, pressure = rest.displacement, rest.pressure
    energy, force = model.energy_and_force(u)
    states = material_states.committed(model.parts, u)
    fields = tuple(c.at(c.initial(), u) for c in in_states(model.companions, states))
    return ModelState(
        time=0.0,
        start=SlabStart(
            displacement=u,
            velocity=model.velocity + model.prescribed(0.0),
            force=sum((f.force for f in fields), force),
            energy=sum((f.energy for f in fields), material_states.stored_energy(model.parts, states, energy)),
            states=states,
            viscous=material_states.stored_viscous_force(model.parts, states),
            fields=fields,
        ),
        acceleration=np.zeros(model.shape),
        closed=pressure > 0.0,
        pressure=pressure,
        traction=rest.traction,
        sliding=rest.sliding,
        rigid=None if model.rigid is None else model.rigid.start(span),
    )


def _resting(model: Model, cancel: Cancel | None, effort: Effort) -> StaticState:
    """Initial static state: in equilibrium if requested, with massless nodes relaxed."""
    u, count = model.displacement, len(model.contacts.contact)
    rest = StaticState.apart(u, count)
    require_apart(model, u)
    require_shallow(model, u)
    friction: InitialFriction = NoInitialSlip() if model.friction.frictionless else _passing(model, u)
    start, loads = model.scene.start, model.load
    require_supported(model)
    if isinstance(start, StaticStart):
        loads = dead_load(model.parts, model.weight, start.loads, "start.loads").at(0.0) if start.loads else model.load
    fits = any(c.start == "fit" for c in model.scene.contacts)
    if fits or (isinstance(start, StaticStart) and unsupported_motions(model)):
        apart = shrunk(model, u, DEPTH * model.extent(u))
        rest = fitted(
            model,
            u,
            model.dofs,
            loads,
            apart,
            friction=NoInitialSlip() if fits else friction,
            cancel=cancel,
            effort=effort,
        )
    elif isinstance(start, StaticStart):
        rest = equilibrium(model, u, model.dofs, loads, friction=friction, cancel=cancel, effort=effort)
    if model.timing.massless and not model.space.every(model.massive):
        before = float(model.energy_and_force(rest.displacement)[0].sum())
        light = model.dofs.only(~model.massive)
        rest = equilibrium(model, rest.displacement, light, model.load, friction=friction, cancel=cancel, effort=effort)
        after = float(model.energy_and_force(rest.displacement)[0].sum())
        if before != after:
            log.info("relaxing the contact nodes at the start releases %.3g J of %.3g J", before - after, before)
    return rest


def _passing(model: Model, u: Array) -> InitialSlip:
    """Friction with the initial velocities: slipping rows have the force of slip, the others stick."""
    shear = model.contacts.meet(u, u, 0.0, SOON).at(u).shear
    velocity = model.velocity + model.prescribed(0.0)
    passing = shear.slip(SOON * velocity) / SOON
    most = max(model.space.greatest(velocity), float(np.abs(shear.moved).max(initial=0.0)) / SOON)
    moves = np.linalg.norm(passing, axis=1) > TOGETHER * most
    return InitialSlip(reference=u, velocity=np.where(moves[:, None], passing, 0.0))


def unsupported_motions(model: Model) -> dict[str, tuple[str, ...]]:
    """Rigid motions that the supports leave free, of each solid or of several with common unknowns, by the first."""
    found = {}
    for group in np.unique(model.linked):
        together = [p for p, of in zip(model.parts, model.linked, strict=True) if of == group]
        axisymmetric = isinstance(together[0].internal.section, Axisymmetric)
        points = np.concatenate([p.mesh.points for p in together])
        nodes = np.concatenate([np.arange(model.shape[0])[p.nodes] for p in together])
        motions = free_motions(points, _held_parts(model, nodes), axisymmetric)
        if motions:
            found[together[0].name] = motions
    return found


def _held_parts(model: Model, nodes: IntArray) -> HeldParts:
    """Parts (n, d) of fields (n, d) of some nodes that supports hold."""

    def held(field: Array) -> Array:
        whole = np.zeros(model.shape)
        whole[nodes] = field
        return model.supported(whole)[nodes]

    return held


def require_supported(model: Model) -> None:
    """Refuse free rigid motions of bodies without inertia, and in a static start of bodies without contacts."""
    inert = not model.scene.inertia.factor > 0.0
    if not inert and not isinstance(model.scene.start, StaticStart):
        return
    met = {name for c in model.scene.contacts for name in c.bodies}
    what = "body without inertia" if inert else "static start"
    otherwise = 'inertia = { kind = "Full" }' if inert else 'a contact, or start = "AsGiven"'
    for name, motions in unsupported_motions(model).items():
        if inert or name not in met:
            raise InputError(
                f"bodies.{name}.supports",
                f"the supports leave free: {', '.join(motions)}; no {what}",
                f'sufficient supports, such as {{ on = "left" }}, {otherwise}',
            )


def require_apart(model: Model, u: Array) -> None:
    """Refuse a start inside an opponent; the message names both bodies, depth and position."""
    found = deepest(model, u, DEPTH * model.extent(u))
    if found is None:
        return
    place, depth = ", ".join(f"{x:.6g}" for x in found.place), f"{found.depth:.6g} m"
    move = f"move a body out by {depth} (bodies.{found.body}.place.translation or .bottom)"
    raise InputError(
        f"contacts[{found.contact}].between",
        f"{found.body!r} starts {depth} inside {found.other!r}: node {found.node} at ({place}) m",
        f'{move}, or start = "fit" for a press fit',
    )


def require_shallow(model: Model, u: Array) -> None:
    """Refuse a press fit of two solids in the plane or in space that is about as deep as their cells, or deeper."""
    found = deepest(model, u, DEPTH * model.extent(u), "fit")
    if found is None or model.shape[1] == 1 or model.against_tool[found.contact]:
        return
    x, names = model.points + u, [p.name for p in model.parts]
    other = model.parts[names.index(found.other)].nodes
    opposite = other.start + int(((x[other] - np.array(found.place)) ** 2).sum(axis=1).argmin())
    node = model.parts[names.index(found.body)].nodes.start + found.node
    by_nodes = isinstance(model.scene.contacts[found.contact].method, NodeToSurface)
    edge = float(min(model.edge[node], model.edge[opposite])) if by_nodes else model.contacts.reach
    if found.depth > DEEPEST * edge:
        raise InputError(
            f"contacts[{found.contact}].start",
            f"'fit' with {found.body!r} {found.depth:.6g} m inside {found.other!r}, in cells of {edge:.6g} m",
            f"cells of {found.depth / DEEPEST:.3g} m or more at the contact, or bodies that start apart and are "
            'pressed together by supports of kind = "Driven"',
        )
