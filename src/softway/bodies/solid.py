"""A deformable solid and a rigid tool, as plain descriptions."""

from dataclasses import dataclass
from typing import Annotated

from softway.bodies.fields import Field, Uniform
from softway.bodies.force import SlabForce, Weighted
from softway.bodies.mass import Consistent, MassRule
from softway.bodies.placement import Placement
from softway.bodies.section import Section
from softway.laws.law import StoredEnergy
from softway.space.curved import Shape
from softway.space.mesh import Mesh
from softway.space.sources import MeshSource
from softway.units import KilogramPerCubicMetre


@dataclass(frozen=True, slots=True, kw_only=True)
class Fixed:
    """Support: the named displacement components of the nodes of a tag stay zero.

    ``components`` is a string made of ``x``, ``y``, ``z`` or the word ``all``.
    """

    on: str
    components: str = "all"


@dataclass(frozen=True, slots=True, kw_only=True)
class Solid:
    """A deformable body: mesh, law, density, and how it starts.

    Parameters
    ----------
    mesh
        A mesh, or the recipe of one.
    material
        A law with a stored energy.
    density
        Mass per reference volume [kg/m^3], positive.
    section
        How the cells fill space; by default bar of unit area, plane strain of unit thickness, or volume.
    mass
        Consistent or lumped inertia; contact by :class:`~softway.contact.timing.Energy` redistributes it.
    velocity, displacement
        Initial fields.
    supports
        Fixed nodes.
    force
        How the internal force is averaged over a slab.
    place
        How the mesh is turned and moved into the scene.
    """

    mesh: MeshSource | Mesh
    material: StoredEnergy
    density: KilogramPerCubicMetre
    section: Section | None = None
    mass: MassRule = Consistent()
    velocity: Annotated[Field, "m/s"] = Uniform()
    displacement: Annotated[Field, "m"] = Uniform()
    supports: tuple[Fixed, ...] = ()
    force: SlabForce = Weighted()
    place: Placement = Placement()


@dataclass(frozen=True, slots=True, kw_only=True)
class Tool:
    """A rigid obstacle without unknowns."""

    shape: Shape
