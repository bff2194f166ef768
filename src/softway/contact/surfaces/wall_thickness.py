"""Thickness of bodies behind their surfaces at rest: it limits the overlap that is taken for contact."""

from collections.abc import Sequence

import numpy as np

from softway.arrays import Array, IntArray
from softway.contact.surfaces.boundary import ContactSurface
from softway.contact.surfaces.broad_phase import Sweep, near, sweep
from softway.contact.surfaces.facet_geometry import normals
from softway.kernels.geometry.closest_points import dot
from softway.meshes.cells import CELLS

DEPTH = 0.25
"""Greatest overlap at the start of a slab that is taken for contact, relative to the thickness of the bodies: facets
that overlap by more belong to the far side of a wall."""
AWAY = -0.1
"""Product of the normals of two facets below which one looks away from the other."""


def admissible_depth(least: Array, thickness: Array) -> Array:
    """Overlaps (p,) of pairs [m] up to which they are taken for contact at the start of a slab.

    ``least`` (p,) is the limit by the size of the facets, ``thickness`` (p,) the sum of those of both bodies.

    Examples
    --------
    >>> admissible_depth(np.array([0.5, 0.5]), np.array([np.inf, 1.0])).tolist()
    [0.5, 0.25]
    """
    return np.minimum(least, DEPTH * thickness)


def nodal_thickness(x: Array, bodies: Sequence[ContactSurface]) -> Array:
    """Thickness (n,) of the bodies behind their surface nodes at the positions x (n, d) [m].

    That of a facet is the distance from its centre, against its normal, to the first facet of the ``bodies`` that looks
    away; a node has the least one of its facets.  It is infinite beyond the size of the greatest facet and for bars.

    Examples
    --------
    A wall of one cell, four times as long as thick:

    >>> x = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [0.0, 1.0]])
    >>> wall = ContactSurface(facets={"bar2": np.array([[0, 1], [1, 2], [2, 3], [3, 0]])})
    >>> nodal_thickness(x, [wall]).tolist()
    [1.0, 1.0, 1.0, 1.0]
    """
    out = np.full(len(x), np.inf)
    solid = [body for body in bodies if body.dim > 1]
    reach = max((float(np.linalg.norm(2.0 * sweep(x, x, b.table).half, axis=1).max()) for b in solid), default=0.0)
    for body in solid:
        found = _facet_thickness(x, body, reach)
        for column in body.table.T:
            np.minimum.at(out, column, found)
    return out


def _facet_thickness(x: Array, body: ContactSurface, reach: float) -> Array:
    """Thickness (f,) behind the facets of a closed surface, up to ``reach`` [m]."""
    boxes, (centre, normal) = sweep(x, x, body.table), _centres(x, body)
    rays = Sweep(start=centre, end=centre - reach * normal, half=np.zeros_like(centre))
    i, j = near(rays, boxes, 1e-9 * reach)
    slope = dot(normal[i], normal[j])
    i, j, slope = i[slope < AWAY], j[slope < AWAY], slope[slope < AWAY]
    distance = dot(centre[i] - centre[j], normal[j]) / slope
    apart = np.abs(centre[i] - distance[:, None] * normal[i] - boxes.start[j])
    through = (distance > 0.0) & (distance <= reach) & (apart <= boxes.half[j] + 1e-6 * reach).all(axis=1)
    out = np.full(len(centre), np.inf)
    np.minimum.at(out, i[through], distance[through])
    return out


def _centres(x: Array, body: ContactSurface) -> tuple[Array, Array]:
    """Centres (f, d) and normals (f, d) of the facets."""
    centre, normal = [], []
    for kind, _, found in body.numbers:
        middle = np.broadcast_to(CELLS[kind].nodes.mean(axis=0), (len(found), CELLS[kind].dim))
        centre.append(x[found[:, : CELLS[kind].corners]].mean(axis=1))
        normal.append(normals(kind, x[found], middle))
    return np.concatenate(centre), np.concatenate(normal)


def thickness_of(thickness: Array | None, nodes: IntArray) -> Array:
    """Least thickness (p,) of groups of nodes (p, b), from that of all nodes (n,); infinite if it is not given."""
    return np.full(len(nodes), np.inf) if thickness is None else np.asarray(thickness[nodes].min(axis=1))
