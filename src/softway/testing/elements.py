"""Checks of a finite element."""

from itertools import product

import numpy as np
from scipy.sparse.linalg import spsolve

from softway.arrays import Array
from softway.bodies.elements.section import default_section
from softway.bodies.internal_force.elastic.elastic_force import ElasticForce, elastic_force
from softway.laws.bulk.linear_elastic import LinearElastic
from softway.meshes.cells import CELLS, Cell
from softway.meshes.element import element, stiffness_degree, tabulate
from softway.meshes.generators.shapes import box, interval, rectangle
from softway.meshes.mesh import Mesh
from softway.testing.verdict import close, require


def check_element(cell: str) -> None:
    """Check an element; raise ``AssertionError`` with the first error found.

    Checked: partition of unity, values at the nodes, completeness, gradients and degree of quadrature. A patch of
    irregular cells is used for the patch test and to count the zero-energy modes.

    Examples
    --------
    >>> check_element("tet10")
    """
    table = CELLS[cell]
    inside = element(cell).points
    _shape_functions(cell, table, inside)
    _gradients(cell, table, inside)
    _quadrature(cell, table)
    patch = irregular_patch(cell)
    force = elastic_force(patch, LinearElastic(E=1.0, nu=0.3), default_section(patch))
    _patch_test(cell, patch, force)
    _free_modes(cell, patch, force)


def irregular_patch(cell: str) -> Mesh:
    """Patch of unit size with two cells per side (three bars) and displaced inner corners; edges stay straight.

    Examples
    --------
    >>> irregular_patch("quad4").n_cells
    4
    """
    table = CELLS[cell]
    if table.dim == 1:
        mesh = interval(1.0, cells=3, cell=cell)
    elif table.dim == 2:
        mesh = rectangle((1.0, 1.0), (2, 2), cell=cell)
    else:
        mesh = box((1.0, 1.0, 1.0), (2, 2, 2), cell=cell)
    points = mesh.points + 0.0
    inner = np.setdiff1d(mesh.nodes("all"), mesh.nodes("surface"))
    waves = np.sin(7.0 * (mesh.points @ np.arange(1.0, table.dim + 1.0))[:, None] + np.arange(table.dim))
    points[inner] += 0.08 * waves[inner]
    corner = _linear_shapes(table)
    for cells in mesh.blocks.values():
        points[cells] = np.einsum("ac,ecd->ead", corner, points[cells[:, : table.corners]])
    return Mesh(points=points, blocks=mesh.blocks)


def _linear_shapes(table: Cell) -> Array:
    """Linear corner shape functions (a, c) at all nodes of a cell."""
    straight = next(n for n, c in CELLS.items() if c.dim == table.dim and c.corners == table.corners and c.order == 1)
    return tabulate(straight, table.nodes)[0]


def _shape_functions(cell: str, table: Cell, inside: Array) -> None:
    N, dN = tabulate(cell, inside)
    close(N.sum(axis=1), np.ones(len(inside)), 1e-13, cell, "shape functions do not add up to one")
    close(dN.sum(axis=1), np.zeros(dN[:, 0].shape), 1e-12, cell, "gradients do not add up to zero", 1.0)
    at_nodes, own = tabulate(cell, table.nodes)[0], np.eye(len(table.nodes))
    close(at_nodes, own, 1e-12, cell, "a shape function is not one at its node and zero at the others")
    for powers in table.powers:
        value, nodal = np.prod(inside**powers, axis=1), np.prod(table.nodes**powers, axis=1)
        close(N @ nodal, value, 1e-13, cell, f"powers {powers.tolist()} are not interpolated exactly", 1.0)


def _gradients(cell: str, table: Cell, inside: Array) -> None:
    dN, step = tabulate(cell, inside)[1], 1e-3
    for r in range(table.dim):
        shift = step * np.eye(table.dim)[r]
        slope = (tabulate(cell, inside + shift)[0] - tabulate(cell, inside - shift)[0]) / (2.0 * step)
        close(
            dN[..., r],
            slope,
            1e-10,
            cell,
            f"gradients along coordinate {r} are not the derivatives of the shape functions",
        )


def _quadrature(cell: str, table: Cell) -> None:
    for degree in (None, stiffness_degree(cell)):
        rule = element(cell, degree)
        require(bool(np.all(rule.weights > 0.0)), cell, "a quadrature weight is not positive")
        for powers in _powers(table, 2 * table.order if degree is None else degree):
            exact = _simplex_integral(powers) if table.simplex else 1.0 / np.prod(np.add(powers, 1.0))
            integral = rule.weights @ np.prod(rule.points**powers, axis=1)
            close(integral, exact, 1e-12, cell, f"powers {powers} are not integrated exactly", rule.weights.sum())


def _patch_test(cell: str, patch: Mesh, force: ElasticForce) -> None:
    gradient = 0.01 * np.array([[1.0, 2.0, -1.0], [0.5, -1.5, 0.7], [-0.3, 0.4, 0.8]])[: patch.dim, : patch.dim]
    exact = patch.points @ gradient.T
    close(force.sampling.volume.sum(), 1.0, 1e-13, cell, "wrong volume of the patch")
    K = force.tangent(np.zeros_like(exact)).tocsr()
    held = np.zeros(exact.shape, bool)
    held[patch.nodes("surface")] = True
    inner = np.flatnonzero(~held.ravel())
    outer = np.flatnonzero(held.ravel())
    solved = exact.ravel().copy()
    if len(inner):
        solved[inner] = np.atleast_1d(spsolve(K[inner][:, inner].tocsc(), -(K[inner][:, outer] @ solved[outer])))
    close(solved, exact.ravel(), 1e-12, cell, "patch test: a constant strain is not reproduced")
    stress = force.stress(exact)
    close(stress, np.broadcast_to(stress[0], stress.shape), 1e-12, cell, "patch test: the stress is not constant")


def _free_modes(cell: str, patch: Mesh, force: ElasticForce) -> None:
    K = force.tangent(np.zeros_like(patch.points)).toarray()
    values = np.linalg.eigvalsh(0.5 * (K + K.T))
    free, rigid = int(np.sum(values < 1e-10 * values[-1])), patch.dim * (patch.dim + 1) // 2
    require(free == rigid, cell, f"{free} zero-energy modes, but {rigid} rigid-body motions")


def _powers(table: Cell, degree: int) -> list[tuple[int, ...]]:
    """Exponents of monomials: total degree on simplices, degree in each direction on other cells."""
    every = product(range(degree + 1), repeat=table.dim)
    return [p for p in every if sum(p) <= degree or not table.simplex]


def _simplex_integral(powers: tuple[int, ...]) -> float:
    """``prod p_i! / (sum p_i + r)!``, the integral of a monomial over the unit simplex."""
    factorial = [float(np.prod(np.arange(1, n + 1))) for n in (*powers, sum(powers) + len(powers))]
    return float(np.prod(factorial[:-1]) / factorial[-1])
