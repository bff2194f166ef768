"""Discretised solid: mesh in place, internal force, supports and initial fields."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csc_array

from softway.arrays import Array, BoolArray
from softway.bodies.bulk_viscosity import BulkViscosityForce, bulk_viscosity_force
from softway.bodies.dof_map import DofMap
from softway.bodies.elements.quadrature import Dilating
from softway.bodies.elements.section import default_section
from softway.bodies.internal_force.assembled import internal_force
from softway.bodies.internal_force.body_force import BodyForce
from softway.bodies.internal_force.material_state import MaterialState
from softway.bodies.internal_force.materials import Materials, materials_of
from softway.bodies.internal_force.node_factors import scaled_matrix
from softway.bodies.internal_force.slab_average import SlabForce
from softway.bodies.rigid_motion import CarriedNodes, RigidMotion
from softway.bodies.setup.directions import (
    DirectedMotion,
    Held,
    directed,
    directed_motion,
    directions,
    held_directions,
    solid_dofs,
    with_hanging,
)
from softway.bodies.setup.initial_fields import sample
from softway.bodies.setup.placement import in_place
from softway.bodies.solid import Carried, Driven, Fixed, Guided, Solid, Support
from softway.errors import InputError, within
from softway.meshes.cells import CELLS
from softway.meshes.mesh import Mesh

MOVING = Driven, Guided, Carried
"""Supports that move their nodes."""
UNSTRAINED = 1e-14
"""Strain below which a body is taken as undeformed."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DiscreteSolid:
    """Discretised solid of n nodes in d dimensions.

    Parameters
    ----------
    name
        Name of the solid in the scene.
    mesh
        Mesh, placed in the scene.
    nodes
        Nodes of the solid among the nodes of the model.
    internal
        Internal force.
    materials
        Laws and densities.
    dofs
        Velocities of its nodes from its unknowns.
    average
        Average of the internal force over a slab.
    dilatation
        Average of the volume change in the elements.
    shock
        Bulk viscosity; None without.
    factor
        (n,) factor of the stiffness at the nodes, which a companion field gives the forces; None without.
    """

    name: str
    mesh: Mesh
    nodes: slice
    internal: BodyForce
    materials: Materials
    dofs: DofMap
    average: SlabForce
    dilatation: Dilating = "point"
    shock: BulkViscosityForce | None = None
    factor: Array | None = None

    def shock_force(self, middle: Array, change: Array, span: float) -> Array:
        """Force (n, d) of the bulk viscosity [N], zero without; arguments as for :meth:`BulkViscosityForce.force`."""
        return np.zeros_like(middle) if self.shock is None else self.shock.force(self.internal, middle, change, span)

    def stiffness(self, u: Array, secant: bool, viscous_factor: float) -> Array:
        """Entries of the tangent stiffness on its pattern, or of the secant stiffness where the law has one [N/m].

        Parameters
        ----------
        u
            (n, d) displacement of the solid [m].
        secant
            True for secant moduli.
        viscous_factor
            Factor of the viscous tangent that is added.
        """
        values = np.asarray((scaled_matrix(self.internal.secant(u), self.factor) if secant else self.tangent(u)).data)
        viscous = self.internal.viscous_tangent(u) if viscous_factor > 0.0 else None
        if viscous is None:
            return values
        return np.asarray(values + viscous_factor * scaled_matrix(viscous, self.factor).data)

    def tangent(self, u: Array) -> csc_array:
        """Tangent stiffness (n d, n d) [N/m]."""
        return scaled_matrix(self.internal.tangent(u), self.factor)

    def floor(self) -> float:
        """Stored energy below which the solid is taken as undeformed [J]."""
        density, speed = self.materials.stiffest(self.internal.section)
        return float(UNSTRAINED**2 * density * speed**2 * self.internal.sampling.volume.sum())

    def during(self, state: MaterialState | None, span: float) -> "DiscreteSolid":
        """Solid in a slab of length ``span`` [s] that starts from a material state; the solid itself without one."""
        return self if state is None else replace(self, internal=self.internal.during(state, span))


