"""Mean forces of a slab (time step) on the rigid bodies: minus those on the nodes that they touch or carry."""

import numpy as np

from softway.arrays import Array
from softway.bodies.rigid_motion import CarriedNodes, RigidShape
from softway.contact.contact_rows import ContactRows
from softway.march.model_state import ModelState
from softway.march.results.slab_result import SlabResult
from softway.march.slab.carried_response import add_force, forces_on_carriers
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
    carried = [support for support, _ in model.driven if isinstance(support, CarriedNodes)]
    return given[:-1] + forces_on_carriers(model, carried, -out.support)


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
