"""Internal force of a body: stored energy, nodal force, tangent, and the averages of the force over a slab."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array, csr_array, vstack

from softway.bodies.fused import FUSED_SECTIONS, Cells, Fused, fused_force
from softway.bodies.plain import Plain
from softway.bodies.points import MaterialPoints, chord_average
from softway.bodies.section import Axisymmetric, Section, check_section, free_axes, sampled_rows
from softway.kernels.gather import assembler, gather_table
from softway.kernels.geometry import cell_geometry
from softway.laws.compiled import compiled
from softway.laws.law import StoredEnergy
from softway.space.element import element, stiffness_degree
from softway.space.mesh import Mesh
from softway.typing import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class InternalForce:
    """Everything the stored energy of a body says about forces; built by :func:`internal_force`.

    The displacement u is (n, d) [m].

    Parameters
    ----------
    material, section
        Law, and how the cells fill space.
    plain
        The body as arrays over its points.
    work
        What computes energy, force and tangent: kernels where the law has them, else the arrays.
    """

    material: StoredEnergy
    section: Section
    plain: Plain
    work: Plain | Fused

    @property
    def linear(self) -> bool:
        """Whether the tangent is constant."""
        return self.material.linear

    @property
    def volume(self) -> Array:
        """Reference volume of each point, (p,) [m^3]."""
        return self.plain.volume

    @property
    def table(self) -> csr_array:
        """Sampling (p k, n) of nodal values at the points."""
        return self.plain.table

    @property
    def rows(self) -> tuple[Array, ...]:
        """The same numbers for each kind of cell, (e, q, a, k)."""
        return self.plain.rows

    def energy(self, u: Array) -> float:
        """Stored energy [J]; infinite where matter is inverted."""
        return self.work.energy_and_force(u)[0]

    def force(self, u: Array) -> Array:
        """Derivative of the energy to the displacement, (n, d) [N]; ``nan`` where matter is inverted."""
        return self.work.energy_and_force(u)[1]

    def energy_and_force(self, u: Array) -> tuple[float, Array]:
        """:meth:`energy` and :meth:`force` at the price of one."""
        return self.work.energy_and_force(u)

    def tangent(self, u: Array) -> csc_array:
        """Derivative of the force, (n d, n d) [N/m]; number of a component: ``node * d + component``."""
        return self.work.tangent(u)

    def tangent_product(self, u: Array, w: Array) -> Array:
        """The tangent at u times a change w (n, d) [m] of the displacement, (n, d) [N]."""
        return self.work.tangent_product(u, w)

    def tangent_diagonal_blocks(self, u: Array) -> Array:
        """Blocks of the tangent that couple each node with itself, (n, d, d) [N/m]."""
        return self.work.tangent_diagonal_blocks(u)

    def average_force(self, u0: Array, u1: Array, points: int) -> Array:
        """Force averaged along the chord from u0 to u1 by Gauss ``points``, (n, d) [N].

        Its work ``f . (u1 - u0)`` is the difference of the energies up to the quadrature.
        """
        return chord_average(self.force, u0, u1, points)

    def discrete_gradient(self, u0: Array, u1: Array) -> Array:
        """Force (n, d) [N] whose work ``f . (u1 - u0)`` is the difference of the energies to rounding."""
        return self.plain.nodal(self.plain.points.discrete_flux(self.plain.derivatives(u0), self.plain.derivatives(u1)))

    def stress(self, u: Array) -> Array:
        """Cauchy stress (e, 3, 3) [Pa], mean over the present volume of each cell; cells in the order of the blocks.

        Components are those of space; around an axis of revolution they are radial, axial, hoop.
        """
        sigma, ratio = self.plain.points.cauchy(self.plain.derivatives(u))
        present = ratio * self.volume
        points_of = np.concatenate([np.full(len(G), G.shape[1]) for G in self.plain.rows])
        starts = np.cumsum(points_of) - points_of
        total = np.add.reduceat(present[:, None, None] * sigma, starts)
        return total / np.add.reduceat(present, starts)[:, None, None]

    def volume_ratio(self, u: Array) -> float:
        """Least det F over all points; zero or less where matter is inverted."""
        return float(np.min(self.plain.points.volume_ratio(self.plain.derivatives(u))))


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
    kinds, rows, directions = zip(*(_cells(mesh, cell, section) for cell in mesh.blocks), strict=True)
    nodes: list[IntArray] = list(mesh.blocks.values())
    tables = [gather_table(c, G, mesh.n_nodes) for c, G in zip(nodes, rows, strict=True)]
    table = csr_array(vstack(tables, format="csr"))
    plain = Plain(
        section=section,
        points=MaterialPoints(law=material, free=free_axes(section), directions=_merged(np.concatenate(directions))),
        volume=np.concatenate([cells.volume.ravel() for cells in kinds]),
        table=table,
        transposed=table.T.tocsr(),
        rows=rows,
        pattern=assembler(nodes, mesh.n_nodes, mesh.dim),
    )
    law = compiled(material) if isinstance(section, FUSED_SECTIONS) else None
    work = plain if law is None else fused_force(law, section, list(kinds), plain.pattern, mesh.n_nodes)
    return InternalForce(material=material, section=section, plain=plain, work=work)


def _cells(mesh: Mesh, cell: str, section: Section) -> tuple[Cells, Array, Array]:
    """Cells of one kind, their rows (e, q, a, k) and the directions (e q, m, D) of their points."""
    table = element(cell, stiffness_degree(cell) + (2 if isinstance(section, Axisymmetric) else 0))
    corners = mesh.points[mesh.blocks[cell]]
    gradients, measures, directions = cell_geometry(corners, table.dN, table.weights)
    x = np.einsum("qa,ead->eqd", table.N, corners)
    volume = measures * section.measure(x)
    rows = np.ascontiguousarray(sampled_rows(section, gradients, table.N, x))
    m = 3 if isinstance(section, Axisymmetric) else directions.shape[-2]
    if m != directions.shape[-2]:
        directions = np.broadcast_to(np.eye(m), (*volume.shape, m, m))
    cells = Cells(element=table, nodes=mesh.blocks[cell], corners=corners, volume=volume)
    return cells, rows, directions.reshape(-1, *directions.shape[-2:])


def _merged(directions: Array) -> Array:
    """One set of directions (1, m, D) if all points share it."""
    return directions[:1].copy() if np.all(directions == directions[:1]) else directions
