"""Mass redistribution: contact nodes without mass, and a higher density in the next few layers of elements.

A massless node has no momentum at first touch.  The missing momentum returns as a contact force above the force of the
continuum.  With the mass spread over k layers of elements this takes the round trip of a wave through them, the force
is ``1 + 1/(3 k)`` of the continuum's, and no energy is lost (docs/theory/contact/overshoot.md).
"""

import logging

import numpy as np
from scipy import sparse

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.elements.section import Section
from softway.bodies.inertia.mass_matrix import (
    MORE_LAYERS,
    ONE_LAYER,
    Consistent,
    Lumped,
    MassRule,
    assembled,
    body_of,
    neighbours,
)
from softway.errors import InputError
from softway.meshes.mesh import Mesh

_LOG = logging.getLogger(__name__)

LEAST_FACTOR = 0.1
"""Least density relative to the given one; below it fewer layers, or fewer moments of the mass, are used."""
CELLS = 5
"""Default number of layers of elements that take the mass of the contact nodes."""
LOST = ("only the mass is kept, the centre of mass moves", "the moments of inertia change")
"""Consequence of a mass matrix that keeps moments up to the order 0 or 1 only."""

SPREAD = "body '%s': too few elements for the mass of its contact nodes: %s; a finer mesh avoids this"
"""Log message about a mass matrix that does not keep all moments."""


def redistribute_mass(
    mesh: Mesh,
    density: float,
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
    no second moment.

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
    ones = np.ones(mesh.n_nodes)
    depth = _depth(near, np.unique(candidates))
    exact = assembled(body, Consistent(), ones)
    y = _scaled(mesh, exact)
    plain = assembled(body, rule, ones)
    highest = 2 if y.shape[1] > 1 else 1
    weights = plain if (plain @ ones > 0.0).all() else assembled(body, Lumped(), ones)
    every = np.array(_monomials(y, highest))
    matrices = [assembled(body, rule, form) for form in every]
    for order in range(highest, -1, -1):
        target = _moments(exact, y, order)
        target[1 + y.shape[1] :] = _moments(plain, y, order)[1 + y.shape[1] :]
        forms, parts = every[: len(target)], matrices[: len(target)]
        for k in range(min(cells, max(int(depth.max()) // 2, 1)), 0, -1):
            scale = sparse.diags_array(_scale(weights, near, depth, k))
            filled = [scale @ m @ scale for m in parts]
            found = np.array([_moments(m, y, order) for m in filled]).T
            factor = np.linalg.lstsq(found, target, rcond=1e-12)[0]
            least = float((factor @ forms).min())
            kept = np.abs(found @ factor - target).max() <= 1e-9 * target[0]
            if (least >= LEAST_FACTOR or not order) and kept:
                if order < highest:
                    _LOG.log(logging.INFO if order else logging.WARNING, SPREAD, name, LOST[order])
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


def _scaled(mesh: Mesh, plain: sparse.csr_array) -> Array:
    """Coordinates (n, w) relative to the centre of mass and the size, along the axes in which the body extends."""
    size = np.ptp(mesh.points, axis=0)
    wide = size > 1e-9 * size.max()
    nodal = np.asarray(plain.sum(axis=1)).ravel()
    return np.asarray((mesh.points - nodal @ mesh.points / nodal.sum())[:, wide] / size[wide])


def _monomials(y: Array, order: int) -> list[Array]:
    """Nodal values (n,) of all monomials up to an order."""
    out = [np.ones(len(y))]
    if order >= 1:
        out += list(y.T)
    if order >= 2:
        out += [y[:, i] * y[:, j] for i in range(y.shape[1]) for j in range(i + 1)]
    return out


def _moments(mass: sparse.csr_array, y: Array, order: int) -> Array:
    """Mass, first and second moments of a mass matrix up to an order."""
    z = np.column_stack([np.ones(len(y)), y])
    table = z.T @ (mass @ z)
    d = y.shape[1]
    out = [table[0, 0]]
    if order >= 1:
        out += list(table[0, 1:])
    if order >= 2:
        out += [table[1 + i, 1 + j] for i in range(d) for j in range(i + 1)]
    return np.array(out)


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
