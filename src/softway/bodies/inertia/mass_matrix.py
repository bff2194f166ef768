"""Nodal mass matrix of a body, consistent or lumped; it acts on each displacement component."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from softway.arrays import Array, IntArray
from softway.bodies.elements.section import Axisymmetric, Section
from softway.errors import InputError
from softway.kernels.assembly.assembler import Assembler, assembler
from softway.kernels.geometry.jacobians import determinants
from softway.meshes.cells import CELLS
from softway.meshes.element import Element, element, exact_degree
from softway.meshes.mesh import Mesh


@dataclass(frozen=True, slots=True, kw_only=True)
class Consistent:
    """Consistent mass M_ab = integral of rho N_a N_b; exact mass, centre, and kinetic energy of affine motion."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Lumped:
    """Lumped (diagonal) mass: row sums of linear elements; for quadratic elements the diagonal, scaled to their mass.

    Reference: Hinton, Rock and Zienkiewicz, Earthq. Eng. Struct. Dyn. 4 (1976) 245.
    """


MassRule = Consistent | Lumped

ONE_LAYER = "are connected to contact nodes only: the part is one element thick there, and no node is left for its mass"
"""Reason of an error about contact nodes without a node near them that can take their mass."""
MORE_LAYERS = (
    "two layers of elements or quadratic elements there, a smaller contact tag, "
    "or without friction the rule Impulse with FixedPoint or Newton"
)
"""Remedies for such nodes."""


@dataclass(frozen=True, slots=True)
class Body:
    """Mesh with element table, nodes (e, a) and masses (e, q) of the quadrature points [kg] for each cell type."""

    mesh: Mesh
    blocks: tuple[tuple[Element, IntArray, Array], ...]


def body_of(mesh: Mesh, section: Section, density: float | Array) -> Body:
    """Quadrature of a body that is exact for a density linear in space, also around an axis of revolution.

    The density [kg/m^3] is one number, or one for each element (e,); it fills the volume of the body in each element.
    """
    given = np.asarray(density, float)
    if not ((given > 0.0) & (given < np.inf)).all():
        raise InputError("density", f"{given.min():g} kg/m^3 is not positive", "a positive density")
    of_cell = np.broadcast_to(given, mesh.n_cells)[:, None]
    blocks, start = [], 0
    for name, cells in mesh.blocks.items():
        powers = 2 if isinstance(section, Axisymmetric) else 1
        table = element(name, exact_degree(name, curved=True) + powers * CELLS[name].order)
        corners = mesh.points[cells]
        x = np.einsum("qa,eai->eqi", table.N, corners, optimize=True)
        volume = table.weights * _stretch(corners, table.dN) * section.measure(x)
        if mesh.filling is not None:
            volume = volume * (mesh.filling @ table.N.T)
        blocks.append((table, cells, of_cell[start : start + len(cells)] * volume))
        start += len(cells)
    return Body(mesh, tuple(blocks))


def nodal_mass(mesh: Mesh, density: float | Array, section: Section, rule: MassRule) -> sparse.csr_array:
    """Scalar nodal mass matrix (n, n) [kg].

    Parameters
    ----------
    mesh, section
        Mesh of the body, and section of its elements.
    density
        Mass per reference volume [kg/m^3], positive; one number, or one for each element (e,).
    rule
        Consistent or lumped mass.

    Examples
    --------
    >>> from softway.bodies.elements.section import Bar
    >>> from softway.meshes.generators.shapes import interval
    >>> nodal_mass(interval(1.0, cells=1), 6.0, Bar(), Consistent()).toarray().round(12).tolist()
    [[2.0, 1.0], [1.0, 2.0]]
    >>> nodal_mass(interval(1.0, cells=1), 6.0, Bar(), Lumped()).toarray().round(12).tolist()
    [[3.0, 0.0], [0.0, 3.0]]
    """
    return assembled(body_of(mesh, section, density), rule, np.ones(mesh.n_nodes))


def cell_masses(body: Body, rule: MassRule, factor: Array) -> Iterator[tuple[IntArray, Array]]:
    """Nodes (e, a) and mass matrices (e, a, a) [kg] of the elements of each cell type, density times a field (n,)."""
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


def node_pattern(body: Body) -> Assembler:
    """Pattern of the mass matrices of a body, (n, n)."""
    return assembler([cells for _, cells, _ in body.blocks], body.mesh.n_nodes, 1)


def assembled(body: Body, rule: MassRule, factor: Array, pattern: Assembler | None = None) -> sparse.csr_array:
    """Mass matrix (n, n) [kg] of the density times a nodal field (n,), on the :func:`node_pattern` if it is known."""
    pattern = node_pattern(body) if pattern is None else pattern
    total = pattern.nodal([matrices for _, matrices in cell_masses(body, rule, factor)], 1)
    total.eliminate_zeros()
    return total


def _stretch(corners: Array, dN: Array) -> Array:
    """Determinant (e, q) of the map from the reference element; for bars its length in space."""
    jacobian = np.einsum("eai,qar->eqir", corners, dN, optimize=True)
    if jacobian.shape[-1] == jacobian.shape[-2]:
        return determinants(jacobian)
    return np.asarray(np.linalg.norm(jacobian[..., 0], axis=-1))


def condensation(mesh: Mesh, candidates: IntArray) -> sparse.csr_array:
    """Interpolation matrix T (n, n) for the velocity of massless nodes, the contact nodes ``candidates`` (k,).

    T is the identity on the other nodes.  A massless node follows the mean, with weights 1/d^2, of the nearest nodes
    with mass that it reaches through its elements.

    Raises
    ------
    InputError
        If a massless node is connected to no node with mass.
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
            problem = f"{int(left.sum())} contact nodes {ONE_LAYER}"
            raise InputError("", problem, MORE_LAYERS)
        waiting, reach = waiting[left], further
    parts = (np.concatenate(weights), (np.concatenate(rows), np.concatenate(columns)))
    return sparse.csr_array(parts, shape=(mesh.n_nodes, mesh.n_nodes))


def neighbours(mesh: Mesh) -> sparse.csr_array:
    """Matrix (n, n) of ones for all pairs of nodes that share an element."""
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
