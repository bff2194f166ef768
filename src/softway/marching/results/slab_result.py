"""Result of a contact rule for one slab (time step): solution and contact events, as arrays."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from softway.arrays import Array, BoolArray
from softway.bodies.assembled.following_nodes import reactions
from softway.contact.contact_rows import ContactRows
from softway.contact.slab_motion.trajectory import Trajectory, bent
from softway.marching.results.friction_result import FrictionResult
from softway.marching.results.step import Event
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.model.slab import Slab
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.equations.slab_values import Evaluation
from softway.solve.methods.iteration import Solution

EnergyBalance = Literal["closed", "bounded", "limited", "free"]
"""Requirement on the energy balance of a slab."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Balances:
    """Balances that an accepted slab must satisfy.

    Parameters
    ----------
    energy
        ``closed``: the energy balance closes up to rounding; ``bounded``: the energy does not grow more than in a
        stable slab; ``limited``: nor in all slabs together, and hardly in one; ``free``: no requirement.
    momentum
        True if the momentum balance closes.
    """

    energy: EnergyBalance = "free"
    momentum: bool = True


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SlabResult:
    """A solved slab.

    Parameters
    ----------
    system, solution
        The equations and their solution.
    rows
        Contact rows at the end of the slab.
    velocity, acceleration
        (n, d) at the end of the slab.
    closed, pressure
        (m,) contact rows that touch at the end, and their normal force there [N].
    force
        (m,) normal force over the slab, impulse / h [N].
    push, support
        (n, d) mean forces of contact and of supports on the nodes [N].
    work
        Work of driven tools and supports [J].
    dissipation
        Energy lost in velocity jumps [J].
    events
        Touches and releases, and rows that stick or slip.
    pairs
        Number of pairs that the search found.
    passes
        Number of solutions of the slab.
    iterations
        Total number of iterations.
    required
        Balances that the slab must satisfy.
    handed_on
        Contact rows for the start of the next slab, if a search might find others; None if the search finds the same
        rows.
    friction
        Friction over the slab.
    """

    system: SlabEquations
    solution: Solution
    rows: ContactRows
    velocity: Array
    acceleration: Array
    closed: BoolArray
    pressure: Array
    force: Array
    push: Array
    support: Array
    work: float
    dissipation: float
    events: tuple[Event, ...]
    pairs: int
    iterations: int
    required: Balances
    friction: FrictionResult
    passes: int = 1
    handed_on: ContactRows | None = None


def supports(model: Model, now: ModelState, end: Evaluation, velocity: Array, push: Array, span: float) -> Array:
    """Mean force (n, d) of the supports on the nodes [N]; ``push`` (n, d) is that of contact."""
    if model.space.every(model.dofs.unsupported):
        return np.zeros(model.shape)
    inertia = model.mass @ ((velocity - now.start.velocity) / span)
    force = inertia + end.mean_force - model.slab_load(end.scalar) - push
    return reactions(model.dofs, force)


def support_work(model: Model, path: Trajectory, support: Array, moved: Array, velocity: Array) -> float:
    """Work of the mean forces ``support`` (n, d) over the displacement ``moved`` (n, d) of a slab [J].

    The part of the forces that accelerates the supported nodes does its work over the mean of the velocities at the
    ends, as the kinetic energy changes by it; only there is a bend of the prescribed velocity without work.
    """
    work = model.space.total(support * moved)
    if not path.bends:
        return work
    inertia = model.mass @ ((velocity - path.velocity) / path.span)
    return work - model.space.total(inertia * bent(path.bends, path.span))


def contact_event(
    model: Model,
    now: ModelState,
    slab: Slab,
    rows: ContactRows,
    end: Array,
    row: int,
    kind: str,
    tau: float,
    speeds: tuple[float, float],
    impulse: float = 0.0,
) -> Event:
    """Event of a contact row at ``tau``; its position lies between those at both slab ends, exactly on a tool."""
    node, contact = int(rows.node[row]), int(rows.contact[row])
    part = model.parts[model.part_of[node]]
    u0 = now.start.displacement[node]
    time, place = slab.start + tau * slab.span, model.points[node] + u0 + tau * (end[node] - u0)
    tool = bool(model.against_tool[contact])
    name = model.scene.contacts[contact].opponent if tool else _opposite(model, rows, row)
    if tool:
        gap, normal = model.tools[name].at(time).gap_and_normal(place[None])
        place = place - gap[0] * normal[0]
    return Event(
        time=time,
        contact=rows.labels[contact],
        kind=kind,
        node=node - part.nodes.start,
        position=place,
        velocity_before=speeds[0],
        velocity_after=speeds[1],
        impulse=impulse,
        bodies=(part.name, name),
    )


def _opposite(model: Model, rows: ContactRows, row: int) -> str:
    """Name of the solid that the node of a row touches; its own where a body touches itself."""
    own = int(model.part_of[rows.node[row]])
    start, end = rows.gradient.indptr[row : row + 2]
    others = model.part_of[rows.gradient.indices[start:end] // model.shape[1]]
    return model.parts[int(next((k for k in others if k != own), own))].name


def ordered_events(events: Sequence[Event], slab: Slab) -> tuple[Event, ...]:
    """Events of a slab in the order of time, up to 1e-9 of the slab, contact and node; equal ones keep their order."""
    return tuple(sorted(events, key=lambda e: (round((e.time - slab.start) / slab.span, 9), e.contact, e.node)))
