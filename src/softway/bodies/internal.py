"""Internal force of a body: stored energy, nodal force, tangent, and the averages of the force over a slab."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array

from softway.bodies.cells import Dilating, sampled_cells
from softway.bodies.fused import Fused
from softway.bodies.fused_cells import FUSED_SECTIONS, fused_cells
from softway.bodies.plain import Plain
from softway.bodies.points import MaterialPoints, chord_average
from softway.bodies.sampling import Sampling
from softway.bodies.section import Section, free_axes
from softway.laws.compiled import compiled
from softway.laws.law import StoredEnergy
from softway.laws.measure import Small
from softway.space.mesh import Mesh
from softway.typing import Array


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
    def directions(self) -> Array:
        """(p, m, D) or (1, m, D) reference directions of the points."""
        return self.plain.points.directions

    @property
    def sampling(self) -> Sampling:
        """From the nodes to the points and back."""
        return self.plain.sampling

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
        H0, H1 = self.plain.derivatives(u0), self.plain.derivatives(u1)
        return self.sampling.nodal(self.plain.points.discrete_flux(H0, H1), 0.5 * (u0 + u1))

    def stress(self, u: Array) -> Array:
        """Cauchy stress (e, 3, 3) [Pa], mean over the present volume of each cell; cells in the order of the blocks.

        Components are those of space; around an axis of revolution they are radial, axial, hoop.
        """
        sigma, ratio = self.plain.points.cauchy(self.plain.derivatives(u))
        return self.sampling.cell_means(sigma, ratio * self.sampling.volume)

    def volume_ratio(self, u: Array) -> float:
        """Least det F over all points; zero or less where matter is inverted."""
        return float(np.min(self.plain.points.volume_ratio(self.plain.derivatives(u))))


def internal_force(
    mesh: Mesh, material: StoredEnergy, section: Section, dilatation: Dilating = "point"
) -> InternalForce:
    """Tables of the internal force of a body that stores energy.

    Examples
    --------
    >>> from softway.bodies.section import Bar
    >>> from softway.laws.bulk import LinearElastic
    >>> mesh = Mesh(points=np.array([[0.0], [2.0]]), blocks={"bar2": np.array([[0, 1]])})
    >>> bar = internal_force(mesh, LinearElastic(E=3.0), Bar(area=2.0))
    >>> bar.tangent(np.zeros((2, 1))).toarray().round(12).tolist()
    [[3.0, -3.0], [-3.0, 3.0]]
    """
    sampled = sampled_cells(mesh, section, dilatation, small=isinstance(material.measure, Small))
    points = MaterialPoints(law=material, free=free_axes(section), directions=sampled.directions)
    plain = Plain(sampling=sampled.sampling, points=points)
    fused = isinstance(section, FUSED_SECTIONS) and dilatation == "point"
    law = compiled(material) if fused else None
    pattern = sampled.sampling.pattern
    work: Plain | Fused = plain
    if law is not None:
        work = Fused(law=law, cells=fused_cells(section, list(sampled.kinds), pattern, mesh.n_nodes))
    return InternalForce(material=material, section=section, plain=plain, work=work)
