"""Internal force of a body whose law has a history, during one slab."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csc_array

from softway.bodies.cells import Dilating, SampledCells, sampled_cells
from softway.bodies.fused_cells import FUSED_SECTIONS, fused_cells
from softway.bodies.memory import Memory, virgin
from softway.bodies.rate_fused import RateFused
from softway.bodies.rate_mean import RateMean
from softway.bodies.rate_plain import RatePlain
from softway.bodies.rate_points import RatePoints
from softway.bodies.sampling import Sampling
from softway.bodies.section import PlaneStrain, Section, free_axes
from softway.errors import InputError
from softway.kernels import tensors
from softway.laws.compiled import compiled_rate
from softway.laws.law import RateLaw
from softway.space.mesh import Mesh
from softway.typing import Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RateForce:
    """What a body with a ``memory`` answers to the displacement u (n, d) [m] at the end of a slab of length ``span``.

    During the slab it is a function of u alone, like the force of a body that stores energy; :meth:`settled` gives the
    memory for the slab after.

    Parameters
    ----------
    material, section
        Law, and how the cells fill space.
    plain
        The body as arrays over its points.
    work
        What computes forces, tangents and memories: kernels where the law has them, else the arrays.
    memory
        The past, up to the start of the slab.
    span
        Length of the slab [s].
    """

    material: RateLaw
    section: Section
    plain: RatePlain
    work: RatePlain | RateFused | RateMean
    memory: Memory
    span: float

    @property
    def linear(self) -> bool:
        """Never: the tangent depends on the past."""
        return False

    @property
    def sampling(self) -> Sampling:
        """From the nodes to the points and back."""
        return self.plain.sampling

    @property
    def points(self) -> RatePoints:
        """The points."""
        return self.plain.points

    @property
    def directions(self) -> Array:
        """(p, m, D) or (1, m, D) reference directions of the points."""
        return self.points.directions

    def during(self, memory: Memory, span: float) -> "RateForce":
        """The force in a slab that starts with a memory."""
        return replace(self, memory=memory, span=span)

    def energy_and_force(self, u: Array) -> tuple[float, Array]:
        """Energy [J] stored since the start, with what the slab dissipates, and the force (n, d) [N] at its end."""
        return self.work.energy_and_force(u, self.memory, self.span)

    def energy(self, u: Array) -> float:
        """See :meth:`energy_and_force`."""
        return self.energy_and_force(u)[0]

    def force(self, u: Array) -> Array:
        """Force (n, d) [N] at the end of the slab; ``nan`` where matter is inverted."""
        return self.energy_and_force(u)[1]

    def viscous_force(self, u: Array) -> Array | None:
        """The part of the force that belongs to the mean rate of the slab, (n, d) [N]; None where there is none."""
        return self.work.viscous_force(u, self.memory, self.span)

    def tangent(self, u: Array) -> csc_array:
        """Derivative of the force, (n d, n d) [N/m], made symmetric."""
        return self.work.tangent(u, self.memory, self.span)

    def secant(self, u: Array) -> csc_array:
        """The tangent with the viscosity held fixed, where the law has such moduli, (n d, n d) [N/m]."""
        return self.work.secant(u, self.memory, self.span)

    def viscous_tangent(self, u: Array) -> csc_array | None:
        """Derivative of :meth:`viscous_force` on the pattern of the tangent, (n d, n d) [N/m]; None without."""
        return self.plain.viscous_tangent(u, self.memory, self.span)

    def tangent_product(self, u: Array, w: Array) -> Array:
        """The tangent at u times a change w (n, d) [m] of the displacement, (n, d) [N]."""
        return self.work.tangent_product(u, self.memory, self.span, w)

    def tangent_diagonal_blocks(self, u: Array) -> Array:
        """Blocks of the tangent that couple each node with itself, (n, d, d) [N/m]."""
        return self.work.tangent_diagonal_blocks(u, self.memory, self.span)

    def settled(self, u: Array) -> Memory:
        """The memory at the end of the slab."""
        return self.work.settled(u, self.memory, self.span)

    def stored(self, memory: Memory) -> float:
        """Energy stored since the start [J]."""
        return float(self.sampling.volume @ memory.stored)

    def dissipated(self, memory: Memory) -> float:
        """Energy dissipated since the start [J]."""
        return float(self.sampling.volume @ memory.dissipated)

    def stress(self, u: Array) -> Array:
        """Cauchy stress (e, 3, 3) [Pa] at the end of the slab, mean over the present volume of each cell."""
        _, found = self.plain.answer(u, self.memory, self.span)
        sigma = self.points.stress(found)
        return self.sampling.cell_means(sigma, tensors.determinant(found.F) * self.sampling.volume)

    def remembered(self, memory: Memory) -> tuple[float, Array, Array | None]:
        """Stored energy [J], force and its viscous part (n, d) [N] at the time of a memory."""
        return self.work.remembered(memory)

    def remembered_stress(self, memory: Memory) -> Array:
        """Cauchy stress (e, 3, 3) [Pa] of a memory, mean over the present volume of each cell."""
        F = self.points.gradient(self.sampling.derivatives(memory.displacement), memory.lateral)
        return self.sampling.cell_means(memory.stress, tensors.determinant(F) * self.sampling.volume)

    def remembered_scalars(self, memory: Memory) -> dict[str, Array]:
        """What a memory holds for each cell (e,), means over its reference volume: ``dissipation`` since the start
        [J/m^3] and every scalar of the law.
        """
        scalars = {name: values for name, values in memory.law.items() if values.ndim == 1}
        found = {**scalars, "dissipation": memory.dissipated}
        return {name: self.sampling.cell_means(values, self.sampling.volume) for name, values in found.items()}

    def volume_ratio(self, u: Array) -> float:
        """Least det F over all points; zero or less where matter is inverted."""
        H = self.sampling.derivatives(u)
        return float(np.min(tensors.determinant(self.points.gradient(H, self.memory.lateral))))


def rate_force(mesh: Mesh, material: RateLaw, section: Section, dilatation: Dilating = "point") -> RateForce:
    """The :class:`RateForce` of a body to which nothing has happened.

    Raises
    ------
    InputError
        In plates that stand in space: their axes are those of the plane.
    """
    sampled = sampled_cells(mesh, section, dilatation, small=False)
    m, size = sampled.directions.shape[-2:]
    if 1 < m < size:
        problem = f"{type(material).__name__} in a plate that stands in space"
        raise InputError("section", problem, "a law that stores energy, or a plate in the plane")
    free = free_axes(section)
    points = len(sampled.sampling.volume)
    plain = RatePlain(
        sampling=sampled.sampling, points=RatePoints(law=material, free=free, directions=sampled.directions)
    )
    return RateForce(
        material=material,
        section=section,
        plain=plain,
        work=_work(plain, sampled, dilatation, mesh.n_nodes),
        memory=virgin(material.virgin(points), (mesh.n_nodes, mesh.dim), points, len(free)),
        span=1.0,
    )


def _work(plain: RatePlain, sampled: SampledCells, dilatation: Dilating, n: int) -> RatePlain | RateFused | RateMean:
    """Kernels for a body on n nodes if there are any, else the arrays."""
    section, pattern = plain.sampling.section, plain.sampling.pattern
    law = compiled_rate(plain.points.law)
    if law is None or dilatation == "corner" or not isinstance(section, FUSED_SECTIONS):
        return plain
    cells, volume = fused_cells(section, list(sampled.kinds), pattern, n, past=True), plain.sampling.volume
    if dilatation == "point":
        return RateFused(law=law, cells=cells, volume=volume)
    m = 2 if isinstance(section, PlaneStrain) else 3
    return RateMean(kernels=RateFused(law=law, cells=cells, volume=volume, mean=m), arrays=plain)
