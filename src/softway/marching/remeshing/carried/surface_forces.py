"""Friction on other meshes: tractions, sticking and slip pass by the place on the surface.

A row takes the traction of its place times its own area, and in each contact a share in the pressed rows' pressure of
what is missing in the sum.  So the force of the contact along its surface passes over, whatever the rows.  Rows without
a surface of their own, corners next to a mortar surface, have no traction: their force is in the sum alone.  Contacts
between which places of the surface change, since tags move, pass over as one group.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.contact_rows import ContactRows
from softway.contact.friction_rows import FrictionRows
from softway.marching.state.model_state import ModelState
from softway.model.model import Model

SLIDES = 0.4
"""Share of sliding rows around a place from which a row there slides."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SurfaceForces:
    """Friction of c groups of contacts on surfaces with n nodes.

    Parameters
    ----------
    groups
        Number of the group of each contact.
    traction
        (c, n, d) friction per area [Pa], zero where nothing touches.
    closed
        (c, n) share of what touches there, one on a node with a closed row.
    sliding, slip
        (c, n) and (c, n, d) share that slips, and velocity of the slip [m/s], both times ``closed``.
    level
        (c, n) friction of what slips, relative to the resistance of the law to ``slip``, times ``closed``: a slab may
        have taken areas and speeds of another instant.
    total
        (c, d) sum of the forces of each group [N].
    """

    groups: IntArray
    traction: Array
    closed: Array
    sliding: Array
    slip: Array
    level: Array
    total: Array

    def on(self, at_nodes: sp.csr_array) -> "SurfaceForces":
        """The same on other nodes (m,), with the values (m, n) there of fields of the n nodes."""
        near = sp.csr_array(abs(at_nodes))

        def of(matrix: sp.csr_array, values: Array) -> Array:
            return np.stack([np.asarray(matrix @ one) for one in values]) if len(values) else values

        return replace(
            self,
            traction=of(at_nodes, self.traction),
            closed=of(near, self.closed),
            sliding=of(near, self.sliding),
            slip=of(near, self.slip),
            level=of(near, self.level),
        )

    def first(self, rows: ContactRows, friction: FrictionRows) -> Array:
        """Tangential forces (r,  d) of rows whose pressure is not known yet [N]."""
        return _along(rows, friction.area[:, None] * self.traction[self.groups[rows.contact], rows.node])

    def forces(self, rows: ContactRows, friction: FrictionRows, pressure: Array) -> tuple[Array, BoolArray]:
        """Tangential forces (r, d) [N] of the rows under normal forces (r,) [N], and the rows that slip.

        Closed rows have the friction of their place; it is cut off at the limit, where they slip.  Rows that slipped
        have the resistance to their slip, at the level of their place.
        """
        closed, group = pressure > 0.0, self.groups[rows.contact]
        out = self.first(rows, friction) * closed[:, None]
        for k in range(len(self.total)):
            here = (group == k) & closed
            if here.any():
                missing = self.total[k] - out[here].sum(axis=0)
                out[here] += (pressure[here] / pressure[here].sum())[:, None] * missing
        out = _along(rows, out)
        size, limit = np.linalg.norm(out, axis=1), friction.limit(pressure)
        way = self.closed[group, rows.node]
        slides = closed & (self.sliding[group, rows.node] > SLIDES * way) & (way > 0.0)
        resistance = _resistance(friction, self.slips(rows), pressure)
        sliding = slides | (closed & (size > limit) & (limit > 0.0))
        level = np.divide(self.level[group, rows.node], way, out=np.ones_like(way), where=way > 0.0)
        wanted = np.where(slides, level * resistance, np.minimum(size, limit))
        factor = np.divide(wanted, size, out=np.zeros_like(size), where=size > 0.0)
        return out * factor[:, None], sliding

    def slips(self, rows: ContactRows) -> Array:
        """Velocities (r, d) of the slip of the rows [m/s]."""
        group = self.groups[rows.contact]
        way, slip = self.closed[group, rows.node][:, None], self.slip[group, rows.node]
        return _along(rows, np.divide(slip, way, out=np.zeros_like(slip), where=way > 0.0))


def surface_forces(model: Model, now: ModelState, groups: IntArray | None = None) -> SurfaceForces:
    """Friction of a state on the nodes of its model, of its contacts in ``groups``, by default of each by itself."""
    groups = np.arange(len(model.contacts.labels)) if groups is None else groups
    (n, d), count = model.shape, int(groups.max(initial=-1)) + 1
    rows, friction = (groups[model.contacts.contact], model.contacts.node), model.friction.at(now.start.displacement)
    area, closed = friction.area, now.closed.astype(float)
    slip = np.zeros_like(now.traction) if now.slip is None else now.slip
    size, resistance = np.linalg.norm(now.traction, axis=1), _resistance(friction, slip, now.pressure)
    level = np.divide(size, resistance, out=np.ones_like(size), where=now.sliding & (resistance > 0.0))

    def on_nodes(values: Array) -> Array:
        out = np.zeros((count, n, *values.shape[1:]))
        np.add.at(out, rows, values)
        return out

    share, areas = on_nodes(closed), on_nodes(closed * area)
    several = np.where(share > 0.0, share, 1.0)
    total = np.zeros((count, d))
    np.add.at(total, rows[0], now.traction)
    traction = on_nodes((closed * ~friction.pointed)[:, None] * now.traction)
    return SurfaceForces(
        groups=groups,
        traction=np.divide(traction, areas[..., None], out=np.zeros_like(traction), where=areas[..., None] > 0.0),
        closed=np.minimum(share, 1.0),
        sliding=on_nodes(closed * now.sliding) / several,
        slip=on_nodes(closed[:, None] * slip) / several[..., None],
        level=on_nodes(closed * level) / several,
        total=total,
    )


def _resistance(friction: FrictionRows, slip: Array, pressure: Array) -> Array:
    """Tangential force (r,) of rows that slip with velocities (r, d) under normal forces (r,) [N]."""
    return friction.resistance(np.linalg.norm(slip, axis=1), pressure)[0]


def _along(rows: ContactRows, vectors: Array) -> Array:
    """Tangential parts (r, d) of vectors (r, d) at the rows."""
    return rows.shear.vectors(rows.shear.flat(vectors))
