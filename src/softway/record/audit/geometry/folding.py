"""Nodes at which the boundary of a body may touch itself."""

import numpy as np
from scipy.spatial import cKDTree

from softway.arrays import Array, BoolArray, IntArray
from softway.record.audit.geometry.solids import Solids

NEAR = 1.2
"""Greatest distance of the nearest nodes of two pieces that cross, relative to the longest line of the boundary."""
FAR = 2.5
"""Distance at rest, relative to the longest line, from which two nodes belong to different parts of the boundary."""
AGAINST, TURNED = -0.2, 0.3
"""Product of the normals of two neighbours that have folded onto each other, and its least change since the start."""


def folded(solids: Solids, x: Array) -> BoolArray:
    """Nodes (n,) that may touch their own body with the nodes at x (n, d).

    Two nodes of the boundary meet only if they move, relative to each other, by their distance at rest. Relative to the
    best rigid motion no node moves by more than ``m``: as long as ``2 m`` is less than the shortest line of the
    boundary, no nodes meet. Of other bodies two nodes may touch that are near now, and either were far apart at rest or
    look against each other now and did not at rest.
    """
    out = np.zeros(len(x), dtype=bool)
    for body in range(len(solids.names)):
        mine = solids.surface[solids.owner[solids.surface] == body]
        if len(mine) < 3 or solids.dim < 2:
            continue
        if 2.0 * strain_motion(solids.reference[mine], x[mine]) >= solids.shortest[body]:
            out[mine] = _close(solids, x, body)[mine]
    return out


def strain_motion(reference: Array, x: Array) -> float:
    """Greatest distance of points x (n, d) from the rigid motion of ``reference`` (n, d) that is nearest to them [m].

    Examples
    --------
    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> strain_motion(square, square @ np.array([[0.0, 1.0], [-1.0, 0.0]]) + 3.0) < 1e-14
    True
    """
    a, b = reference - reference.mean(axis=0), x - x.mean(axis=0)
    left, _, right = np.linalg.svd(b.T @ a)
    mirror = np.ones(len(left))
    mirror[-1] = np.sign(np.linalg.det(left) * np.linalg.det(right))
    turn = (left * mirror) @ right
    return float(np.linalg.norm(b - a @ turn.T, axis=1).max(initial=0.0))


def _close(solids: Solids, x: Array, body: int) -> BoolArray:
    """Nodes (n,) of a body that are near another one which they were not near to, or not against, at rest."""
    flat = solids.flat[solids.owner[solids.flat[:, 0]] == body]
    nodes = np.unique(flat)
    longest = np.linalg.norm(x[flat] - x[np.roll(flat, 1, axis=1)], axis=2).max()
    i, j = nodes[cKDTree(x[nodes]).query_pairs(NEAR * longest, output_type="ndarray")].T
    apart = ((solids.reference[i] - solids.reference[j]) ** 2).sum(axis=1) > (FAR * longest) ** 2
    now, rest = _normals(flat, x), _normals(flat, solids.reference)
    against = (now[i] * now[j]).sum(axis=1)
    turned = (against < AGAINST) & (against < (rest[i] * rest[j]).sum(axis=1) - TURNED)
    out = np.zeros(len(x), dtype=bool)
    out[np.concatenate([i[apart | turned], j[apart | turned]])] = True
    return out


def _normals(flat: IntArray, x: Array) -> Array:
    """Unit normals (n, d) at the nodes: sums of those of the flat pieces around them."""
    corners = x[flat]
    side = corners[:, 1] - corners[:, 0]
    if x.shape[1] == 2:
        normal = np.stack([side[:, 1], -side[:, 0]], axis=1)
    else:
        normal = np.cross(side, corners[:, 2] - corners[:, 0])
    out = np.zeros(x.shape)
    np.add.at(out, flat, normal[:, None, :])
    return np.asarray(out / np.maximum(np.linalg.norm(out, axis=1, keepdims=True), np.finfo(float).tiny))
