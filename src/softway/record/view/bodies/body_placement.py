"""Placement of bodies with enlarged deformation, such that they touch where they really touch."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.prescribed_motion import PlacedShape
from softway.record.read.cells import Cells
from softway.record.read.frames import Frame
from softway.record.read.surface_mesh import exaggeration, rigid

BENT = 0.1
"""Deformation relative to the body size above which the undeformed shape is not drawn."""
UNDEFORMED = 1e-9
"""Deformation relative to the body size below which a body is regarded as undeformed."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BodyPlacement:
    """Drawn positions (n, 3), undeformed shape (n, 3) in its place, and the enlargement factor of the deformation.

    ``shaped`` (n,) is True at the nodes of bodies whose undeformed shape is drawn.
    """

    points: Array
    shape: Array
    shaped: BoolArray
    factor: float


def body_placement(cells: Cells, frame: Frame, tools: Mapping[str, PlacedShape], most: float = np.inf) -> BodyPlacement:
    """Enlarge the deformation of all bodies by one factor until it is visible, and restore the gaps between them.

    The factor is ``most`` at most, and one beside rigid bodies, which are where they are.  The bodies are shifted to
    their real gaps to the obstacles and to each other.
    """
    real, shape, start = frame.points, frame.points.copy(), frame.start(cells)
    most = min(most, 1.0) if cells.rigid else most
    members = [_nodes_of(cells, number) for number in range(len(cells.bodies))]
    shaped = np.zeros(len(shape), bool)
    factors = [np.inf]
    for mine in members:
        shape[mine] = rigid(start[mine], real[mine])
        size = float(np.linalg.norm(np.ptp(start[mine], axis=0)))
        depth = float(np.linalg.norm(real[mine] - shape[mine], axis=1).max())
        shaped[mine] = depth < BENT * size
        factors += [exaggeration(size, depth)] if depth > UNDEFORMED * size else []
    factor = min(*factors, most) if len(factors) > 1 else min(most, 1.0)
    points = shape + factor * (real - shape)
    for number, mine in enumerate(members):
        shift = _to_others(members[:number], mine, frame, points)
        if shift is None:
            shift = _to_tools(tools, real[mine], points[mine])
            shape[mine] += _to_tools(tools, real[mine], shape[mine]) if factor > 1.0 else 0.0
        else:
            shape[mine] += shift
        points[mine] += shift
    return BodyPlacement(points=points, shape=shape, shaped=shaped, factor=factor)


def _nodes_of(cells: Cells, body: int) -> IntArray:
    mine = np.repeat(cells.body == body, np.diff(cells.offsets))
    return np.unique(cells.connectivity[mine])


def _to_tools(tools: Mapping[str, PlacedShape], real: Array, drawn: Array) -> Array:
    """Shift (3,) that gives a drawn body its real smallest gap to each near obstacle."""
    shift, size = np.zeros(3), np.linalg.norm(np.ptp(real, axis=0))
    for tool in tools.values():
        d = tool.dim
        gap, seen = float(tool.gap(real[:, :d]).min()), tool.gap(drawn[:, :d])
        if gap < 0.5 * size:
            least = int(np.argmin(seen))
            shift[:d] += (gap - seen[least]) * tool.normal_at(drawn[least : least + 1, :d])[0]
    return shift


def _to_others(before: list[IntArray], mine: IntArray, frame: Frame, drawn: Array) -> Array | None:
    """Shift (3,) that restores the real mean position of touching nodes relative to the bodies drawn ``before``.

    None if no nodes touch.
    """
    if not before:
        return None
    other = np.concatenate(before)
    one = [mine[frame.contact_force[mine] > 0.0], other[frame.contact_force[other] > 0.0]]
    sets = [(one[0], other, 1.0), (one[1], mine, -1.0)]
    total, weight = np.zeros(3), 0.0
    for slaves, masters, sign in sets:
        if not len(slaves):
            continue
        distance, nearest = cKDTree(frame.points[masters]).query(frame.points[slaves])
        spacing = cKDTree(frame.points[masters]).query(frame.points[masters], k=2)[0][:, 1].max()
        near = distance <= spacing
        nodes, faces, force = slaves[near], masters[nearest[near]], frame.contact_force[slaves[near]]
        real, seen = (x[nodes] - x[faces] for x in (frame.points, drawn))
        total += sign * (force[:, None] * (real - seen)).sum(axis=0)
        weight += float(force.sum())
    return total / weight if weight > 0.0 else None
