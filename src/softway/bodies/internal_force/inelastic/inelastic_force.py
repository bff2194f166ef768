"""Internal force of a body with a path-dependent law, in one slab."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csc_array

from softway.arrays import Array, IntArray
from softway.bodies.elements.kernel_cells import FUSED_SECTIONS, averaged, kernel_cells
from softway.bodies.elements.quadrature import Dilating, SampledCells, sampled_cells
from softway.bodies.elements.section import Section, free_axes
from softway.bodies.elements.strain_operator import StrainOperator
from softway.bodies.internal_force.body_force import BodyForce
from softway.bodies.internal_force.inelastic.array_evaluation import RateArrayEvaluation
from softway.bodies.internal_force.inelastic.eigenstrain import free_strain_moduli
from softway.bodies.internal_force.inelastic.kernel_evaluation import RateKernelEvaluation
from softway.bodies.internal_force.inelastic.material_points import RatePoints
from softway.bodies.internal_force.material_state import MaterialState, initial_history
from softway.bodies.internal_force.slab_average import SlabForce
from softway.errors import InputError
from softway.kernels.linalg import tensors
from softway.laws.kernel_laws import compiled_rate
from softway.laws.law import RateLaw
from softway.meshes.mesh import Mesh


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class InelasticForce:
    """:class:`~softway.bodies.internal_force.body_force.BodyForce` of a body with a path-dependent law, in one time
    step (slab).

    Within the slab it is a function of the displacement u (n, d) [m] at the end alone, as the force of an elastic body
    is; :meth:`committed` gives the material state for the next slab.  Built by :func:`inelastic_force`.

    Parameters
    ----------
    material, section
        Material law, and section of the elements.
    plain
        Evaluation by arrays over all points.
    work
        Evaluation of forces, tangents and material states: by kernels where the law has them, otherwise by arrays.
    state
        Material state at the start of the slab.
    span
        Length of the slab [s].
    """

    material: RateLaw
    section: Section
    plain: RateArrayEvaluation
    work: RateArrayEvaluation | RateKernelEvaluation
    state: MaterialState
    span: float

    @property
    def linear(self) -> bool:
        """False: the tangent depends on the material state."""
        return False

    @property
    def path_dependent(self) -> bool:
        """True: the force depends on the material state."""
        return True

    @property
    def sampling(self) -> StrainOperator:
        """Strain operator between nodes and quadrature points."""
        return self.plain.sampling

    @property
    def points(self) -> RatePoints:
        """Material points."""
        return self.plain.points

    @property
    def directions(self) -> Array:
        """(p, m, D) or (1, m, D) reference directions of the points."""
        return self.points.directions

    def during(self, state: MaterialState | None, span: float) -> "InelasticForce":
        """Force in a slab of length ``span`` [s] that starts from a state; the force itself without one.

        Kernels do not know a factor of the moduli.
        """
        if state is None:
            return self
        return replace(self, state=state, span=span, work=self.work if state.stiffness is None else self.plain)

    def transferred(self, piece: BodyForce, nodes: IntArray, points: IntArray) -> BodyForce:
        """Force ``piece`` of some nodes (k,) and points (q,) of the body, in the slab of this force."""
        return piece.during(self.state.part(nodes, points), self.span)

    def energy_and_force(self, u: Array) -> tuple[float, Array]:
        """Stored energy plus the energy dissipated in the slab [J], and the force (n, d) [N] at the end of the slab."""
        return self.work.energy_and_force(u, self.state, self.span)

    def energy(self, u: Array) -> float:
        """Energy of :meth:`energy_and_force` [J]; infinite where the material is inverted."""
        return self.energy_and_force(u)[0]

    def force(self, u: Array) -> Array:
        """Force (n, d) [N] at the end of the slab; ``nan`` where the material is inverted."""
        return self.energy_and_force(u)[1]

    def end_force(self, u: Array) -> tuple[float, Array, Array | None]:
        """Energy [J] and force of :meth:`energy_and_force`, and the part of the force due to the mean rate of the slab,
        (n, d) [N], None without viscosity, in one evaluation.
        """
        return self.work.end_force(u, self.state, self.span)

    def slab_average(self, rule: SlabForce, u0: Array, u1: Array) -> None:
        """None: the force is not averaged along a chord."""

    def tangent(self, u: Array) -> csc_array:
        """Derivative of the force, made symmetric, (n d, n d) [N/m]."""
        return self.work.tangent(u, self.state, self.span)

    def secant(self, u: Array) -> csc_array:
        """Tangent at fixed viscosity where the law has such moduli, otherwise :meth:`tangent`, (n d, n d) [N/m]."""
        return self.work.secant(u, self.state, self.span)

    def viscous_tangent(self, u: Array) -> csc_array | None:
        """Derivative of the viscous part of the force on the pattern of the tangent, (n d, n d) [N/m]; None without."""
        return self.plain.viscous_tangent(u, self.state, self.span)

    def tangent_product(self, u: Array, w: Array) -> Array:
        """Product (n, d) [N] of the tangent at u with a change w (n, d) [m] of the displacement."""
        return self.work.tangent_product(u, self.state, self.span, w)

    def tangent_diagonal_blocks(self, u: Array) -> Array:
        """Diagonal blocks of the tangent, (n, d, d) [N/m], one for each node."""
        return self.work.tangent_diagonal_blocks(u, self.state, self.span)

    def committed(self, u: Array) -> MaterialState:
        """Material state at the end of the slab."""
        return self.work.committed(u, self.state, self.span)

    def stored_energy(self, state: MaterialState | None, energy: float) -> float:
        """Stored energy [J] in a committed state; ``energy`` [J] without one."""
        return energy if state is None else float(self.sampling.volume @ state.stored)

    def dissipated_energy(self, state: MaterialState | None) -> float:
        """Energy dissipated from the start of the march up to a committed state [J]; zero without one."""
        return 0.0 if state is None else float(self.sampling.volume @ state.dissipated)

    def stored_force(self, state: MaterialState | None, u: Array) -> tuple[float, Array, Array | None]:
        """Stored energy [J], force (n, d) and its viscous part (n, d) or None [N], of a committed state at u."""
        return (*self.energy_and_force(u), None) if state is None else self.work.stored_force(state)

    def stored_viscous_force(self, state: MaterialState | None) -> Array | None:
        """Viscous part of the force in a committed state, (n, d) [N]; None without viscosity."""
        return None if state is None or state.viscous is None else self.work.stored_force(state)[2]

    def stress(self, u: Array, state: MaterialState | None = None) -> Array:
        """Cauchy stress (e, 3, 3) [Pa] at the end of the slab, or in a committed state, averaged over each element.

        The average is over the present volume; elements are in the order of the blocks.
        """
        if state is None:
            _, found = self.plain.response(u, self.state, self.span)
            sigma, F = self.points.stress(found), found.F
        else:
            sigma = state.stress
            F = self.points.gradient(self.sampling.derivatives(state.displacement), state.lateral)
        return self.sampling.cell_means(sigma, tensors.determinant(F) * self.sampling.volume)

    def stored_scalars(self, state: MaterialState | None) -> dict[str, Array]:
        """Scalars (e,) of a committed state by name, averaged over the reference volume of each element.

        These are ``dissipation`` since the start of the march [J/m^3] and every scalar of the law; none without a
        state.
        """
        if state is None:
            return {}
        scalars = {name: values for name, values in state.law.items() if values.ndim == 1}
        found = {**scalars, "dissipation": state.dissipated}
        return {name: self.sampling.cell_means(values, self.sampling.volume) for name, values in found.items()}

    def volume_ratio(self, u: Array) -> float:
        """Least det F over all points; zero or less where the material is inverted."""
        H = self.sampling.derivatives(u)
        return float(np.min(tensors.determinant(self.points.gradient(H, self.state.lateral))))


def inelastic_force(mesh: Mesh, material: RateLaw, section: Section, dilatation: Dilating = "point") -> InelasticForce:
    """Build the :class:`InelasticForce` of a body in its initial material state.

    Raises
    ------
    InputError
        For two-dimensional elements in three-dimensional space: the law needs the axes of the plane.
    """
    sampled = sampled_cells(mesh, section, dilatation, small=False)
    m, size = sampled.directions.shape[-2:]
    if 1 < m < size:
        problem = f"{type(material).__name__} in a plate that stands in space"
        raise InputError("section", problem, "a law that stores energy, or a plate in the plane")
    free = free_axes(section)
    points = len(sampled.sampling.volume)
    law_points = RatePoints(
        law=material, free=free, directions=sampled.directions,
        moduli_of_free_strain=free_strain_moduli(material, free) if free else None,
    )  # fmt: skip
    plain = RateArrayEvaluation(sampling=sampled.sampling, points=law_points)
    return InelasticForce(
        material=material,
        section=section,
        plain=plain,
        work=_work(plain, sampled, dilatation, mesh.n_nodes),
        state=initial_history(material.virgin(points), (mesh.n_nodes, mesh.dim), points, len(free)),
        span=1.0,
    )


def _work(
    plain: RateArrayEvaluation, sampled: SampledCells, dilatation: Dilating, n: int
) -> RateArrayEvaluation | RateKernelEvaluation:
    """Evaluation of a body on n nodes: by kernels if there are any, otherwise by arrays."""
    section, pattern = plain.sampling.section, plain.sampling.pattern
    law = compiled_rate(plain.points.law)
    if law is None or dilatation == "corner" or not isinstance(section, FUSED_SECTIONS):
        return plain
    cells, volume = kernel_cells(section, list(sampled.kinds), pattern, n, "natural"), plain.sampling.volume
    mean = 0 if dilatation == "point" else averaged(section)
    return RateKernelEvaluation(law=law, cells=cells, volume=volume, mean=mean)
