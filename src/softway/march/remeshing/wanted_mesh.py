"""Mesh of a solid for the coming slabs."""

from collections.abc import Sequence

from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.adaptivity.indicator import indicator, wanted_levels
from softway.adaptivity.neighbourhood import Mark, grown_around, grown_near
from softway.adaptivity.transfer import Motion
from softway.meshes.adaptive.adapt import Adapt
from softway.meshes.adaptive.leaves import same
from softway.meshes.adaptive.refinement import AdaptedMesh, adapted_mesh
from softway.meshes.adaptive.tree import tree_of


def wanted_mesh(
    adapt: Adapt, solid: AdaptedSolid, motion: Motion, energy: float, marks: Sequence[Mark], stretch: float = 1.0
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
    marks
        Levels, at most the deepest, around places on the facets of the base mesh: of nodes at contacts that are closed
        or close soon, and near ones at a curved boundary.
    stretch
        Length of the coming slabs in requested ones: fronts go as much further.
    """
    base = solid.adapted.base
    finest, deepest = adapt.finest(base), adapt.deepest(base.cell_dim)
    levels = wanted_levels(solid.adapted, indicator(solid, motion), adapt.threshold(base, energy), deepest)
    tree = tree_of(base).grown(solid.adapted.leaves, levels)
    tree = grown_near(tree, [(min(level, deepest), at) for level, at in marks], adapt.contact_cells * finest)
    tree = grown_around(tree, stretch * adapt.buffer * finest)
    return solid.adapted if same(tree.leaves, solid.adapted.leaves) else adapted_mesh(tree)
