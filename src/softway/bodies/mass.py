"""Inertia of a body as a scalar matrix over its nodes, consistent or lumped; it acts on each component of a motion."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from softway.bodies.section import Axisymmetric, Section
from softway.errors import InputError
from softway.space.cells import CELLS
from softway.space.element import Element, element, exact_degree
from softway.space.mesh import Mesh
from softway.typing import Array, IntArray


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
class Body:
    """A mesh, and block by block: table, cells (e, a), and the masses (e, q) of its quadrature points [kg]."""

    mesh: Mesh
    blocks: tuple[tuple[Element, IntArray, Array], ...]


def body_of(mesh: Mesh, section: Section, density: float) -> Body:
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
        blocks.append((table, cells, density * volume))
    return Body(mesh, tuple(blocks))


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
    return assembled(body_of(mesh, section, density), rule, np.ones(mesh.n_nodes))


def cell_masses(body: Body, rule: MassRule, factor: Array) -> Iterator[tuple[IntArray, Array]]:
    """Cells (e, a) and their mass matrices (e, a, a) of each block; the density is multiplied by a nodal field (n,)."""
    for table, cells, volume in body.blocks:
        mass = volume * (factor[cells] @ table.N.T)
        if isinstance(rule, Consistent):
            yield cells, np.einsum("eq,qa,qb->eab", mass, table.N, table.N, optimize=True)
            continue
        if CELLS[table.cell].order == 2:
            share = volume @ table.N**2
            diagonal = mass.sum(axis=1, keepdims=True) * share / share.sum(axis=1, keepdims=True)
        else:
            diagonal = mass @ table.N
        yield cells, diagonal[:, :, None] * np.eye(cells.shape[1])


def assembled(body: Body, rule: MassRule, factor: Array) -> sparse.csr_array:
    """Mass matrix (n, n) of the density times a nodal field (n,)."""
    n = body.mesh.n_nodes
    total = sparse.csr_array((n, n))
    for cells, matrices in cell_masses(body, rule, factor):
        a = cells.shape[1]
        places = np.repeat(cells, a, axis=1).ravel(), np.tile(cells, (1, a)).ravel()
        total = total + sparse.csr_array((matrices.ravel(), places), shape=(n, n))
    total.eliminate_zeros()
    return sparse.csr_array(total)


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
    near_by = neighbours(mesh)
    keep = sparse.csr_array(sparse.diags_array(other.astype(float)))
    waiting, reach = candidates, near_by[candidates]
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
        further = reach[left] @ near_by
        if left.any() and further.nnz == reach[left].nnz:
            raise InputError(
                "", f"{int(left.sum())} candidate nodes have no other node near to take their mass", "a smaller tag"
            )
        waiting, reach = waiting[left], further
    parts = (np.concatenate(weights), (np.concatenate(rows), np.concatenate(columns)))
    return sparse.csr_array(parts, shape=(mesh.n_nodes, mesh.n_nodes))


def neighbours(mesh: Mesh) -> sparse.csr_array:
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
