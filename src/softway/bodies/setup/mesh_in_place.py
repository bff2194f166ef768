"""Mesh of a solid in its place in the scene, and the smooth surface that its refinements follow."""

from softway.bodies.elements.section import Axisymmetric, Section
from softway.bodies.setup.placement import Placement, placed
from softway.meshes.adaptive.adapt import Adapting, adaption
from softway.meshes.adaptive.surfaces.lowest import lowest
from softway.meshes.adaptive.surfaces.surface import ROUND, rounded
from softway.meshes.generators.recipes import Ball, Cylinder, Disc, Divided, GradedDisc, MeshSource, Ring
from softway.meshes.mesh import Mesh


def in_place(
    mesh: Mesh, source: MeshSource | Mesh, places: tuple[Placement, ...], adapt: Adapting, section: Section | None
) -> Mesh:
    """Mesh of a solid after its placements.

    The bottom of a solid whose mesh adapts is that of its curved boundary.  The mesh of a round shape of softway keeps
    this boundary, which its nodes alone do not tell.

    Parameters
    ----------
    mesh
        The mesh before the placements.
    source
        What it was built from: a recipe, or the mesh.
    places
        Placement of the solid and those of its groups.
    adapt, section
        Of the solid.

    Raises
    ------
    InputError
        With the key of the placement, and the number of the group.
    """

    def surface(base: Mesh) -> Mesh:
        return with_surface(base, source, adapt, section)

    out = placed(mesh, places[0], places[1:], lambda base: lowest(surface(base)))
    return surface(out) if is_round(source) else out


def with_surface(base: Mesh, source: MeshSource | Mesh, adapt: Adapting, section: Section | None) -> Mesh:
    """Base mesh with the smooth surface that its refinements follow; itself if it has one or stays as it is."""
    how = adaption(adapt)
    if how is None or base.rounding is not None:
        return base
    smooth = max(ROUND, how.smooth) if is_round(source) and how.smooth > 0.0 else how.smooth
    return rounded(base, smooth, isinstance(section, Axisymmetric))


def is_round(source: MeshSource | Mesh) -> bool:
    """True for the round shapes of softway."""
    recipe = source.mesh if isinstance(source, Divided) else source
    return isinstance(recipe, Disc | Cylinder | Ball | Ring | GradedDisc)
