"""A deformable solid and a rigid tool, as plain descriptions."""

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from softway.bodies.cells import Dilating
from softway.bodies.fields import Field, Uniform
from softway.bodies.force import AverageField, DiscreteGradient, EnergyMomentum, SlabForce, Weighted
from softway.bodies.mass import Consistent, MassRule
from softway.bodies.motion import Motion, Placed, Still
from softway.bodies.placement import Placement
from softway.bodies.section import Axisymmetric, Section
from softway.bodies.shock import BulkViscosity
from softway.errors import InputError
from softway.laws.law import Material, RateLaw
from softway.space.curved import Shape
from softway.space.mesh import Mesh
from softway.space.sources import MeshSource
from softway.units import KilogramPerCubicMetre, MetrePerSecond, Second


@dataclass(frozen=True, slots=True, kw_only=True)
class Fixed:
    """Support: the named displacement components of the nodes of a tag stay zero.

    Parameters
    ----------
    on
        The tag.
    components
        Made of ``x``, ``y``, ``z``; or the word ``all``.
    """

    on: str
    components: str = "all"


@dataclass(frozen=True, slots=True, kw_only=True)
class Driven:
    """Support that moves: the named components of the nodes of a tag have a given velocity.

    Parameters
    ----------
    on, components
        As for :class:`Fixed`.
    velocity
        Velocity of each of the components; with ``times`` its values there, linear in between and constant outside
        [m/s].
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

    def at(self, time: float) -> float:
        """Velocity at a time [m/s]."""
        values = np.atleast_1d(np.asarray(self.velocity, float))
        return float(np.interp(time, self.times, values)) if self.times else float(values[0])


Support = Fixed | Driven


@dataclass(frozen=True, slots=True, kw_only=True)
class Solid:
    """A deformable body: mesh, law, density, and how it starts.

    Parameters
    ----------
    mesh
        A mesh, or the recipe of one.
    material
        A law with a stored energy, or one with a history.
    density
        Mass per reference volume [kg/m^3], positive.
    section
        How the cells fill space; by default bar of unit area, plane strain of unit thickness, or volume.
    mass
        Consistent or lumped inertia; contact by :class:`~softway.contact.timing.Energy` redistributes it.
    velocity, displacement
        Initial fields.
    supports
        Nodes that are held or driven.
    force
        How the internal force is averaged over a slab.
    dilatation
        ``point``: the change of volume at each point of a cell; so that matter that keeps its volume does not lock,
        ``mean``: its mean over the cell, or ``corner``: its means around the corners (with quadratic cells Taylor and
        Hood's element).
    shock
        Bulk viscosity; none by default.
    place
        How the mesh is turned and moved into the scene.
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
            problem = "EnergyMomentum of a body of revolution, which has no angular momentum in its section"
            raise InputError("force", problem, "Weighted")
        if isinstance(self.force, AverageField | DiscreteGradient) and isinstance(self.material, RateLaw):
            problem = f"{type(self.force).__name__} of {type(self.material).__name__}, which has no stored energy"
            raise InputError("force", problem, "Weighted or EnergyMomentum")
        if self.dilatation == "point" and getattr(self.material, "nu", 0.0) == 0.5:
            problem = "nu = 0.5 in cells that take the change of volume point by point: they lock"
            raise InputError("material.nu", problem, 'dilatation = "mean", or "corner" with quadratic cells')
        if isinstance(self.force, DiscreteGradient) and self.dilatation != "point":
            raise InputError("force", "DiscreteGradient is taken point by point", 'dilatation = "point", or Weighted')


@dataclass(frozen=True, slots=True, kw_only=True)
class Tool:
    """A rigid obstacle without unknowns.

    Parameters
    ----------
    shape
        Its shape, where it stands without motion.
    motion
        How it moves.

    Examples
    --------
    >>> from softway.bodies.motion import Translation
    >>> from softway.space.obstacles import HalfSpace
    >>> ram = Tool(shape=HalfSpace(point=1.0, normal=-1.0), motion=Translation(velocity=-2.0))
    >>> ram.at(0.25).pose.shift.tolist()
    [-0.5]
    """

    shape: Shape
    motion: Motion = Still()

    def __post_init__(self) -> None:
        if not hasattr(self.shape, "dim"):
            raise InputError(
                "shape", f"{self.shape!r:.60} is no obstacle", "HalfSpace(point=..., normal=...), Sphere, ..."
            )
        if self.motion.dim not in (None, self.shape.dim):
            problem = f"{type(self.motion).__name__} in {self.motion.dim}D of a shape in {self.shape.dim}D"
            raise InputError("motion", problem, f"{self.shape.dim} components")

    def at(self, time: float) -> Placed:
        """The shape where it stands at a time [s]."""
        return Placed(shape=self.shape, pose=self.motion.at(time))
