"""Solid on an adapted mesh: its tables, and its inertia as in a march."""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.bodies.assembled.nodal_masses import Massless, inertia_of
from softway.bodies.discretised import DiscreteSolid, discretise
from softway.bodies.dof_map import DofMap
from softway.bodies.elements.section import Section
from softway.bodies.inertia.mass_matrix import Consistent, body_of, cell_masses
from softway.bodies.inertia.mass_redistribution import CELLS
from softway.bodies.internal_force.node_factors import scaled_product
from softway.bodies.setup.placement import Placement
from softway.bodies.solid import Solid
from softway.meshes.adaptive.refinement import AdaptedMesh


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AdaptedSolid:
    """Solid of n nodes in d dimensions on an adapted mesh.

    Parameters
    ----------
    solid
        The solid, with its base mesh in its place in the scene.
    adapted
        The mesh.
    part
        Tables of the solid on the mesh.
    mass
        (n, n) nodal mass matrix of the march; massless nodes have empty rows [kg].
    follow
        (n, n) velocities of all nodes from those with mass.
    """

    solid: Solid
    adapted: AdaptedMesh
    part: DiscreteSolid
    mass: sp.csr_array
    follow: sp.csr_array

    @property
    def points(self) -> Array:
        """Reference places (n, d) of the nodes [m]."""
        return self.part.mesh.points

    @property
    def dofs(self) -> DofMap:
        """Velocities of the nodes from the unknowns."""
        return self.part.dofs

    @property
    def section(self) -> Section:
        """Section of the solid."""
        return self.part.internal.section

    @property
    def crossing(self) -> float:
        """Time in which the slowest wave crosses the solid [s]."""
        return float(np.linalg.norm(np.ptp(self.points, axis=0))) / min(self.part.materials.speeds(self.section))

    def kinetic(self, velocity: Array) -> float:
        """Kinetic energy [J] at a velocity (n, d) [m/s]."""
        return 0.5 * float((velocity * (self.mass @ velocity)).sum())

    def following(self, velocity: Array) -> Array:
        """Velocity (n, d) in which massless nodes move as the nodes behind them, but for their supports."""
        moved = np.asarray(self.follow @ velocity)
        return np.asarray(moved + self.part.dofs.supported(velocity - moved))

    def fitting(self, field: Array) -> Array:
        """The field (n, d), which fits the unknowns and the supports where its values do."""
        return field

    def stretched(self, field: Array) -> Array:
        """Forces (n, d) of a small displacement (n, d) of the undeformed solid [N]."""
        return scaled_product(self.part.internal, self.part.factor, np.zeros_like(field), field)

    def stiffness(self) -> sp.csc_array:
        """Stiffness (n d, n d) of the undeformed solid [N/m]."""
        return self.part.tangent(np.zeros(self.points.shape))

    def consistent_mass(self) -> sp.csr_array:
        """Consistent mass matrix (n, n) [kg]."""
        mesh, pattern = self.adapted.mesh, self.part.internal.sampling.pattern
        return pattern.nodal([self.element_masses()], mesh.dim)

    def element_masses(self) -> Array:
        """Consistent mass matrices (e, a, a) of the elements [kg]."""
        body = body_of(self.adapted.mesh, self.part.internal.section, self.part.materials.density)
        ((_, masses),) = cell_masses(body, Consistent(), np.ones(self.adapted.mesh.n_nodes))
        return masses


def adapted_solid(
    name: str, solid: Solid, adapted: AdaptedMesh, light: IntArray, spread: int = CELLS, factor: float = 1.0
) -> AdaptedSolid:
    """Solid on an adapted mesh, whose base is the mesh of the solid in its place in the scene.

    Parameters
    ----------
    name
        Name of the solid in the scene.
    solid
        The solid; its mesh and its placements are not looked at.
    adapted
        Its mesh.
    light
        (k,) massless nodes.
    spread
        Layers of elements that take their mass.
    factor
        Factor of the masses.

    Raises
    ------
    InputError
        As for a solid on any mesh: tags without nodes, no node left for the mass.

    Examples
    --------
    >>> import softway as sw
    >>> from softway.meshes.adaptive.refinement import refined
    >>> bar = sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=4), material=sw.LinearElastic(E=1.0), density=2.0)
    >>> fine = refined(bar.mesh.build(), np.array([0, 0, 0, 2]))
    >>> found = adapted_solid("bar", bar, fine, fine.mesh.nodes("right"))
    >>> round(float(found.mass.sum()), 12), float(found.mass.sum(axis=1)[fine.mesh.nodes("right")[0]])
    (2.0, 0.0)
    """
    placed = replace(solid, mesh=adapted.mesh, place=Placement(), group=())
    part = discretise(name, placed, 0)
    masses = Massless(np.asarray(light, dtype=np.int64), np.zeros(0, dtype=np.int64), spread)
    mass, _, follow = inertia_of((part,), {name: placed}, masses, factor)
    return AdaptedSolid(solid=placed, adapted=adapted, part=part, mass=mass, follow=follow)
