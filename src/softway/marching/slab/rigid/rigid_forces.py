"""Mean forces of a slab (time step) on the rigid bodies: minus those on the nodes that they touch or carry."""

import numpy as np

from softway.arrays import Array
from softway.bodies.rigid_motion import CarriedNodes, RigidShape
from softway.contact.contact_rows import ContactRows
from softway.marching.results.slab_result import SlabResult
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.model.slab import Slab


def forces_on_rigid(model: Model, now: ModelState, slab: Slab, out: SlabResult) -> Array:
    """Mean forces (b, 4, 3) on the rigid bodies: the resultants [N], and the sums of the products ``Y f`` of the forces
    with the places Y in the body that they act on [N m].

    The contact forces at both ends of the slab act on the points of the bodies that touch there, with the weights that
    they have on the nodes: the work on the bodies is minus that on the nodes (docs/theory/contact/rigid_bodies.md).
    """
    assert model.rigid is not None
    first, last = out.system.contact.initial.rows, out.rows
    a = out.solution.end.scalar[model.part_of[last.node]][:, None]
    given = np.zeros((len(model.rigid.it.names) + 1, 4, 3))
    old, new = _forces(first, now.pressure, now.traction), _forces(last, out.pressure, out.friction.traction)
    _add(model, given, last, (0.5 - a) * old, now.start.displacement, slab.start)
    _add(model, given, last, (0.5 + a) * new, out.solution.end.displacement, slab.end)
    return given[:-1] + forces_on_carriers(model, carried_nodes(model), -out.support)


def carried_nodes(model: Model) -> list[CarriedNodes]:
    """Nodes that rigid bodies carry."""
    return [support for support, _ in model.driven if isinstance(support, CarriedNodes)]


def carriers(model: Model) -> list[int]:
    """Numbers of the rigid bodies that carry nodes, but for the ground."""
    if model.rigid is None:
        return []
    return sorted({model.rigid.number(one.by) for one in carried_nodes(model)} - {len(model.rigid.it.names)})


def fields(model: Model, k: int, carried: list[CarriedNodes]) -> Array:
    """Displacements (n d, (1 + d) d) of the nodes that a body ``k`` carries: along each axis by one, and by each
    component of their place in the body.

    The product of forces on the nodes with them are the resultant and the sums of the products ``Y f``, as of
    :func:`forces_on_carriers`.
    """
    n, d = model.shape
    out = np.zeros((n, d, 1 + d, d))
    assert model.rigid is not None
    for one in carried:
        if model.rigid.number(one.by) == k:
            arms = one.motion.arms(one.place)[:, :d]
            for i in range(d):
                out[one.nodes, i, 0, i] = 1.0
                out[one.nodes, i, 1:, i] = arms
    return out.reshape(n * d, -1)


def forces_on_carriers(model: Model, carried: list[CarriedNodes], force: Array) -> Array:
    """Forces (b, 4, 3) on the rigid bodies by forces (n, d) at the nodes that they carry."""
    assert model.rigid is not None
    given = np.zeros((len(model.rigid.it.names) + 1, 4, 3))
    for one in carried:
        add_force(given[model.rigid.number(one.by)], one.motion.arms(one.place), force[one.nodes])
    return given[:-1]


def add_force(given: Array, arms: Array, force: Array) -> None:
    """Add forces (m, d) at the points ``arms`` (m, 3) of a body to ``given`` (4, 3)."""
    pull = np.zeros((len(force), 3))
    pull[:, : force.shape[1]] = force
    given[0] += pull.sum(axis=0)
    given[1:] += arms.T @ pull


def _forces(rows: ContactRows, pressure: Array, traction: Array) -> Array:
    """Forces (m, d) on the nodes of the rows [N]."""
    return np.where(pressure > 0.0, pressure, 0.0)[:, None] * np.where(rows.near[:, None], rows.normal, 0.0) + traction


def _add(model: Model, given: Array, rows: ContactRows, force: Array, u: Array, time: float) -> None:
    """Add minus the forces (m, d) at one end of the slab, where the nodes are displaced by ``u`` (n, d)."""
    pushed = np.flatnonzero(force.any(axis=1))
    assert model.rigid is not None
    for k in np.unique(rows.contact[pushed]):
        name = model.scene.contacts[k].opponent
        shape = model.tools.get(name)
        if not isinstance(shape, RigidShape):
            continue
        here = pushed[rows.contact[pushed] == k]
        node = rows.node[here]
        arms = shape.motion.arms(shape.motion.at(time).back((model.points + u)[node]))
        add_force(given[model.rigid.number(name)], arms, -force[here])
