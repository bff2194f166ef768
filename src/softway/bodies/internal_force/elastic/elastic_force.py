"""Internal force of an elastic body: stored energy, nodal force, tangent, and averages of the force over a slab."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array

from softway.arrays import Array, IntArray
from softway.bodies.elements.kernel_cells import FUSED_SECTIONS, Rows, averaged, kernel_cells
from softway.bodies.elements.quadrature import Dilating, sampled_cells
from softway.bodies.elements.section import Section, free_axes
from softway.bodies.elements.strain_operator import StrainOperator
from softway.bodies.internal_force.body_force import BodyForce
from softway.bodies.internal_force.elastic.array_evaluation import ArrayEvaluation
from softway.bodies.internal_force.elastic.device_evaluation import DeviceEvaluation
from softway.bodies.internal_force.elastic.kernel_evaluation import KernelEvaluation
from softway.bodies.internal_force.elastic.material_points import MaterialPoints, chord_average
from softway.bodies.internal_force.material_state import MaterialState
from softway.bodies.internal_force.slab_average import AverageField, DiscreteGradient, SlabForce
from softway.laws.kernel_laws import compiled
from softway.laws.law import StoredEnergy
from softway.laws.strain_measures import Small
from softway.meshes.mesh import Mesh


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ElasticForce:
    """:class:`~softway.bodies.internal_force.body_force.BodyForce` of a body with a stored energy; built by
    :func:`elastic_force`.

    The displacement u is (n, d) [m].  The body has no material state and no viscosity.

    Parameters
    ----------
    material, section
        Material law, and section of the elements.
    plain
        Evaluation by arrays over all points.
    work
        Evaluation of energy, force and tangent: by kernels where the law has them, on a device if a march
        asks for it, otherwise by arrays.
    """

    material: StoredEnergy
    section: Section
    plain: ArrayEvaluation
    work: ArrayEvaluation | KernelEvaluation | DeviceEvaluation

    @property
    def linear(self) -> bool:
        """True if the tangent is constant."""
        return self.material.linear

    @property
    def path_dependent(self) -> bool:
        """False: the force depends on the displacement alone."""
        return False

    @property
    def state(self) -> None:
        """None: an elastic body has no material state."""

    @property
    def directions(self) -> Array:
        """(p, m, D) or (1, m, D) reference directions of the points."""
        return self.plain.points.directions

    @property
    def sampling(self) -> StrainOperator:
        """Strain operator between nodes and quadrature points."""
        return self.plain.sampling

    def during(self, state: MaterialState | None, span: float) -> "ElasticForce":
        """The force itself: it does not depend on the slab."""
        return self

    def transferred(self, piece: BodyForce, nodes: IntArray, points: IntArray) -> BodyForce:
        """The force ``piece`` itself: it does not depend on the slab."""
        return piece

    def energy(self, u: Array) -> float:
        """Stored energy [J]; infinite where the material is inverted."""
        return self.work.energy_and_force(u)[0]

    def force(self, u: Array) -> Array:
        """Derivative of the energy with respect to u, (n, d) [N]; ``nan`` where the material is inverted."""
        return self.work.energy_and_force(u)[1]

    def energy_and_force(self, u: Array) -> tuple[float, Array]:
        """:meth:`energy` [J] and :meth:`force` (n, d) [N] in one evaluation."""
        return self.work.energy_and_force(u)

    def end_force(self, u: Array) -> tuple[float, Array, None]:
        """:meth:`energy_and_force`, and None: the body has no viscosity."""
        return *self.work.energy_and_force(u), None

    def tangent(self, u: Array) -> csc_array:
        """Derivative of the force, (n d, n d) [N/m]; number of a component: ``node * d + component``."""
        return self.work.tangent(u)

    def secant(self, u: Array) -> csc_array:
        """:meth:`tangent` (n d, n d) [N/m]: the body has no viscosity."""
        return self.work.tangent(u)

    def viscous_tangent(self, u: Array) -> None:
        """None: the body has no viscosity."""

    def tangent_product(self, u: Array, w: Array) -> Array:
        """Product (n, d) [N] of the tangent at u with a change w (n, d) [m] of the displacement."""
        return self.work.tangent_product(u, w)

    def tangent_diagonal_blocks(self, u: Array) -> Array:
        """Diagonal blocks of the tangent, (n, d, d) [N/m], one for each node."""
        return self.work.tangent_diagonal_blocks(u)

    def slab_average(self, rule: SlabForce, u0: Array, u1: Array) -> Array | None:
        """Force averaged along the chord from u0 to u1 by a rule, (n, d) [N]; None for rules without a chord."""
        match rule:
            case AverageField(points=points):
                return self.average_force(u0, u1, points)
            case DiscreteGradient():
                return self.discrete_gradient(u0, u1)
            case _:
                return None

    def average_force(self, u0: Array, u1: Array, points: int) -> Array:
        """Force averaged along the chord from u0 to u1 by Gauss ``points``, (n, d) [N].

        Its work ``f . (u1 - u0)`` is the difference of the energies up to the quadrature.
        """
        return chord_average(self.force, u0, u1, points)

    def discrete_gradient(self, u0: Array, u1: Array) -> Array:
        """Force (n, d) [N] whose work ``f . (u1 - u0)`` is the difference of the energies up to rounding."""
        H0, H1 = self.plain.derivatives(u0), self.plain.derivatives(u1)
        return self.sampling.nodal(self.plain.points.discrete_flux(H0, H1), 0.5 * (u0 + u1))

    def committed(self, u: Array) -> None:
        """None: an elastic body has no material state."""

    def stored_energy(self, state: MaterialState | None, energy: float) -> float:
        """The ``energy`` [J] itself: all of it is stored."""
        return energy

    def dissipated_energy(self, state: MaterialState | None) -> float:
        """Zero [J]."""
        return 0.0

    def stored_force(self, state: MaterialState | None, u: Array) -> tuple[float, Array, None]:
        """Stored energy [J] and force (n, d) [N] at u; None for the viscous part."""
        return *self.work.energy_and_force(u), None

    def stored_viscous_force(self, state: MaterialState | None) -> None:
        """None: the body has no viscosity."""

    def stress(self, u: Array, state: MaterialState | None = None) -> Array:
        """Cauchy stress (e, 3, 3) [Pa], averaged over the present volume of each element, in the order of the blocks.

        Components are those of space; around an axis of revolution they are radial, axial, hoop.
        """
        sigma, ratio = self.plain.points.cauchy(self.plain.derivatives(u))
        return self.sampling.cell_means(sigma, ratio * self.sampling.volume)

    def stored_scalars(self, state: MaterialState | None) -> dict[str, Array]:
        """Empty: an elastic body has no material state."""
        return {}

    def volume_ratio(self, u: Array) -> float:
        """Least det F over all points; zero or less where the material is inverted."""
        return float(np.min(self.plain.points.volume_ratio(self.plain.derivatives(u))))


def elastic_force(mesh: Mesh, material: StoredEnergy, section: Section, dilatation: Dilating = "point") -> ElasticForce:
    """Build the :class:`ElasticForce` of a body.

    Examples
    --------
    >>> from softway.bodies.elements.section import Bar
    >>> from softway.laws.bulk import LinearElastic
    >>> mesh = Mesh(points=np.array([[0.0], [2.0]]), blocks={"bar2": np.array([[0, 1]])})
    >>> bar = elastic_force(mesh, LinearElastic(E=3.0), Bar(area=2.0))
    >>> bar.tangent(np.zeros((2, 1))).toarray().round(12).tolist()
    [[3.0, -3.0], [-3.0, 3.0]]
    """
    sampled = sampled_cells(mesh, section, dilatation, small=isinstance(material.measure, Small))
    points = MaterialPoints(law=material, free=free_axes(section), directions=sampled.directions)
    plain = ArrayEvaluation(sampling=sampled.sampling, points=points)
    fused = isinstance(section, FUSED_SECTIONS) and dilatation != "corner"
    law = compiled(material) if fused else None
    work: ArrayEvaluation | KernelEvaluation = plain
    if law is not None:
        needed: Rows = "elastic" if dilatation == "point" else "both"
        cells = kernel_cells(section, list(sampled.kinds), sampled.sampling.pattern, mesh.n_nodes, needed)
        mean = 0 if dilatation == "point" else averaged(section)
        work = KernelEvaluation(law=law, cells=cells, mean=mean, small=isinstance(material.measure, Small))
    return ElasticForce(material=material, section=section, plain=plain, work=work)
