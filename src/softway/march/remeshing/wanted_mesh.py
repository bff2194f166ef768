"""Mesh of a solid for the coming slabs."""

from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.adaptivity.indicator import indicator, wanted_levels
from softway.adaptivity.neighbourhood import buffered, refined_near
from softway.adaptivity.transfer import Motion
from softway.arrays import Array
from softway.meshes.adaptive.adapt import Adapt
from softway.meshes.adaptive.refinement import AdaptedMesh, refined


def wanted_mesh(
    adapt: Adapt, solid: AdaptedSolid, motion: Motion, energy: float, touching: Array, stretch: float = 1.0
) -> AdaptedMesh:
    """Mesh for the coming slabs.

    Parameters
    ----------
    adapt
        Adaption of the solid.
    solid, motion
        The solid and its motion on the present mesh.
    energy
        Energy of the scene [J].
    touching
        (k, d) reference places of its nodes at contacts that are closed or close soon [m].
    stretch
        Length of the coming slabs in requested ones: fronts go as much further.
    """
    base = solid.adapted.base
    finest, deepest = adapt.finest(base), adapt.deepest(base.cell_dim)
    levels = wanted_levels(solid.adapted, indicator(solid, motion), adapt.threshold(base, energy), deepest)
    found = refined(base, levels, solid.adapted.leaves)
    found = refined_near(found, [(deepest, touching)], adapt.contact_cells * finest)
    return buffered(found, stretch * adapt.buffer * finest)