def discretise(name: str, solid: Solid, first: int) -> DiscreteSolid:
    """Discretise a solid whose nodes are numbered from ``first``."""
    with within("mesh"):
        mesh = solid.mesh if isinstance(solid.mesh, Mesh) else solid.mesh.build()
    mesh = in_place(mesh, solid.mesh, (solid.place, *solid.group), solid.adapt, solid.section)
    section = default_section(mesh) if solid.section is None else solid.section
    if solid.dilatation == "mean" and any(CELLS[cell].order > 1 for cell in mesh.blocks):
        problem = (
            "'mean' with quadratic elements: one mean per element leaves some of their deformations without stiffness"
        )
        raise InputError("dilatation", problem, "'corner'")
    materials = materials_of(mesh, solid.material, solid.density)
    internal = internal_force(mesh, materials, section, solid.dilatation)
    nodes = slice(first, first + mesh.n_nodes)
    with within("shock"):
        shock = bulk_viscosity_force(solid.shock, mesh, materials, internal)
    return DiscreteSolid(
        name=name,
        mesh=mesh,
        nodes=nodes,
        internal=internal,
        materials=materials,
        dofs=dofs_of(solid.supports, mesh),
        average=solid.force,
        dilatation=solid.dilatation,
        shock=shock,
    )


def initial(part: DiscreteSolid, solid: Solid) -> tuple[Array, Array]:
    """Initial displacement [m] and velocity [m/s] (n, d); hanging nodes follow their parents."""
    with within(f"bodies.{part.name}.displacement"):
        displacement = sample(solid.displacement, part.mesh)
    with within(f"bodies.{part.name}.velocity"):
        velocity = sample(solid.velocity, part.mesh)
    hanging = part.mesh.hanging
    return (
        (displacement, velocity) if hanging is None else (hanging.following(displacement), hanging.following(velocity))
    )


def dofs_of(supports: tuple[Support, ...], mesh: Mesh) -> DofMap:
    """Degrees of freedom of a mesh with these supports; errors as of :func:`free_components`."""
    own = solid_dofs(_held(supports, mesh), free_components(supports, mesh))
    return own if mesh.hanging is None else with_hanging(own, mesh.hanging.follow(mesh.n_nodes))


def free_components(supports: tuple[Support, ...], mesh: Mesh) -> BoolArray:
    """Mask (n, d) of the components of a mesh without support; those along directions are not looked at.

    Raises
    ------
    InputError
        Naming the place from ``supports[k]`` on: letters that are not axes of the mesh, a tag that matches nothing, a
        support all of whose components other supports drive with another velocity.
    """
    masks = _masks(supports, mesh)
    _require_effect(supports, masks)
    return ~np.logical_or.reduce([*masks, np.zeros((mesh.n_nodes, mesh.dim), bool)])


def _masks(supports: tuple[Support, ...], mesh: Mesh) -> list[BoolArray]:
    """Masks (n, d) of the components of each support; none of supports along directions."""
    masks = []
    for k, support in enumerate(supports):
        with within(f"supports[{k}]"):
            masks.append(supported_components(support, mesh) & (not directed(support)))
    return masks


def _held(supports: tuple[Support, ...], mesh: Mesh) -> dict[int, Held]:
    """Supported directions of the nodes of directed supports."""
    return held_directions(supports, mesh, _masks(supports, mesh)) if any(map(directed, supports)) else {}


def _require_effect(supports: tuple[Support, ...], masks: Sequence[BoolArray]) -> None:
    """Refuse a support that others override: driven ones override fixed ones, and the driven ones before them."""
    for k, support in enumerate(supports):
        over = np.zeros_like(masks[k])
        for j, other in enumerate(supports):
            if isinstance(other, MOVING) and other != support and (j > k or not isinstance(support, MOVING)):
                over |= masks[j]
        if not directed(support) and not (masks[k] & ~over).any():
            problem = f"all components on {support.on!r} are driven by other supports"
            raise InputError(f"supports[{k}]", problem, "one support for each component")


