"""Contacts of nodes with inertia on other meshes: what is closed stays closed, by its place on the surface
(docs/theory/bodies/adaptive.md#contact-nodes-with-inertia).
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.adaptivity.projections.conditions import ClosedRows
from softway.arrays import Array, BoolArray, IntArray
from softway.contact.contact_rows import ContactRows
from softway.errors import NumericsError
from softway.marching.remeshing.carried.surface_forces import SurfaceForces
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.solve.constraints.impact_multipliers import impact_multipliers
from softway.solve.constraints.normal_active_set import rounded

ROUNDS = 40
"""Greatest number of corrections of the gaps, which curved tools and turning facets need."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class KeptContacts:
    """Contacts that stay closed.

    Parameters
    ----------
    closed
        (c, n) nodes of each of c contacts that touch.
    speed
        (c, n) normal velocity there of the node against a deformable opponent, or of the node by itself before a tool
        [m/s].
    """

    closed: BoolArray
    speed: Array

    def rows(self, model: Model, rows: ContactRows) -> BoolArray:
        """Contact rows (m,) that stay closed."""
        return np.asarray(self.closed[rows.contact, rows.node] & rows.reachable(model.dofs))

    def placed(self, model: Model, u: Array, time: float) -> tuple[Array, ContactRows]:
        """Displacement (n, d) at which closed rows have no gap and no node is inside an opponent, and the rows there.

        Contact nodes alone are moved, by the least motion; without need none is.

        Raises
        ------
        NumericsError
            If there is no such place near the displacement.
        """
        least = rounded(model.extent(u))
        for _ in range(ROUNDS):
            rows = model.rows(u, time)
            gap, closed = np.where(rows.near, rows.gap(u), np.inf), self.rows(model, rows)
            inside = rows.reachable(model.dofs) & (gap < -least) & (gap > -model.edge[rows.node])
            wrong = inside | (closed & (gap > least))
            if not wrong.any():
                return u, rows
            u = u + rows.motion(np.where(wrong, -gap, 0.0), wrong | closed, model.free)
        raise NumericsError("closed contacts have no place on the new mesh", time, "smaller cells in the base mesh")

    def conditions(self, model: Model, rows: ContactRows, velocity: Array, nodes: IntArray) -> ClosedRows | None:
        """Closed rows on the ``nodes`` (k,) of some solids, the others with their ``velocity`` (n, d); None without."""
        gradient, d = rows.gradient, model.shape[1]
        at = (d * nodes[:, None] + np.arange(d)).ravel()
        own = sp.csr_array(gradient[:, at])
        index = np.flatnonzero(self.rows(model, rows) & (np.diff(own.indptr) > 0))
        if not len(index):
            return None
        others = velocity.copy()
        others[nodes] = 0.0
        speed = self.speed[rows.contact[index], rows.node[index]] - gradient[index] @ others.ravel()
        return ClosedRows(gradient=sp.csr_array(own[index]), velocity=np.asarray(speed))

    def pressed(self, model: Model, found: ModelState, friction: SurfaceForces | None) -> ModelState:
        """State with the closed rows and the forces that keep them so."""
        rows = model.rows(found.start.displacement, found.time)
        closed, inertia = self.rows(model, rows), impact_multipliers(model)
        if friction is None:
            pressure = np.maximum(inertia.multiplier(rows, found.start.force, closed), 0.0)
            return replace(found, closed=closed, pressure=pressure)
        law = model.friction.at(found.start.displacement)
        pull = rows.shear.spread(friction.first(rows, law) * closed[:, None])
        pressure = np.maximum(inertia.multiplier(rows, found.start.force - pull, closed), 0.0)
        traction, sliding = friction.forces(rows, law, pressure)
        return replace(found, closed=closed, pressure=pressure, traction=traction, sliding=sliding)


def kept_contacts(model: Model, now: ModelState, at_nodes: sp.csr_array) -> KeptContacts:
    """Contacts of a state on other nodes (k,), with the values (k, n) there of fields of the n nodes of the model.

    A node touches where all nodes of the surface that it lies between touch.
    """
    numbers, count = (model.contacts.contact, model.contacts.node), len(model.contacts.labels)
    rows = now.force_rows(model.rows(now.start.displacement, now.time))
    speeds, near = rows.normal_component(now.start.velocity), sp.csr_array(abs(at_nodes))
    touches, share, total = (np.zeros((count, model.shape[0])) for _ in range(3))
    np.maximum.at(touches, numbers, 1.0)
    np.add.at(share, numbers, now.closed.astype(float))
    np.add.at(total, numbers, np.where(now.closed, speeds, 0.0))
    closed = share > 0.0
    mean = np.divide(total, share, out=np.zeros_like(total), where=closed)
    open_, shut = ((values.astype(float) @ near.T) for values in ((touches > 0.0) & ~closed, closed))
    return KeptContacts(closed=(shut > 0.0) & (open_ == 0.0), speed=np.asarray(mean @ at_nodes.T))
