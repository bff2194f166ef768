"""Inertia of a body as a scalar matrix over its nodes: consistent, lumped, and redistributed away from nodes that may
touch.

The same matrix acts on every displacement component. Redistribution takes all inertia off the candidates of a contact
(Khenous, Laborde and Renard, Eur. J. Mech. A 27 (2008) 918), keeping the mass and the centre of mass of the body.
"""

import logging
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from softway.bodies.section import Axisymmetric, Section
from softway.errors import InputError
from softway.space.cells import CELLS
from softway.space.element import Element, element, exact_degree
from softway.space.mesh import Mesh
from softway.typing import Array, IntArray

_LOG = logging.getLogger(__name__)

# Redistribution changes the density by a factor that is linear in space; below this it is not used.
_LEAST_FACTOR = 0.1


@dataclass(frozen=True, slots=True, kw_only=True)
class Consistent:
    """M_ab = integral of rho N_a N_b: keeps mass, centre of mass and, under affine motion, kinetic energy."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Lumped:
    """Diagonal: row sums on linear cells; on quadratic cells the diagonal, scaled to the mass of the cell.

    Reference: Hinton, Rock and Zienkiewicz, Earthq. Eng. Struct. Dyn. 4 (1976) 245.
    """


MassRule = Consistent | Lumped


@dataclass(frozen=True, slots=True)
class _Body:
    """A mesh, and block by block: table, cells (e, a), quadrature points (e, q, d), and their masses (e, q) [kg]."""

    mesh: Mesh
    blocks: tuple[tuple[Element, IntArray, Array, Array], ...]


def _body(mesh: Mesh, section: Section, density: float) -> _Body:
    """A body ready for quadrature that is exact for a density linear in space, of bodies of revolution too."""
    if not 0.0 < density < np.inf:
        raise InputError("density", f"{density:g} kg/m^3 is not positive", "a positive density")
    blocks = []
    for name, cells in mesh.blocks.items():
        powers = 2 if isinstance(section, Axisymmetric) else 1
        table = element(name, exact_degree(name, curved=True) + powers * CELLS[name].order)
        corners = mesh.points[cells]
        x = np.einsum("qa,eai->eqi", table.N, corners, optimize=True)
        volume = table.weights * _stretch(corners, table.dN) * section.measure(x)
        blocks.append((table, cells, x, density * volume))
    return _Body(mesh, tuple(blocks))


def nodal_mass(mesh: Mesh, density: float, section: Section, rule: MassRule) -> sparse.csr_array:
    """Scalar nodal mass matrix (n, n) [kg].

    Parameters
    ----------
    mesh, section
        The body and how its cells fill space.
    density
        [kg/m^3], positive.
    rule
        Consistent or lumped.

    Examples
    --------
    >>> from softway.bodies.section import Bar
    >>> from softway.space.shapes import interval
    >>> nodal_mass(interval(1.0, cells=1), 6.0, Bar(), Consistent()).toarray().round(12).tolist()
    [[2.0, 1.0], [1.0, 2.0]]
    >>> nodal_mass(interval(1.0, cells=1), 6.0, Bar(), Lumped()).toarray().round(12).tolist()
    [[3.0, 0.0], [0.0, 3.0]]
    """
    return _assembled(_body(mesh, section, density), rule, _linear(np.eye(1 + mesh.dim)[0], np.zeros(mesh.dim)))


def redistributed(
    mesh: Mesh, density: float, section: Section, rule: MassRule, candidates: IntArray
) -> sparse.csr_array:
    """Mass matrix (n, n) [kg] whose rows and columns of the candidates are exactly zero.

    The velocity of a candidate follows nearby other nodes, v = T v with weights 1/d^2, so that its inertia goes to
    them: T^T M T; of the lumped rule the sums of its rows, which keep it diagonal. The density is rho f with
    f = 1 + alpha + beta . (X - Xbar), alpha and beta such that mass and centre of mass are those of the body. Where f
    would fall below 0.1, beta is zero and only the mass is kept; a warning is logged.

    Parameters
    ----------
    mesh, density, section, rule
        As for :func:`nodal_mass`.
    candidates
        Numbers of the nodes that shall have no inertia.

    Examples
    --------
    >>> from softway.bodies.section import Bar
    >>> from softway.space.shapes import interval
    >>> mesh = interval(1.0, cells=4)
    >>> mass = redistributed(mesh, 1.0, Bar(), Lumped(), np.array([4])).diagonal()
    >>> float(mass[4]), float(round(mass.sum(), 12)), float(round(mass @ mesh.points[:, 0], 12))
    (0.0, 1.0, 0.5)
    """
    body = _body(mesh, section, density)
    follow = following(mesh, np.unique(candidates))
    plain = _nodal(body, Consistent(), _linear(np.eye(1 + mesh.dim)[0], np.zeros(mesh.dim)))
    total, centre = float(plain.sum()), plain @ mesh.points / plain.sum()
    factor = _factor(body, rule, follow, total, centre)
    mass = _assembled(body, rule, _linear(factor, centre))
    if isinstance(rule, Lumped):
        moved = sparse.diags_array(follow.T @ mass.diagonal())
    else:
        moved = follow.T @ mass @ follow
    found = sparse.csr_array(moved)
    found.eliminate_zeros()
    return found


def _factor(body: _Body, rule: MassRule, follow: sparse.csr_array, total: float, centre: Array) -> Array:
    """alpha and beta (1 + d,) of the density that keeps mass and centre of mass after the velocities follow."""
    points = body.mesh.points
    size = np.ptp(points, axis=0)
    wide = np.flatnonzero(size > 1e-9 * size.max())
    constant = np.concatenate([[1.0], np.zeros(len(size))])
    shares = [_nodal(body, rule, _linear(form, centre)) for form in np.eye(1 + len(size))[[0, *(1 + wide)]]]
    tests = np.column_stack([np.ones(len(points)), (follow @ points - centre)[:, wide]])
    moments = (np.array(shares) @ tests).T
    scale = total * np.concatenate([[1.0], size[wide]])
    missing = (total * constant[[0, *(1 + wide)]] - moments[:, 0]) / scale
    change = np.linalg.lstsq(moments / scale[:, None], missing, rcond=1e-12)[0]
    missed = np.abs(moments @ change / scale - missing).max()
    factor = constant.copy()
    factor[[0, *(1 + wide)]] += change
    least = float(_linear(factor, centre)(points).min())
    if least >= _LEAST_FACTOR and missed < 1e-11:
        return factor
    _LOG.warning(
        "redistributed mass: only the mass is kept, the centre of mass moves; to keep it the density would have to "
        "fall to %.3g of its value somewhere (least allowed %.3g), or no density does",
        least,
        _LEAST_FACTOR,
    )
    return constant * (total / shares[0].sum())


def _linear(factor: Array, centre: Array) -> Callable[[Array], Array]:
    """The factor ``factor[0] + factor[1:] . (x - centre)`` at points (..., d)."""
    return lambda x: factor[0] + (x - centre) @ factor[1:]


def _assembled(body: _Body, rule: MassRule, factor: Callable[[Array], Array]) -> sparse.csr_array:
    """Mass matrix (n, n) of the density times a factor given at points (..., d)."""
    n = body.mesh.n_nodes
    if isinstance(rule, Lumped):
        return sparse.csr_array(sparse.diags_array(_nodal(body, rule, factor)))
    total = sparse.csr_array((n, n))
    for table, cells, x, volume in body.blocks:
        a = cells.shape[1]
        square = (table.N[:, :, None] * table.N[:, None, :]).reshape(-1, a * a)
        rows, columns = np.repeat(cells, a, axis=1), np.tile(cells, (1, a))
        values = (volume * factor(x)) @ square
        total = total + sparse.csr_array((values.ravel(), (rows.ravel(), columns.ravel())), shape=(n, n))
    return total


def _nodal(body: _Body, rule: MassRule, factor: Callable[[Array], Array]) -> Array:
    """Nodal masses (n,), the row sums of the matrix that :func:`_assembled` makes."""
    found = np.zeros(body.mesh.n_nodes)
    for table, cells, x, volume in body.blocks:
        mass = volume * factor(x)
        if isinstance(rule, Lumped) and CELLS[table.cell].order == 2:
            share = volume @ table.N**2
            values = mass.sum(axis=1, keepdims=True) * share / share.sum(axis=1, keepdims=True)
        else:
            values = mass @ table.N
        found += np.bincount(cells.ravel(), weights=values.ravel(), minlength=len(found))
    return found


def _stretch(corners: Array, dN: Array) -> Array:
    """Reference volume per volume of the reference cell (e, q), of bars in any space their length."""
    jacobian = np.einsum("eai,qar->eqir", corners, dN, optimize=True)
    if jacobian.shape[-1] == jacobian.shape[-2]:
        return np.asarray(np.linalg.det(jacobian))
    return np.asarray(np.linalg.norm(jacobian[..., 0], axis=-1))


def following(mesh: Mesh, candidates: IntArray) -> sparse.csr_array:
    """T (n, n): identity on other nodes; a candidate takes the mean, with weights 1/d^2, of the nearest others through
    its cells.
    """
    other = np.ones(mesh.n_nodes, dtype=bool)
    other[candidates] = False
    neighbours = _neighbours(mesh)
    keep = sparse.csr_array(sparse.diags_array(other.astype(float)))
    waiting, reach = candidates, neighbours[candidates]
    rows, columns, weights = [np.flatnonzero(other)], [np.flatnonzero(other)], [np.ones(int(other.sum()))]
    while len(waiting):
        found = sparse.coo_array(reach @ keep)
        row, column = found.row[found.data > 0], found.col[found.data > 0]
        near = 1.0 / ((mesh.points[waiting[row]] - mesh.points[column]) ** 2).sum(axis=1)
        sums = np.bincount(row, weights=near, minlength=len(waiting))
        rows.append(waiting[row])
        columns.append(column)
        weights.append(near / sums[row])
        left = sums == 0.0
        further = reach[left] @ neighbours
        if left.any() and further.nnz == reach[left].nnz:
            raise InputError(
                "", f"{int(left.sum())} candidate nodes have no other node near to take their mass", "a smaller tag"
            )
        waiting, reach = waiting[left], further
    parts = (np.concatenate(weights), (np.concatenate(rows), np.concatenate(columns)))
    return sparse.csr_array(parts, shape=(mesh.n_nodes, mesh.n_nodes))


def _neighbours(mesh: Mesh) -> sparse.csr_array:
    """Pattern (n, n): nodes that share a cell."""
    touch = []
    for cells in mesh.blocks.values():
        e, a = cells.shape
        touch.append(
            sparse.coo_array((np.ones(e * a), (cells.ravel(), np.repeat(np.arange(e), a))), shape=(mesh.n_nodes, e))
        )
    incidence = sparse.csr_array(sparse.hstack(touch))
    pattern = sparse.csr_array(incidence @ incidence.T)
    pattern.data[:] = 1.0
    return pattern
