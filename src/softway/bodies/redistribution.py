"""Inertia of a body whose contact nodes have none: what they lose is spread over the nodes of the next few cells.

What a massless node lacks at a touch, the momentum of its mass, has to come back as a force above that of the
continuum; spread over k cells it comes back over the round trip of a wave through them, ``1 + 1/(3 k)`` high, and no
energy is lost (docs/theory/overshoot.md).
"""

import logging

import numpy as np
from scipy import sparse

from softway.bodies.mass import Body, Consistent, MassRule, assembled, body_of, cell_masses, neighbours
from softway.bodies.section import Section
from softway.errors import InputError
from softway.space.mesh import Mesh
from softway.typing import Array, BoolArray, IntArray

_LOG = logging.getLogger(__name__)

LEAST_FACTOR = 0.1
"""Density, relative to the given one, below which fewer moments of the mass are kept."""
CELLS = 5
"""Cells over which the inertia of a contact node is spread where the body is deep enough."""


def redistributed(
    mesh: Mesh, density: float, section: Section, rule: MassRule, candidates: IntArray, cells: int = CELLS
) -> sparse.csr_array:
    """Mass matrix (n, n) [kg] whose rows and columns of the candidates are exactly zero.

    What a cell loses with the candidates' rows and columns is given to the heavy nodes within ``cells`` cells of them,
    in proportion to their own mass.  The density is rho f with ``f = 1 + alpha + beta . xi + xi . Gamma xi`` such that
    mass, centre of mass and second moments are those of the body; where f would fall below 0.1 the second moments are
    given up, then the centre, with a warning.  Straight bars need no second moment.

    Parameters
    ----------
    mesh, density, section, rule
        As for :func:`~softway.bodies.mass.nodal_mass`.
    candidates
        Numbers of the nodes that shall have no inertia.
    cells
        Greatest number of cells; half the depth of the body at most.

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
    body, candidates = body_of(mesh, section, density), np.unique(candidates)
    heavy = np.ones(mesh.n_nodes, bool)
    heavy[candidates] = False
    ones = np.ones(mesh.n_nodes)
    plain = assembled(body, rule, ones)
    share = _receivers(mesh, candidates, plain.diagonal() * heavy, cells)
    diagonal = [np.einsum("eaa->ea", m) for _, m in cell_masses(body, rule, ones)]
    exact = assembled(body, Consistent(), ones)
    y = _scaled(mesh, exact)
    for order in (2, 1, 0) if y.shape[1] > 1 else (1, 0):
        forms = _monomials(y, order)
        parts = [_moved(body, rule, form, heavy, share, diagonal) for form in forms]
        found = np.array([_moments(m, y, order) for m in parts]).T
        factor = np.linalg.lstsq(found, _moments(exact, y, order), rcond=1e-12)[0]
        least = float((factor @ np.array(forms)).min())
        if least >= LEAST_FACTOR or not order:
            break
        gone = "the moments of inertia change" if order == 2 else "only the mass is kept, the centre of mass moves"
        _LOG.log(
            logging.INFO if order == 2 else logging.WARNING,
            "redistributed mass: %s; to keep them the density would have to fall to %.3g of its value somewhere "
            "(least allowed %.3g)",
            gone,
            least,
            LEAST_FACTOR,
        )
    total = sparse.csr_array(sum((c * m for c, m in zip(factor, parts, strict=True)), sparse.csr_array(plain.shape)))
    total.eliminate_zeros()
    return total


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


def _moved(
    body: Body, rule: MassRule, form: Array, heavy: BoolArray, share: sparse.csr_array, diagonal: list[Array]
) -> sparse.csr_array:
    """The matrix (n, n) of the density times a form (n,), with what the candidates lose handed on."""
    n = len(heavy)
    kept, lost = sparse.csr_array((n, n)), np.zeros(n)
    for (cells, matrices), own in zip(cell_masses(body, rule, form), diagonal, strict=True):
        on = heavy[cells]
        inner = matrices * on[:, :, None] * on[:, None, :]
        missing = matrices.sum(axis=(1, 2)) - inner.sum(axis=(1, 2))
        weight = own * ~on
        weight = weight / np.maximum(weight.sum(axis=1, keepdims=True), 1e-300)
        lost += np.bincount(cells.ravel(), (missing[:, None] * weight).ravel(), minlength=n)
        a = cells.shape[1]
        places = np.repeat(cells, a, axis=1).ravel(), np.tile(cells, (1, a)).ravel()
        kept = kept + sparse.csr_array((inner.ravel(), places), shape=(n, n))
    return sparse.csr_array(kept + sparse.diags_array(share.T @ lost))


def _receivers(mesh: Mesh, candidates: IntArray, weight: Array, cells: int) -> sparse.csr_array:
    """Shares (n, n) of the heavy nodes in what each candidate loses; the rows of the others are empty.

    Raises
    ------
    InputError
        If a candidate has no heavy node near.
    """
    near = neighbours(mesh)
    depth = _depth(near, candidates)
    reach = near[candidates]
    for _ in range(min(cells, max(int(depth.max()) // 2, 1)) - 1):
        reach = sparse.csr_array(reach @ near)
        reach.data[:] = 1.0
    found = sparse.csr_array(reach @ sparse.diags_array(weight))
    while (empty := found.sum(axis=1) <= 0.0).any():
        further = sparse.csr_array(reach @ near)
        if further.nnz == reach.nnz:
            problem = f"{int(empty.sum())} candidate nodes have no other node near to take their mass"
            raise InputError("", problem, "a smaller tag, a finer mesh, or the rule Impulse")
        further.data[:] = 1.0
        reach = further
        found = found + sparse.diags_array(empty.astype(float)) @ (reach @ sparse.diags_array(weight))
    found = sparse.csr_array(sparse.diags_array(1.0 / found.sum(axis=1)) @ found)
    n = mesh.n_nodes
    rows = sparse.csr_array((np.ones(len(candidates)), (candidates, np.arange(len(candidates)))), (n, len(candidates)))
    return sparse.csr_array(rows @ found)


def _depth(near: sparse.csr_array, candidates: IntArray) -> IntArray:
    """Cells (n,) between each node and the nearest candidate."""
    depth = np.full(near.shape[0], -1)
    depth[candidates] = 0
    front, level = depth == 0, 0
    while front.any():
        level += 1
        front = (near @ front.astype(float) > 0.0) & (depth < 0)
        depth[front] = level
    return depth
