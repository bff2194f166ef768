"""Nodes of a new mesh on the tools that the old one touches, and out of the other solids."""

import numpy as np

from softway.arrays import Array, BoolArray
from softway.contact.contact_rows import ContactRows
from softway.model.model import Model

PASSES = 5
"""Greatest number of corrections."""
ON_TOOL = 1e-14
"""Gap, relative to the size of the solid, at which a node is on its tool."""
SHARE = 0.01
"""Square of the share of a row's motion below which a solid has no part in it."""


def fitted_places(
    model: Model, u: Array, time: float, name: str, closed: BoolArray, kept: BoolArray, places: Array
) -> tuple[Array, BoolArray]:
    """Places (n, d) of the nodes of a solid, out of the tools and the other solids, with those in contact on their
    tools, and the nodes (n,) that others have pushed.

    A facet that has moved into a node of another solid moves back by the least motion of its nodes that may move.

    Parameters
    ----------
    model
        Model with the mesh of the solid.
    u
        (n, d) displacements of all solids [m].
    time
        Time [s].
    name
        Name of the solid.
    closed, kept
        (n,) nodes in contact with tools, and nodes that may not move.
    places
        (n, d) places of its nodes [m].
    """
    part, u = next(p for p in model.parts if p.name == name), np.array(u)
    mine, free = part.nodes, part.dofs.free
    pushed = np.zeros(len(places), dtype=bool)
    for _ in range(PASSES):
        u[mine] = places - part.mesh.points
        rows = model.rows(u, time)
        gap = rows.gap(u)
        far = rows.near & (np.abs(gap) > ON_TOOL * np.ptp(places))
        own = (rows.node >= mine.start) & (rows.node < mine.stop)
        node = np.clip(rows.node - mine.start, 0, len(places) - 1)
        some = far & own & (closed[node] | (gap < 0.0))
        moved = _out_of(rows, gap, far & ~own & (gap < 0.0), mine, free & ~kept[:, None])
        if not (some.any() or moved.any()):
            break
        places = places + moved
        places[node[some]] -= np.where(free[node[some]], gap[some, None] * rows.normal[some], 0.0)
        pushed |= moved.any(axis=1)
    return places, pushed


def _out_of(rows: ContactRows, gap: Array, some: BoolArray, mine: slice, free: BoolArray) -> Array:
    """Motion (n, d) of the facets of a solid out of the nodes of others, of ``some`` rows (r,) with gaps (r,) [m]."""
    d = free.shape[1]
    moved = np.zeros(free.size)
    gradient = rows.gradient[some][:, mine.start * d : mine.stop * d]
    for k, depth in enumerate((-gap[some]).tolist()):
        at, values = (field[gradient.indptr[k] : gradient.indptr[k + 1]] for field in (gradient.indices, gradient.data))
        values = np.where(free.ravel()[at], values, 0.0)
        missing, share = depth - float(values @ moved[at]), float(values @ values)
        if missing > 0.0 and share > 0.0:
            moved[at] += missing / max(share, SHARE) * values
    return moved.reshape(free.shape)
