"""Description of deformable solids and rigid tools."""

from bisect import bisect_left, bisect_right
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from softway.bodies.bulk_viscosity import BulkViscosity
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
from softway.errors import InputError
from softway.laws.law import Material, RateLaw
from softway.meshes.generators.recipes import MeshSource
from softway.meshes.mesh import Mesh
from softway.obstacles.primitives import Shape
from softway.units import KilogramPerCubicMetre, MetrePerSecond, Second

STRAIGHT = 1e-12
"""Change of the slope of a prescribed velocity over a slab, relative to the velocity, that is rounding."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Fixed:
    """Support that keeps displacement components of the nodes of a tag at zero.

    Parameters
    ----------
    on
        Tag of the nodes.
    components
        Letters out of ``x``, ``y``, ``z``; or ``all``.
    """

    on: str
    components: str = "all"


@dataclass(frozen=True, slots=True, kw_only=True)
class Driven:
    """Support that moves displacement components of the nodes of a tag with a given velocity.

    Parameters
    ----------
    on, components
        As for :class:`Fixed`.
    velocity
        Velocity of each of the components [m/s]; with ``times`` its values at these instants, linear in between and
        constant outside.
    times
        Increasing instants [s].

    Examples
    --------
    >>> ram = Driven(on="top", components="y", velocity=(0.0, -2.0), times=(0.0, 1.0))
    >>> ram.at(0.5)
    -1.0
    """

    on: str
    components: str = "all"
    velocity: tuple[MetrePerSecond, ...] | MetrePerSecond
    times: tuple[Second, ...] = ()

    def __post_init__(self) -> None:
        values = np.atleast_1d(np.asarray(self.velocity, float))
        times = np.asarray(self.times, float)
        if len(values) != max(len(times), 1) or not np.isfinite(values).all():
            raise InputError("velocity", f"{len(values)} values at {len(times)} times", "one for each of the times")
        if not (np.diff(times) > 0.0).all():
            raise InputError("times", f"{list(self.times)} do not increase", "increasing instants")

    @property
    def greatest_speed(self) -> float:
        """Greatest speed of a component at any time [m/s]."""
        return float(np.abs(self.velocity).max())

    def at(self, time: float) -> float:
        """Velocity at a time [m/s]."""
        values = np.atleast_1d(np.asarray(self.velocity, float))
        return float(np.interp(time, self.times, values)) if self.times else float(values[0])

    def bends(self, start: float, end: float) -> tuple[tuple[float, float], ...]:
        """Bends of the velocity inside a slab: instants tau in (0, 1), and changes of its slope [m/s per slab].

        Examples
        --------
        >>> Driven(on="left", velocity=(0.0, 1.0, 0.0), times=(0.0, 0.5, 1.0)).bends(0.25, 0.75)
        ((0.5, -2.0),)
        """
        first, last = bisect_right(self.times, start), bisect_left(self.times, end)
        if first >= last:
            return ()
        tau = np.array([0.0, *((t - start) / (end - start) for t in self.times[first:last]), 1.0])
        values = np.array([self.at(start), *(self.at(t) for t in self.times[first:last]), self.at(end)])
        changes = np.diff(np.diff(values) / np.diff(tau))
        real = np.abs(changes) > STRAIGHT * np.abs(values).max()
        return tuple((float(t), float(c)) for t, c, bent in zip(tau[1:-1], changes, real, strict=True) if bent)


@dataclass(frozen=True, slots=True, kw_only=True)
class Carried:
    """Support that holds the nodes of a tag on a rigid body, which carries them: a weld of a solid to the body.

    Parameters
    ----------
    on
        Tag of the nodes.
    by
        Name of the rigid body.

    Examples
    --------
    >>> Carried(on="left", by="crank").components
    'all'
    """

    on: str
    by: str
    components: ClassVar[str] = "all"


Support = Fixed | Driven | Carried


@dataclass(frozen=True, slots=True, kw_only=True)
class Solid:
    """Deformable body: mesh, material, density, supports and initial fields.

    Parameters
    ----------
    mesh
        Mesh, or recipe of a mesh.
    material
        Material law: a stored energy, or a path-dependent law.
    density
        Mass per reference volume [kg/m^3], positive.
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
    place
        Rotation and translation of the mesh into the scene.
    """

    mesh: MeshSource | Mesh
    material: Material
    density: KilogramPerCubicMetre
    section: Section | None = None
    mass: MassRule = Consistent()
    velocity: Annotated[Field, "m/s"] = Uniform()
    displacement: Annotated[Field, "m"] = Uniform()
    supports: tuple[Support, ...] = ()
    force: SlabForce = Weighted()
    dilatation: Dilating = "point"
    shock: BulkViscosity | None = None
    place: Placement = Placement()

    def __post_init__(self) -> None:
        if isinstance(self.force, EnergyMomentum) and isinstance(self.section, Axisymmetric):
            problem = "EnergyMomentum for a body of revolution, which has no angular momentum in its section"
            raise InputError("force", problem, "Weighted")
        if isinstance(self.force, AverageField | DiscreteGradient) and isinstance(self.material, RateLaw):
            problem = f"{type(self.force).__name__} with {type(self.material).__name__}, which has no stored energy"
            raise InputError("force", problem, "Weighted or EnergyMomentum")
        if self.dilatation == "point" and getattr(self.material, "nu", 0.0) == 0.5:
            problem = "nu = 0.5 with the volume change at each point of an element: the elements lock"
            raise InputError("material.nu", problem, 'dilatation = "mean", or "corner" with quadratic cells')
        if isinstance(self.force, DiscreteGradient) and self.dilatation != "point":
            raise InputError(
                "force", "DiscreteGradient needs the volume change at each point", 'dilatation = "point", or Weighted'
            )


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
