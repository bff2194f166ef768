"""Model: constant data of a march as arrays."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.assembled.following_nodes import driven_field
from softway.bodies.assembled.material_states import MaterialStates, any_path_dependent, during, end_force, scaled
from softway.bodies.assembled.nodal_loads import DeadLoads
from softway.bodies.assembled.tangent import assembled_tangent
from softway.bodies.assembled.vector_space import VectorSpace
from softway.bodies.discretised import DiscreteSolid, Moved
from softway.bodies.dof_map import DofMap, MatrixSum
from softway.bodies.internal_force.material_state import MaterialState
from softway.bodies.internal_force.node_factors import scaled_blocks, scaled_product
from softway.bodies.rigid_motion import CarriedNodes, RigidMotion, RigidShape
from softway.bodies.solid import Tool
from softway.contact.contact_rows import ContactRows
from softway.contact.contact_set import ContactSet
from softway.contact.friction_rows import FrictionRows
from softway.contact.impact_rule import ImpactRule
from softway.meshes.adaptive.refinement import AdaptedMesh
from softway.meshes.mesh import Mesh
from softway.meshes.remeshed.remeshed_mesh import RemeshedMesh
from softway.model.cohesive_ties import CohesiveTies, damaged
from softway.model.field import Field, FieldEquations, FieldState, stiffness_factor
from softway.model.rigid.rigid_bodies import RigidBodies
from softway.model.scene import Scene


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Model:
    """Constant data of a march; nodal fields are (n, d) over all solids in order.

    Parameters
    ----------
    parts
        The solids.
    mass
        (n, n) nodal mass matrix; massless contact nodes of the Energy rule have empty rows.
    follow, passing
        (n, n) velocities of all nodes from those with inertia, as massless nodes follow their neighbours; its
        transpose, by which forces on massless nodes act on the nodes that they follow.
    massive, inert
        (n,) nodes with inertia; True if there is one.
    part_of
        (n,) number of the solid of each node.
    dofs
        Velocities of the nodes from the unknowns.
    linked
        (parts,) number of the group of each solid; solids that share unknowns form a group.
    load, load_before
        (n, d) dead loads of a slab [N]: mean loads on nodes with inertia; on massless nodes the loads at its end, and
        at its start.
    loads
        Loads as functions of time.
    weight
        (n,) nodal mass for the weight [kg].
    displacement, velocity
        (n, d) given initial fields.
    contacts
        The contacts.
    contact_solids
        Numbers of the solids of each contact.
    against_tool
        (contacts,) True for contacts with a tool or a rigid body.
    touchable
        (k,) nodes that may come into contact.
    edge
        (n,) shortest edge at each node [m].
    driven
        Driven supports, and nodes that rigid bodies carry, with the components (n, d) that they move.
    floor
        (parts,) stored energy below which a body is undeformed: a uniform strain of 1e-14 [J].
    total
        Assembly of mass plus tangent stiffness on the unknowns.
    timing, friction
        Impact rule of the scene, and friction laws of the contact rows.
    space
        Sums, inner products and greatest values of nodal fields.
    companions
        Equations of the fields that are solved together with the displacement.
    tools
        Tools, and shapes of rigid bodies in their motions, by name.
    rigid
        Rigid bodies; None without.
    declared
        Number in the scene as it was given of each contact.
    adapted, remeshed
        Meshes of the solids whose meshes adapt in a march, and of those whose meshes are replaced, by name.
    """

    scene: Scene
    parts: tuple[DiscreteSolid, ...]
    mass: sp.csr_array
    follow: sp.csr_array
    passing: sp.csr_array
    massive: BoolArray
    inert: bool
    part_of: IntArray
    dofs: DofMap
    linked: IntArray
    load: Array
    load_before: Array
    loads: DeadLoads
    weight: Array
    displacement: Array
    velocity: Array
    contacts: ContactSet
    contact_solids: tuple[tuple[int, ...], ...]
    against_tool: BoolArray
    touchable: IntArray
    edge: Array
    driven: tuple[Moved, ...]
    floor: Array
    total: MatrixSum
    timing: ImpactRule
    friction: FrictionRows
    space: VectorSpace
    companions: tuple[FieldEquations, ...] = ()
    tools: Mapping[str, Tool | RigidShape] = field(default_factory=dict)
    rigid: RigidBodies | None = None
    declared: tuple[int, ...] = ()
    adapted: Mapping[str, AdaptedMesh] = field(default_factory=dict)
    remeshed: Mapping[str, RemeshedMesh] = field(default_factory=dict)

    @property
    def free(self) -> BoolArray:
        """Components (n, d) without support."""
        return self.dofs.free

    def supported(self, field: Array) -> Array:
        """Part (n, d) of a field (n, d) along the directions that supports hold or drive."""
        return self.dofs.supported(field)

    @property
    def fields(self) -> tuple[Field, ...]:
        """Displacement and companion fields."""
        displacement = Field(name="displacement", unit="m", components=self.shape[1])
        return (displacement, *(c.field for c in self.companions))

    @property
    def shape(self) -> tuple[int, int]:
        """Shape (n, d) of the nodal fields."""
        return self.free.shape[0], self.free.shape[1]

    @property
    def points(self) -> Array:
        """Reference positions (n, d) [m]."""
        return self.contacts.points

    def rows(self, u: Array, time: float = 0.0) -> ContactRows:
        """Contact rows of the bodies at rest at the displacement ``u`` (n, d)."""
        return self.contacts.rest(u, time).at(u)

    def wave_speed(self, part: DiscreteSolid) -> float:
        """Speed of the fastest wave in a solid with its scaled masses [m/s]; that of full inertia without inertia."""
        return max(part.materials.speeds(part.internal.section, self.scene.inertia.factor if self.inert else 1.0))

    def prescribed(self, time: float) -> Array:
        """Velocity (n, d) of the driven components at a time [m/s]; zero on all others."""
        out = np.zeros(self.shape)
        for support, where in self.driven:
            out[where] = support.at(time)
        return driven_field(self.parts, self.dofs, out)

    def bends(self, start: float, end: float) -> tuple[tuple[float, Array], ...]:
        """Bends of the prescribed velocities inside a slab, see
        :class:`~softway.contact.slab_motion.trajectory.Trajectory`; later supports have precedence.
        """
        found: list[tuple[float, Array]] = []
        for support, where in self.driven:
            for _, earlier in found:
                earlier[where] = 0.0
            for tau, change in support.bends(start, end):
                found.append((tau, np.zeros(self.shape)))
                found[-1][1][where] = change
        return tuple((tau, driven_field(self.parts, self.dofs, change)) for tau, change in found)

    @property
    def meshes(self) -> Mapping[str, Mesh]:
        """Mesh of each solid."""
        return {p.name: p.mesh for p in self.parts}

    @property
    def linear(self) -> bool:
        """True if the forces of all solids are linear in the displacement, and no tie breaks."""
        return all(p.internal.linear and p.factor is None for p in self.parts) and not self.bonds

    @property
    def bonds(self) -> tuple[CohesiveTies, ...]:
        """Ties that break, with their damage at the start of the slab; empty without."""
        return tuple(c for c in self.companions if isinstance(c, CohesiveTies))

    def bonded(self, fields: tuple[FieldState, ...]) -> "Model":
        """Model in a slab that starts with companion ``fields``: ties have their damage, solids their stiffness."""
        if not (self.companions and fields):
            return self
        parts = scaled(self.parts, stiffness_factor(self.companions, fields))
        return replace(self, parts=parts, companions=damaged(self.companions, fields))

    def stress(self, name: str, u: Array, memory: MaterialState | None = None) -> Array:
        """Mean Cauchy stress (cells, 3, 3) of the solid ``name`` at its displacement ``u`` or from its memory [Pa]."""
        return next(p.internal for p in self.parts if p.name == name).stress(u, memory)

    def during(self, memory: MaterialStates, span: float) -> "Model":
        """Model in a slab of length ``span`` [s], with the material states at its start."""
        return replace(self, parts=during(self.parts, memory, span)) if any_path_dependent(self.parts) else self

    def pushed(self, start: float, end: float) -> "Model":
        """Model in a slab from ``start`` to ``end`` [s], with its loads."""
        if self.loads.steady:
            return self
        mean, still = self.loads.mean(start, end), ~self.massive[:, None]
        before, after = (np.where(still, self.loads.at(t), mean) for t in (start, end))
        return replace(self, load=after, load_before=before)

    def with_motions(self, motions: Mapping[str, RigidMotion]) -> "Model":
        """Model whose rigid bodies have these motions."""
        shapes = {} if self.rigid is None else self.rigid.shapes(motions)
        driven = tuple(
            (replace(s, motion=motions[s.by]) if isinstance(s, CarriedNodes) else s, where) for s, where in self.driven
        )
        contacts = self.contacts.with_shapes(shapes)
        return replace(self, tools={**self.tools, **shapes}, contacts=contacts, driven=driven)

    def slab_load(self, scalar: Array) -> Array:
        """Mean loads (n, d) over the slab; the scalars (parts,) weight the ends for massless nodes [N]."""
        if self.loads.steady:
            return self.load
        a = self.nodal(np.asarray(scalar))
        return (0.5 - a) * self.load_before + (0.5 + a) * self.load

    def split(self, field: Array) -> dict[str, Array]:
        """Field of each solid by name."""
        return {p.name: field[p.nodes] for p in self.parts}

    def join(self, fields: Mapping[str, Array]) -> Array:
        """Field over all nodes from the fields of the solids."""
        return np.concatenate([fields[p.name] for p in self.parts])

    def extent(self, u: Array) -> float:
        """Greatest coordinate [m] at the displacement ``u`` (n, d), the scale of rounding."""
        return self.space.greatest(self.points + u)

    def nodal(self, values: Array) -> Array:
        """Values (parts,) of the solids on their nodes, (n, 1)."""
        return np.repeat(values, [p.mesh.n_nodes for p in self.parts])[:, None]

    def energy_and_force(self, u: Array) -> tuple[Array, Array]:
        """Stored energy of each solid (parts,) [J] and internal force (n, d) [N]."""
        return end_force(self.parts, u)[:2]

    def force(self, u: Array) -> Array:
        """Internal force (n, d) [N]."""
        return np.concatenate([p.internal.force(u[p.nodes]) for p in self.parts])

    def tangent(self, u: Array) -> sp.csc_array:
        """Tangent stiffness (n d, n d) [N/m]."""
        return assembled_tangent(self.parts, u)

    def inertia_and_stiffness(
        self, u: Array, factor: float, secant: bool = False, viscous_factor: float = 0.0
    ) -> sp.csc_array:
        """``M + factor K(u)`` (f, f) on the unknowns, K of tangent or secant moduli.

        ``viscous_factor`` is the additional weight of the viscous stiffness.
        """
        values = [p.stiffness(u[p.nodes], secant, viscous_factor) for p in self.parts]
        values += [bond.stiffness(u).ravel() for bond in self.bonds]
        return self.total.of(np.concatenate(values), factor)

    def tangent_product(self, u: Array, w: Array) -> Array:
        """Product (n, d) of the tangent stiffness with a field (n, d) [N]."""
        out = np.concatenate([scaled_product(p.internal, p.factor, u[p.nodes], w[p.nodes]) for p in self.parts])
        return sum((bond.tangent_product(u, w) for bond in self.bonds), out)

    def tangent_blocks(self, u: Array) -> Array:
        """Diagonal blocks (n, d, d) of the tangent stiffness [N/m]."""
        out = np.concatenate([scaled_blocks(p.internal, p.factor, u[p.nodes]) for p in self.parts])
        return sum((bond.tangent_blocks(u) for bond in self.bonds), out)

    def shock_force(self, middle: Array, change: Array, span: float) -> Array | None:
        """Force (n, d) of the bulk viscosities [N] in a slab, see
        :class:`~softway.bodies.bulk_viscosity.BulkViscosityForce`; None without.

        The forces of massless nodes act on the nodes that they follow.
        """
        if all(p.shock is None for p in self.parts):
            return None
        out = np.concatenate([p.shock_force(middle[p.nodes], change[p.nodes], span) for p in self.parts])
        own = out * self.massive[:, None]
        return np.asarray(own + self.passing @ (out - own))

    def kinetic(self, v: Array) -> Array:
        """Kinetic energy of each solid (parts,) [J]."""
        return 0.5 * self.space.totals(v * (self.mass @ v))
