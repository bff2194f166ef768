"""Mass redistribution: contact nodes without mass, and a higher density in the next few layers of elements.

A massless node has no momentum at first touch.  The missing momentum returns as a contact force above the force of the
continuum.  With the mass spread over k layers of elements this takes the round trip of a wave through them, the force
is ``1 + 1/(3 k)`` of the continuum's, and no energy is lost (docs/theory/contact/overshoot.md).
"""

import numpy as np
from scipy import sparse

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.elements.section import Section
from softway.bodies.inertia.kept_moments import aims, moments, monomials, scaled
from softway.bodies.inertia.mass_matrix import (
    MORE_LAYERS,
    ONE_LAYER,
    Consistent,
    Lumped,
    MassRule,
    assembled,
    body_of,
    neighbours,
    node_pattern,
)
from softway.errors import InputError
from softway.meshes.mesh import Mesh

CELLS = 5
"""Default number of layers of elements that take the mass of the contact nodes."""


def redistribute_mass(
    mesh: Mesh,
    density: float | Array,
    section: Section,
    rule: MassRule,
    candidates: IntArray,
    cells: int = CELLS,
    name: str = "",
) -> sparse.csr_array:
    """Mass matrix (n, n) [kg] with exactly zero rows and columns at the contact nodes ``candidates``.

    The rows of the nodes within ``cells`` layers of elements from the contact nodes are scaled up to replace the
    missing mass.  The density is rho f with ``f = 1 + alpha + beta . xi + xi . Gamma xi`` such that mass, centre of
    mass and second moments are exact.  Where f would fall below 0.1, fewer layers are used.  If one layer is not enough
    either, first the second moments and then the centre of mass are given up, with a log message.  Straight bars need
    no second moment, and where the nodes with mass lie in a plane or on a line, only moments in it are kept.

    Parameters
    ----------
    mesh, density, section, rule
        As for :func:`~softway.bodies.inertia.mass_matrix.nodal_mass`.
    candidates
        (k,) numbers of the contact nodes, which get no mass.
    cells
        Greatest number of layers; never more than half the depth of the body.
    name
        Name of the body, for the log.

    Raises
    ------
    InputError
        If all nodes of the body, or of a piece of it, are contact nodes.

    Examples
    --------
    >>> from softway.bodies.inertia.mass_matrix import Lumped
    >>> from softway.bodies.elements.section import Bar
    >>> from softway.meshes.generators.shapes import interval
    >>> mesh = interval(1.0, cells=4)
    >>> mass = redistribute_mass(mesh, 1.0, Bar(), Lumped(), np.array([4])).diagonal()
    >>> float(mass[4]), float(round(mass.sum(), 12)), float(round(mass @ mesh.points[:, 0], 12))
    (0.0, 1.0, 0.5)
    """
    body, near = body_of(mesh, section, density), neighbours(mesh)
    ones, pattern = np.ones(mesh.n_nodes), node_pattern(body)
    depth = _depth(near, np.unique(candidates))
    exact, plain = (assembled(body, one, ones, pattern) for one in (Consistent(), rule))
    weights = plain if (plain @ ones > 0.0).all() else assembled(body, Lumped(), ones, pattern)
    scales = [_scale(weights, near, depth, k) for k in range(min(cells, max(int(depth.max()) // 2, 1)), 0, -1)]
    for aim in aims(mesh.points, depth > 0):
        y = scaled(mesh.points @ aim.turn, exact)
        forms = np.array(monomials(y))
        matrices = [assembled(body, rule, form, pattern) for form in forms]
        for scale in scales:
            diagonal = sparse.diags_array(scale)
            filled = [diagonal @ m @ diagonal for m in matrices]
            factor = aim.factor([moments(m, y) for m in filled], (moments(exact, y), moments(plain, y)), forms)
            if factor is not None:
                aim.tell(name)
                return _sum(factor, filled)
    raise InputError("", "the nodes outside the contact tags have no mass", "a finer mesh, or a smaller contact tag")


def _sum(factor: Array, parts: list[sparse.csr_array]) -> sparse.csr_array:
    total = sparse.csr_array(sum((c * m for c, m in zip(factor, parts, strict=True)), sparse.csr_array(parts[0].shape)))
    total.eliminate_zeros()
    return total


def _scale(weights: sparse.csr_array, near: sparse.csr_array, depth: IntArray, cells: int) -> Array:
    """Factors (n,) of rows and columns: zero at contact nodes, greater than one within ``cells`` layers of them.

    Around each contact node the missing mass is divided by the mass of the layers.  A node of the layers grows by the
    mean of these quotients around it.  The mass matrix ``weights`` (n, n) needs positive row sums, which the consistent
    matrix of ten-node tetrahedra does not have.
    """
    light, layer = depth == 0, (depth > 0) & (depth <= cells)
    left = ~light * (weights @ (~light).astype(float))
    lost = weights @ np.ones(len(depth)) - left
    missing, own, count = lost, left * layer, light.astype(float)
    for _ in range(cells):
        missing, own, count = near @ missing, near @ own, near @ count
    growth = np.divide(missing, own, out=np.zeros(len(own)), where=light & (own > 0.0))
    for _ in range(cells):
        growth = near @ growth
    growth = np.divide(growth, count, out=np.zeros(len(own)), where=layer)
    total = float(growth @ left)
    return np.sqrt(~light + growth * (lost.sum() / total if total > 0.0 else 0.0))


def _depth(near: sparse.csr_array, candidates: IntArray) -> IntArray:
    """Number (n,) of elements between each node and the nearest contact node.

    Raises
    ------
    InputError
        If all nodes of a piece of the body are contact nodes.
    """
    light = np.zeros(near.shape[0], bool)
    light[candidates] = True
    alone = int((_cells_from(near, ~light) < 0).sum())
    if alone:
        raise InputError("", f"{alone} contact nodes {ONE_LAYER}", MORE_LAYERS)
    return _cells_from(near, light)


def _cells_from(near: sparse.csr_array, start: BoolArray) -> IntArray:
    """Number (n,) of elements between each node and the nearest node of a set; -1 where none is reached."""
    depth = np.where(start, 0, -1)
    front, level = start, 0
    while front.any():
        level += 1
        front = (near @ front.astype(float) > 0.0) & (depth < 0)
        depth[front] = level
    return depth
