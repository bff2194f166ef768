"""Description of deformable solids and rigid tools."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated

from softway.bodies.bulk_viscosity import BulkViscosity
from softway.bodies.conductor import Thermal as Thermal
from softway.bodies.elements.quadrature import Dilating
from softway.bodies.elements.section import Axisymmetric, Section
from softway.bodies.inertia.mass_matrix import Consistent, MassRule
from softway.bodies.internal_force.slab_average import (
    AverageField,
    DiscreteGradient,
    EnergyMomentum,
    SlabForce,
    Weighted,
)
from softway.bodies.prescribed_motion import Motion, PlacedShape, Still
from softway.bodies.setup.initial_fields import Field, Uniform
from softway.bodies.setup.placement import Placement
from softway.bodies.setup.supports import Carried as Carried
from softway.bodies.setup.supports import Driven as Driven
from softway.bodies.setup.supports import Fixed as Fixed
from softway.bodies.setup.supports import Guided as Guided
from softway.bodies.setup.supports import Support as Support
from softway.errors import InputError
from softway.laws.law import Material, RateLaw
from softway.meshes.adaptive.adapt import Adapting
from softway.meshes.generators.recipes import MeshSource
from softway.meshes.mesh import Mesh
from softway.meshes.remeshed.remesh import Remeshing
from softway.obstacles.primitives import Shape
from softway.units import KilogramPerCubicMetre


@dataclass(frozen=True, slots=True, kw_only=True)
class Solid:
    """Deformable body: mesh, material, density, supports and initial fields.

    Parameters
    ----------
    mesh
        Mesh, or recipe of a mesh.
    material
        Material law: a stored energy, or a path-dependent law; or laws by regions of the mesh.
    density
        Mass per reference volume [kg/m^3], positive; or one for each region with a law.
    section
        Section of the elements; by default bar of unit area, plane strain of unit thickness, or volume.
    mass
        Consistent or lumped mass; contact by :class:`~softway.contact.impact_rule.Energy` redistributes it.
    velocity, displacement
        Initial fields.  Driven supports keep the displacement; under fixed ones it has to be zero.
    supports
        Fixed and driven nodes, and nodes that rigid bodies carry.
    force
        Average of the internal force over a time step (slab).
    dilatation
        Volume change in an element: ``point`` at each point; for nearly incompressible material without locking,
        ``mean`` over the element, or ``corner`` around the corner nodes (the Taylor-Hood element if quadratic).
    shock
        Bulk viscosity; none by default.
    thermal
        Heat conduction and thermal expansion; without, the solid has no temperature.
    place
        Mirror, rotation and translation of the mesh into the scene.
    group
        Placements of groups that the solid belongs to, applied after its own, in order.
    adapt
        Adaption of the mesh to waves and contacts: ``auto``, or its numbers; the mesh stays by default.
    remesh
        Replacement of the mesh before its cells degenerate, as in a forging: ``auto``, or its numbers; the mesh stays
        by default.
    """

    mesh: MeshSource | Mesh
    material: Material | Mapping[str, Material]
    density: KilogramPerCubicMetre | Mapping[str, KilogramPerCubicMetre]
    section: Section | None = None
    mass: MassRule = Consistent()
    velocity: Annotated[Field, "m/s"] = Uniform()
    displacement: Annotated[Field, "m"] = Uniform()
    supports: tuple[Support, ...] = ()
    force: SlabForce = Weighted()
    dilatation: Dilating = "point"
    shock: BulkViscosity | None = None
    thermal: Thermal | None = None
    place: Placement = Placement()
    group: tuple[Placement, ...] = ()
    adapt: Adapting = None
    remesh: Remeshing = None

    def __post_init__(self) -> None:
        if isinstance(self.force, EnergyMomentum) and isinstance(self.section, Axisymmetric):
            problem = "EnergyMomentum for a body of revolution, which has no angular momentum in its section"
            raise InputError("force", problem, "Weighted")
        for place, law in _placed_laws(self.material):
            if isinstance(self.force, AverageField | DiscreteGradient) and isinstance(law, RateLaw):
                problem = f"{type(self.force).__name__} with {type(law).__name__}, which has no stored energy"
                raise InputError("force", problem, "Weighted or EnergyMomentum")
            if self.dilatation == "point" and getattr(law, "nu", 0.0) == 0.5:
                problem = "nu = 0.5 with the volume change at each point of an element: the elements lock"
                raise InputError(f"{place}.nu", problem, 'dilatation = "mean", or "corner" with quadratic cells')
        if isinstance(self.density, Mapping):
            _require_densities(self.material, self.density)
        if isinstance(self.force, DiscreteGradient) and self.dilatation != "point":
            raise InputError(
                "force", "DiscreteGradient needs the volume change at each point", 'dilatation = "point", or Weighted'
            )


def _placed_laws(material: Material | Mapping[str, Material]) -> list[tuple[str, Material]]:
    """Laws with their places in a body."""
    if not isinstance(material, Mapping):
        return [("material", material)]
    if not material:
        raise InputError("material", "no law", "one law, or a law for each region of the mesh")
    return [(f"material.{name}", law) for name, law in material.items()]


def _require_densities(material: Material | Mapping[str, Material], density: Mapping[str, float]) -> None:
    """Refuse densities of other regions than those with a law."""
    if not isinstance(material, Mapping):
        raise InputError("density", "densities by regions, but one law for the body", "one density, or laws by regions")
    for name in material:
        if name not in density:
            problem, known = f"missing: the region {name!r} has a law", ", ".join(density)
            remedy = f"a density for each region with a law (there are those of: {known}), or one for the body"
            raise InputError(f"density.{name}", problem, remedy)
    for name in density:
        if name not in material:
            problem, known = f"{name!r} is no region with a law", ", ".join(material)
            raise InputError(f"density.{name}", problem, f"densities of: {known}")


def placed_together(bodies: Mapping[str, Solid], place: Placement) -> dict[str, Solid]:
    """Solids of a group, placed as one after their own placements: mirrored and turned about a common point, and moved.

    Raises
    ------
    InputError
        If the placement refers to each single body: the centre of its bounding box, or its lowest node.

    Examples
    --------
    >>> from softway.bodies.setup.placement import Mirror
    >>> import softway as sw
    >>> bar = sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=1), material=sw.LinearElastic(E=1.0), density=1.0)
    >>> turned = placed_together({"one": bar, "other": bar}, Placement(mirror=Mirror(normal=(1.0,), point=(2.0,))))
    >>> sw.build(sw.Scene(bodies=turned)).points.ravel().tolist()
    [4.0, 3.0, 4.0, 3.0]
    """
    if place.bottom is not None:
        raise InputError("bottom", "the lowest node of each body of a group", "a translation of the group")
    if not place.about and (place.rotations or (place.mirror is not None and not place.mirror.point)):
        raise InputError("about", "no common point of a group", "a point in space")
    return {name: replace(solid, group=(*solid.group, place)) for name, solid in bodies.items()}


@dataclass(frozen=True, slots=True, kw_only=True)
class Tool:
    """Rigid tool: an obstacle with a prescribed motion, without unknowns.

    Parameters
    ----------
    shape
        Shape at its place without motion.
    motion
        Prescribed motion.

    Examples
    --------
    >>> from softway.bodies.prescribed_motion import Translation
    >>> from softway.obstacles.half_space import HalfSpace
    >>> ram = Tool(shape=HalfSpace(point=1.0, normal=-1.0), motion=Translation(velocity=-2.0))
    >>> ram.at(0.25).pose.shift.tolist()
    [-0.5]
    """

    shape: Shape
    motion: Motion = Still()

    def __post_init__(self) -> None:
        if not hasattr(self.shape, "dim"):
            raise InputError(
                "shape", f"{self.shape!r:.60} is not an obstacle", "HalfSpace(point=..., normal=...), Sphere, ..."
            )
        if self.motion.dim not in (None, self.shape.dim):
            problem = f"{type(self.motion).__name__} in {self.motion.dim}D for a shape in {self.shape.dim}D"
            raise InputError("motion", problem, f"{self.shape.dim} components")

    def at(self, time: float) -> PlacedShape:
        """Shape at its place at a time [s]."""
        return PlacedShape(shape=self.shape, pose=self.motion.at(time))
