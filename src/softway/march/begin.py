"""The first situation of a march: as described, in static equilibrium, and with massless nodes relaxed."""

import logging
from dataclasses import replace

import numpy as np

from softway.bodies import past
from softway.bodies.dead_load import dead_load
from softway.bodies.rigid_motions import free_motions
from softway.bodies.section import Axisymmetric
from softway.contact.encounters import OVERLAP
from softway.contact.timing import Energy
from softway.errors import Cancel, InputError
from softway.march.overlap import deepest, shrunk
from softway.march.situation import Situation
from softway.model import Model
from softway.scene import StaticStart
from softway.solve.equilibrium import Grip, Rest, equilibrium, fitted
from softway.solve.values import Start
from softway.typing import Array

log = logging.getLogger(__name__)

SOON = 1e-6
"""Time in which a driven tool shows its velocity at the start [s]."""
TOGETHER = 1e-7
"""Share of the greatest speed below which surfaces move along together at the start: rounding."""


def begin(model: Model, span: float = 1.0, cancel: Cancel | None = None) -> Situation:
    """The situation at t = 0; matter with a history has come to its initial displacement in one slab of length
    ``span`` [s].

    Raises
    ------
    InputError
        If a body overlaps an obstacle (named with the depth), or a static start leaves rigid motions free.
    Cancelled
        If ``cancel`` says so at an iteration of an equilibrium.
    """
    model = model.during((), span)
    rest = _resting(model, cancel)
    u, pressure = rest.displacement, rest.pressure
    energy, force = model.energy_and_force(u)
    memory = past.settled(model.parts, u)
    return Situation(
        time=0.0,
        start=Start(
            displacement=u,
            velocity=model.velocity + model.prescribed(0.0),
            force=force,
            energy=past.stored(model.parts, memory, energy),
            memory=memory,
            viscous=past.remembered_viscous(model.parts, memory),
        ),
        acceleration=np.zeros(model.shape),
        closed=pressure > 0.0,
        pressure=pressure,
        traction=rest.traction,
        sliding=rest.sliding,
    )


def _resting(model: Model, cancel: Cancel | None) -> Rest:
    """Where the march starts, in equilibrium as far as is asked for, and with massless nodes relaxed."""
    u, count = model.displacement, len(model.encounters.contact)
    rest = Rest(displacement=u, pressure=np.zeros(count))
    require_apart(model, u)
    grip = None if model.rubbing is None else _passing(model, u)
    start, loads = model.scene.start, model.load
    require_supported(model)
    if isinstance(start, StaticStart):
        loads = dead_load(model.parts, model.weight, start.loads, "start.loads").at(0.0) if start.loads else model.load
    fits = any(c.start == "fit" for c in model.scene.contacts)
    if fits or (isinstance(start, StaticStart) and unheld(model)):
        apart = shrunk(model, u, OVERLAP * _reach(model, u))
        rest = fitted(model, u, model.free, loads, apart, grip=None if fits else grip, cancel=cancel)
    elif isinstance(start, StaticStart):
        rest = equilibrium(model, u, model.free, loads, grip=grip, cancel=cancel)
    if isinstance(model.timing, Energy) and not model.massive.all():
        before = float(model.energy_and_force(rest.displacement)[0].sum())
        light = model.free & ~model.massive[:, None]
        rest = equilibrium(model, rest.displacement, light, model.load, grip=grip, cancel=cancel)
        after = float(model.energy_and_force(rest.displacement)[0].sum())
        if before != after:
            log.info("relaxing the contact nodes at the start releases %.3g J of %.3g J", before - after, before)
    if grip is None or rest.traction is not None:
        return rest
    return replace(rest, traction=np.zeros((count, model.shape[1])), sliding=np.zeros(count, bool))


def _passing(model: Model, u: Array) -> Grip:
    """Friction with the initial velocities: what slips has the force of slip, what does not is held where it is."""
    shear = model.encounters.meet(u, u, 0.0, SOON).at(u).shear
    assert shear is not None
    velocity = model.velocity + model.prescribed(0.0)
    passing = shear.slip(SOON * velocity) / SOON
    most = max(float(np.abs(velocity).max()), float(np.abs(shear.moved).max(initial=0.0)) / SOON)
    moves = np.linalg.norm(passing, axis=1) > TOGETHER * most
    return Grip(held=u, velocity=np.where(moves[:, None], passing, 0.0))


def unheld(model: Model) -> dict[str, tuple[str, ...]]:
    """Rigid motions that the supports of each solid leave free."""
    found = {}
    for part in model.parts:
        axisymmetric = isinstance(part.internal.section, Axisymmetric)
        motions = free_motions(part.mesh.points, ~model.free[part.rows], axisymmetric)
        if motions:
            found[part.name] = motions
    return found


def require_supported(model: Model) -> None:
    """Refuse bodies that are free where they must not be: of supports without inertia, of supports and contacts in a
    static start.
    """
    inert = not model.scene.inertia.factor > 0.0
    if not inert and not isinstance(model.scene.start, StaticStart):
        return
    met = {c.body for c in model.scene.contacts} | {c.opponent for c in model.scene.contacts}
    what = "body without inertia" if inert else "static start"
    otherwise = 'inertia = { kind = "Full" }' if inert else 'a contact, or start = "AsGiven"'
    for name, motions in unheld(model).items():
        if inert or name not in met:
            raise InputError(
                f"bodies.{name}.supports",
                f"the supports leave free: {', '.join(motions)}; no {what}",
                f'supports that hold it, such as {{ on = "left" }}, {otherwise}',
            )


def require_apart(model: Model, u: Array) -> None:
    """Refuse a start inside an opponent, naming both bodies, depth and place."""
    found = deepest(model, u, OVERLAP * _reach(model, u))
    if found is None:
        return
    place, depth = ", ".join(f"{x:.6g}" for x in found.place), f"{found.depth:.6g} m"
    move = f"move a body out by {depth} (bodies.{found.body}.place.translation or .bottom)"
    raise InputError(
        f"contacts[{found.contact}].between",
        f"{found.body!r} starts {depth} inside {found.other!r}: node {found.node} at ({place}) m",
        f'{move}, or start = "fit" for a press fit',
    )


def _reach(model: Model, u: Array) -> float:
    """Size of the coordinates [m], the unit of their rounding."""
    return max(float(np.abs(p.mesh.points + u[p.rows]).max()) for p in model.parts)