def supported_components(support: Support, mesh: Mesh) -> BoolArray:
    """Mask (n, d) of the components of a mesh that a support fixes or drives, alone or along its direction.

    Raises
    ------
    InputError
        Letters that are not axes of the mesh, or a tag that matches nothing.
    """
    supported = np.zeros((mesh.n_nodes, mesh.dim), bool)
    if isinstance(support, Fixed | Driven | Guided) and directed(support):
        nodes, along = directions(support, mesh)
        supported[nodes] = along != 0.0
        return supported
    axes = "xyz"[: mesh.dim]
    letters = axes if support.components == "all" else support.components
    if not letters or set(letters) - set(axes):
        problem = f"{support.components!r} in {mesh.dim}D"
        raise InputError("components", problem, f"letters of {axes!r}, or 'all'")
    with within("on"):
        nodes = mesh.nodes(support.on)
    for letter in letters:
        supported[nodes, axes.index(letter)] = True
    return supported


Moved = tuple[Driven | Guided | DirectedMotion | CarriedNodes, BoolArray]
"""Support that moves nodes, with the mask (n, d) of the components that it moves."""


def driven_components(
    parts: Sequence[DiscreteSolid],
    solids: Mapping[str, Solid],
    displacement: Array,
    motions: Mapping[str, RigidMotion],
) -> tuple[Moved, ...]:
    """Driven supports, and nodes that rigid bodies carry, with the components that they move; later supports have
    precedence.

    Parameters
    ----------
    displacement
        (n, d) initial displacement of all nodes [m].
    motions
        Motions of the rigid bodies at the start.

    Raises
    ------
    InputError
        If a rigid body does not exist, or nodes that it carries have other driven supports.
    """
    found: list[Moved] = []
    for part in parts:
        supports = solids[part.name].supports
        with within(f"bodies.{part.name}"):
            held = _held(supports, part.mesh)
        apart = np.isin(np.arange(part.mesh.n_nodes), list(held))
        for k, support in enumerate(supports):
            if isinstance(support, MOVING) and not directed(support):
                with within(f"bodies.{part.name}.supports[{k}]"):
                    where = np.zeros(displacement.shape, bool)
                    where[part.nodes] = supported_components(support, part.mesh) & ~apart[:, None]
                    found.append((_moving(support, part, where, displacement, motions), where))
                    _require_apart(found)
        along = directed_motion(supports, held, part.dofs.free.shape)
        if along is not None:
            where = np.zeros(displacement.shape, bool)
            where[part.nodes] = along[1]
            found.append((along[0], where))
    return tuple(found)


def _moving(
    support: Driven | Guided | Carried,
    part: DiscreteSolid,
    where: BoolArray,
    displacement: Array,
    motions: Mapping[str, RigidMotion],
) -> Driven | Guided | CarriedNodes:
    """Support as the model has it: of a rigid body with the nodes (k,) that it carries."""
    if not isinstance(support, Carried):
        return support
    if support.by not in motions:
        problem, remedy = f"there is no rigid body {support.by!r}", f"one of {sorted(motions)}"
        raise InputError("by", problem, remedy if motions else "a Rigid among the bodies")
    nodes = np.flatnonzero(where.any(axis=1))
    place = (part.mesh.points + displacement[part.nodes])[nodes - part.nodes.start]
    return CarriedNodes(by=support.by, nodes=nodes, place=place, motion=motions[support.by])


def _require_apart(found: Sequence[Moved]) -> None:
    """Refuse nodes that a rigid body carries and another support drives."""
    last, where = found[-1]
    for other, there in found[:-1]:
        if (where & there).any() and (isinstance(last, CarriedNodes) or isinstance(other, CarriedNodes)):
            raise InputError("on", "nodes of a second driven support", "tags without common nodes")
