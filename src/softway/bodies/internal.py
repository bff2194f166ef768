"""Internal force of a body: stored energy, nodal force, tangent, and the averages of the force over a slab."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array, csr_array, vstack

from softway.bodies.points import MaterialPoints, chord_average
from softway.bodies.section import (
    Axisymmetric,
    Section,
    check_section,
    derivatives,
    free_axes,
    row_flux,
    row_moduli,
    sampled_rows,
)
from softway.kernels.gather import Assembler, assembler, gather_table
from softway.kernels.geometry import cell_geometry
from softway.laws.law import StoredEnergy
from softway.space.element import element, stiffness_degree
from softway.space.mesh import Mesh
from softway.typing import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class InternalForce:
    """Everything the stored energy of a body says about forces; built by :func:`internal_force`.

    The displacement u is (n, d) [m].  Sampling it at the points is one sparse product, ``A = table u``; the section and
    the law turn A into energy and flux; the transpose of the table brings the flux back to the nodes.

    Parameters
    ----------
    material, section
        Law, and how the cells fill space.
    points
        The material points.
    volume
        (p,) reference volume of each point [m^3].
    table, transposed
        Sampling (p k, n) and its transpose.
    rows
        Per block of cells (e, q, a, k), the same numbers as the table.
    pattern
        Sparsity of the tangent.
    """

    material: StoredEnergy
    section: Section
    points: MaterialPoints
    volume: Array
    table: csr_array
    transposed: csr_array
    rows: tuple[Array, ...]
    pattern: Assembler

    @property
    def linear(self) -> bool:
        """Whether the tangent is constant."""
        return self.material.linear

    def energy(self, u: Array) -> float:
        """Stored energy [J]; infinite where matter is inverted."""
        return float(self.volume @ self.points.energy(self._derivatives(u)))

    def force(self, u: Array) -> Array:
        """Derivative of the energy to the displacement, (n, d) [N]; ``nan`` where matter is inverted."""
        return self._nodal(self.points.flux(self._derivatives(u)))

    def energy_and_force(self, u: Array) -> tuple[float, Array]:
        """:meth:`energy` and :meth:`force` at the price of one."""
        energy, flux = self.points.energy_and_flux(self._derivatives(u))
        return float(self.volume @ energy), self._nodal(flux)

    def tangent(self, u: Array) -> csc_array:
        """Derivative of the force, (n d, n d) [N/m]; number of a component: ``node * d + component``."""
        D = row_moduli(self.section, self.points.moduli(self._derivatives(u)))
        D *= self.volume[:, None, None, None, None]
        blocks, start = [], 0
        for G in self.rows:
            e, q, a, k = G.shape
            blocks.append(_cell_matrices(G, D[start : start + e * q]))
            start += e * q
        return self.pattern.assemble(blocks)

    def average_force(self, u0: Array, u1: Array, points: int) -> Array:
        """Force averaged along the chord from u0 to u1 by Gauss ``points``, (n, d) [N].

        Its work ``f . (u1 - u0)`` is the difference of the energies up to the quadrature.
        """
        H0, H1 = self._derivatives(u0), self._derivatives(u1)
        return self._nodal(chord_average(self.points.flux, H0, H1, points))

    def discrete_gradient(self, u0: Array, u1: Array) -> Array:
        """Force (n, d) [N] whose work ``f . (u1 - u0)`` is the difference of the energies to rounding."""
        return self._nodal(self.points.discrete_flux(self._derivatives(u0), self._derivatives(u1)))

    def stress(self, u: Array) -> Array:
        """Cauchy stress (e, 3, 3) [Pa], mean over the present volume of each cell; cells in the order of the blocks.

        Components are those of space; around an axis of revolution they are radial, axial, hoop.
        """
        sigma, ratio = self.points.cauchy(self._derivatives(u))
        present = ratio * self.volume
        points_of = np.concatenate([np.full(len(G), G.shape[1]) for G in self.rows])
        starts = np.cumsum(points_of) - points_of
        total = np.add.reduceat(present[:, None, None] * sigma, starts)
        return total / np.add.reduceat(present, starts)[:, None, None]

    def volume_ratio(self, u: Array) -> float:
        """Least det F over all points; zero or less where matter is inverted."""
        return float(np.min(self.points.volume_ratio(self._derivatives(u))))

    def _derivatives(self, u: Array) -> Array:
        """Displacement derivatives (p, m, D) at the points."""
        A = (self.table @ u).reshape(len(self.volume), -1, u.shape[1])
        return derivatives(self.section, A)

    def _nodal(self, flux: Array) -> Array:
        """Nodal forces (n, d) of the flux (p, m, D)."""
        q = row_flux(self.section, flux) * self.volume[:, None, None]
        return self.transposed @ q.reshape(-1, q.shape[-1])


def internal_force(mesh: Mesh, material: StoredEnergy, section: Section) -> InternalForce:
    """Tables of the internal force of a body.

    The quadrature integrates the stiffness of the undistorted cell exactly; around an axis of revolution it has two
    degrees more.

    Examples
    --------
    >>> from softway.bodies.section import Bar
    >>> from softway.laws.bulk import LinearElastic
    >>> mesh = Mesh(points=np.array([[0.0], [2.0]]), blocks={"bar2": np.array([[0, 1]])})
    >>> bar = internal_force(mesh, LinearElastic(E=3.0), Bar(area=2.0))
    >>> bar.tangent(np.zeros((2, 1))).toarray().round(12).tolist()
    [[3.0, -3.0], [-3.0, 3.0]]
    """
    check_section(mesh, section)
    rows, volume, directions = zip(*(_block(mesh, cell, section) for cell in mesh.blocks), strict=True)
    cells: list[IntArray] = list(mesh.blocks.values())
    tables = [gather_table(c, G, mesh.n_nodes) for c, G in zip(cells, rows, strict=True)]
    table = csr_array(vstack(tables, format="csr"))
    return InternalForce(
        material=material,
        section=section,
        points=MaterialPoints(law=material, free=free_axes(section), directions=_merged(np.concatenate(directions))),
        volume=np.concatenate(volume),
        table=table,
        transposed=table.T.tocsr(),
        rows=rows,
        pattern=assembler(cells, mesh.n_nodes, mesh.dim),
    )


def _block(mesh: Mesh, cell: str, section: Section) -> tuple[Array, Array, Array]:
    """Rows (e, q, a, k), volumes (e q,) and directions (e q, m, D) of the cells of one kind."""
    table = element(cell, stiffness_degree(cell) + (2 if isinstance(section, Axisymmetric) else 0))
    corners = mesh.points[mesh.blocks[cell]]
    gradients, measures, directions = cell_geometry(corners, table.dN, table.weights)
    x = np.einsum("qa,ead->eqd", table.N, corners)
    volume = measures * section.measure(x)
    rows = np.ascontiguousarray(sampled_rows(section, gradients, table.N, x))
    m = 3 if isinstance(section, Axisymmetric) else directions.shape[-2]
    if m != directions.shape[-2]:
        directions = np.broadcast_to(np.eye(m), (*volume.shape, m, m))
    return rows, volume.ravel(), directions.reshape(-1, *directions.shape[-2:])


def _cell_matrices(G: Array, D: Array) -> Array:
    """``sum_q G_qar D_qrisj G_qbs`` of rows (e, q, a, k) and moduli (e q, k, d, k, d), (e, a, b, d, d)."""
    e, q, a, k = G.shape
    d = D.shape[2]
    half = (G @ D.reshape(e, q, k, d * k * d)).reshape(e, q, a, d, k, d)
    left = half.transpose(0, 2, 3, 5, 1, 4).reshape(e, a * d * d, q * k)
    right = np.swapaxes(G, 2, 3).reshape(e, q * k, a)
    return (left @ right).reshape(e, a, d, d, a).transpose(0, 1, 4, 2, 3)


def _merged(directions: Array) -> Array:
    """One set of directions (1, m, D) if all points share it."""
    return directions[:1].copy() if np.all(directions == directions[:1]) else directions
