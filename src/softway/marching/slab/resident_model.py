"""Central differences whose state stays on a device for many slabs (time steps), docs/theory/solver/device.md."""

import logging
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import scipy.sparse as sp

from softway.arrays import BoolArray, IntArray
from softway.bodies.assembled.vector_space import LocalSpace
from softway.bodies.dof_map import NodalDofs
from softway.bodies.internal_force.device_force import cell_groups, served
from softway.marching.rules.central_difference import CentralDifference
from softway.marching.slab.slab_step import Stepper
from softway.marching.state.march_state import Settings
from softway.marching.state.step_control import SMALL_STRAIN, crushing
from softway.model.model import Model
from softway.solve.device.gradients import device_rows
from softway.solve.device.library import cells, device_named, explicit_slabs, launches
from softway.solve.elimination.closed_rows import ClosedRows
from softway.solve.methods.central_difference import Explicit
from softway.solve.operators.matrix_free import Blocks

log = logging.getLogger(__name__)
PRODUCTS = 500
"""Greatest number of products of an equilibrium of the massless nodes."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ResidentModel:
    """Model on a device: its slabs, the contact rows (m, f) on massless components, and the inverse ``blocks`` (f, f)
    of the stiffness of these; ``rows`` keeps the last closed rows.
    """

    model: Model
    slabs: Any
    gradient: sp.csr_array
    moved: BoolArray
    blocks: Blocks
    rows: dict[bytes, Any] = field(default_factory=dict)

    def closed(self, active: IntArray) -> Any:
        """Rows ``active`` (c,) on the device; None without any."""
        if not len(active):
            return None
        key = active.tobytes()
        if key not in self.rows:
            self.rows.clear()
            found = ClosedRows.of(sp.csr_array(self.gradient[active]), self.blocks)
            self.rows[key] = device_rows(found, self.slabs.device, active)
        return self.rows[key]


def unserved(stepper: Stepper, settings: Settings) -> str:
    """Reason why the state of a march stays on the processor; empty where it does not."""
    model, rule = stepper.model, stepper.rule
    assert isinstance(rule, CentralDifference)
    contact = not model.contacts.fixed or not model.friction.frictionless or model.contacts.clearance is not None
    reasons = {
        "companion fields, rigid bodies or meshes that change": bool(model.companions or model.adapted)
        or model.rigid is not None,
        "driven supports": bool(model.driven),
        "loads that change": not model.loads.steady or not np.array_equal(model.load, model.load_before),
        "contacts other than with planes at rest, without friction": contact,
        "several components of an unknown": not isinstance(model.dofs, NodalDofs),
        "nodes on several ranks": not isinstance(model.space, LocalSpace),
        "consistent masses": bool(rule.inertia.coupled),
        "bulk viscosity": any(part.shock is not None for part in model.parts),
        "slabs that grow or end at knots": settings.tolerance is not None or bool(stepper.ends),
        "a solid with other forces": not all(served(part.internal) for part in model.parts),
    }
    return ", ".join(reason for reason, holds in reasons.items() if holds)


def resident_model(stepper: Stepper, settings: Settings) -> ResidentModel | None:
    """Model on the device of the method; None without one, or where the state stays on the processor."""
    method = stepper.method
    if not isinstance(method, Explicit) or method.device is None:
        return None
    why = unserved(stepper, settings)
    if why:
        log.info("forces on the device, state on the processor: %s", why)
        return None
    assert isinstance(stepper.rule, CentralDifference)
    return _resident(stepper.model, stepper.rule, method, settings)


def _resident(model: Model, rule: CentralDifference, method: Explicit, settings: Settings) -> ResidentModel:
    device, library = device_named(method.device or "auto"), explicit_slabs()
    groups = [
        group
        for k, part in enumerate(model.parts)
        for group in cell_groups(part.internal, np.arange(part.nodes.start, part.nodes.stop), k)
    ]
    placed = cells().DeviceCells.of(groups, model.shape, len(model.parts), device)
    start = model.contacts.rest(np.zeros(model.shape), 0.0).start(np.zeros(model.shape))
    moving = model.free & ~model.massive[:, None]
    layer, blocks = _layer(model, groups, moving, device)
    gradient = sp.csr_array(start.gradient)
    approach = settings.control.approach
    limits = [max(approach, SMALL_STRAIN) if p.internal.linear else approach for p in model.parts]
    rows = library.Contacts(
        gradient=gradient,
        offset=np.asarray(start.offset, float),
        allowed=np.where(start.near, np.array(limits)[model.part_of[start.node]] * model.edge[start.node], np.inf),
        first=np.searchsorted(start.contact, np.arange(len(start.labels) + 1)),
    )
    accuracy = (1 if model.linear else 2, method.tolerance, PRODUCTS)
    slabs = library.ExplicitSlabs.of(placed, layer, _body(model, rule, method), rows, accuracy)
    return ResidentModel(
        model=model,
        slabs=slabs,
        gradient=sp.csr_array(gradient[:, np.flatnonzero(moving)]),
        moved=start.reachable(model.dofs),
        blocks=blocks,
    )


def _body(model: Model, rule: CentralDifference, method: Explicit) -> Any:
    """Arrays of the solids."""
    ends, shortest = [np.zeros((0, 2), int)], [np.zeros(0)]
    for part, edges, first in crushing(model, method).edges:
        ends.append(edges + part.nodes.start)
        shortest.append(np.full(len(edges), first))
    return explicit_slabs().Body(
        points=model.points,
        load=model.load,
        inverse=rule.inertia.inverse,
        free=model.free,
        mass=np.asarray(model.mass.diagonal()),
        light=~model.massive,
        edge=model.edge,
        passing=model.passing,
        ends=np.concatenate(ends),
        shortest=np.concatenate(shortest),
    )


def _around(group: Any, chosen: BoolArray) -> Any:
    """Cells of a group with one of the ``chosen`` nodes (n,)."""
    kept = np.flatnonzero(np.asarray(chosen[group.nodes]).any(axis=1))
    return group._replace(nodes=group.nodes[kept], geometry=group.geometry[kept])


def _layer(model: Model, groups: list[Any], moving: BoolArray, device: str) -> tuple[Any, Blocks]:
    """Massless components with the cells around them on the device, and the inverse of their blocks at rest."""
    chosen, d = np.asarray(moving.any(axis=1)), model.shape[1]
    if not chosen.any():
        return None, Blocks(sp.csr_array((0, 0)))
    own = [g for g in (_around(group, chosen) for group in groups) if len(g.nodes)]
    nodes = np.unique(np.concatenate([g.nodes.ravel() for g in own]))
    own = [g._replace(nodes=np.searchsorted(nodes, g.nodes)) for g in own]
    shape, library, launched = (len(nodes), d), explicit_slabs(), launches()
    around = cells().DeviceCells.of(own, shape, len(model.parts), device)
    inner = NodalDofs(moving[nodes])
    rest = np.zeros(shape)
    blocks = Blocks(inner.block_inverse(around.diagonal_blocks(library.numbers(rest, device))))
    product = launched.SlabProduct.of(around, rest, inner.jacobian, sp.csr_array((len(nodes), len(nodes))), 1.0)
    layer = library.Layer(
        cells=around,
        nodes=library.integers(nodes, device),
        where=library.integers(np.flatnonzero(moving), device),
        own=library.integers(np.asarray(inner.components), device),
        product=product,
        descent=launched.DeviceDescent.of(product, blocks.matrix, device),
        force=library.zeros(shape, device),
    )
    return layer, blocks
