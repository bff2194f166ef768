"""Inertia of a body whose contact nodes have none: the density of the next few cells makes up for what they lose.

What a massless node lacks at a touch, the momentum of its mass, has to come back as a force above that of the
continuum; spread over k cells it comes back over the round trip of a wave through them, ``1 + 1/(3 k)`` high, and no
energy is lost (docs/theory/overshoot.md).
"""

import logging

import numpy as np
from scipy import sparse

from softway.bodies.mass import Consistent, Lumped, MassRule, assembled, body_of, neighbours
from softway.bodies.section import Section
from softway.errors import InputError
from softway.space.mesh import Mesh
from softway.typing import Array, BoolArray, IntArray

_LOG = logging.getLogger(__name__)

LEAST_FACTOR = 0.1
"""Density, relative to the given one, below which fewer cells are filled, or fewer moments of the mass kept."""
CELLS = 5
"""Cells over which the inertia of a contact node is spread where the body is deep enough."""
LOST = ("only the mass is kept, the centre of mass moves", "the moments of inertia change")
"""What a matrix that keeps moments up to an order, 0 or 1, does not keep."""

SPREAD = "body '%s': few cells take the inertia of its contact nodes: %s; a finer mesh keeps it"
"""What is said then."""


def redistributed(
    mesh: Mesh,
    density: float,
    section: Section,
    rule: MassRule,
    candidates: IntArray,
    cells: int = CELLS,
    name: str = "",
) -> sparse.csr_array:
    """Mass matrix (n, n) [kg] whose rows and columns of the candidates are exactly zero.

    The rows of the nodes within ``cells`` cells of the candidates are scaled up by what is missing around them.  The
    density is rho f with ``f = 1 + alpha + beta . xi + xi . Gamma xi`` such that mass, centre of mass and second
    moments are those of the body; where f would fall below 0.1 fewer cells are filled, and if one does not help either,
    the second moments are given up, then the centre, with a warning.  Straight bars need no second moment.

    Parameters
    ----------
    mesh, density, section, rule
        As for :func:`~softway.bodies.mass.nodal_mass`.
    candidates
        Numbers of the nodes that shall have no inertia.
    cells
        Greatest number of cells; half the depth of the body at most.
    name
        Of the body, for the log.

    Raises
    ------
    InputError
        If all nodes of the body, or of a piece of it, are candidates.

    Examples
    --------
    >>> from softway.bodies.mass import Lumped
    >>> from softway.bodies.section import Bar
    >>> from softway.space.shapes import interval
    >>> mesh = interval(1.0, cells=4)
    >>> mass = redistributed(mesh, 1.0, Bar(), Lumped(), np.array([4])).diagonal()
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
    raise InputError("", "the nodes that are no candidates of contact have no mass", "a finer mesh, or a smaller tag")


def _sum(factor: Array, parts: list[sparse.csr_array]) -> sparse.csr_array:
    total = sparse.csr_array(sum((c * m for c, m in zip(factor, parts, strict=True)), sparse.csr_array(parts[0].shape)))
    total.eliminate_zeros()
    return total


def _scale(weights: sparse.csr_array, near: sparse.csr_array, depth: IntArray, cells: int) -> Array:
    """Factors (n,) of rows and columns: none at candidates, more than one within some cells of them.

    Around each candidate the mass that is missing is compared with that of the layer; a node of the layer grows by the
    mean of what the candidates around it say.  Where all of them say the same, so does the layer.  The mass matrix
    ``weights`` (n, n) has positive sums of rows; the consistent one of ten-node tetrahedra has not.
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
    """Coordinates (n, w) from the centre of mass, over the size, of the directions in which the body extends."""
    size = np.ptp(mesh.points, axis=0)
    wide = size > 1e-9 * size.max()
    nodal = np.asarray(plain.sum(axis=1)).ravel()
    return np.asarray((mesh.points - nodal @ mesh.points / nodal.sum())[:, wide] / size[wide])


def _monomials(y: Array, order: int) -> list[Array]:
    """Nodal values (n,) of the monomials up to an order."""
    out = [np.ones(len(y))]
    if order >= 1:
        out += list(y.T)
    if order >= 2:
        out += [y[:, i] * y[:, j] for i in range(y.shape[1]) for j in range(i + 1)]
    return out


def _moments(mass: sparse.csr_array, y: Array, order: int) -> Array:
    """Mass, first and second moments of a mass matrix, up to an order."""
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
    """Cells (n,) between each node and the nearest candidate.

    Raises
    ------
    InputError
        If a piece of the body has candidates only.
    """
    light = np.zeros(near.shape[0], bool)
    light[candidates] = True
    alone = int((_cells_from(near, ~light) < 0).sum())
    if alone:
        problem = f"{alone} candidate nodes have no other node near to take their mass"
        raise InputError("", problem, "a smaller tag, a finer mesh, or the rule Impulse")
    return _cells_from(near, light)


def _cells_from(near: sparse.csr_array, start: BoolArray) -> IntArray:
    """Cells (n,) between each node and the nearest of a set; -1 where none is reached."""
    depth = np.where(start, 0, -1)
    front, level = start, 0
    while front.any():
        level += 1
        front = (near @ front.astype(float) > 0.0) & (depth < 0)
        depth[front] = level
    return depth
