"""Mesh of a solid for the coming slabs."""

import numpy as np

from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.adaptivity.indicator import indicator, wanted_levels
from softway.adaptivity.neighbourhood import grown_near, marks_of
from softway.adaptivity.transfer import Motion
from softway.arrays import Array
from softway.meshes.adaptive.adapt import Adapt
from softway.meshes.adaptive.leaves import same
from softway.meshes.adaptive.refinement import AdaptedMesh, adapted_mesh
from softway.meshes.adaptive.tree import tree_of


def wanted_mesh(
    adapt: Adapt, solid: AdaptedSolid, motion: Motion, energy: float, touching: Array, stretch: float = 1.0
) -> AdaptedMesh:
    """Mesh for the coming slabs.

    Around fine cells others are as fine.  Cells that become coarser by two cuts have none of these buffers: in space
    conforming meshes have fine cells far from where they are wanted, and would grow from change to change.

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
    leaves, contact = solid.adapted.leaves, [(deepest, touching)]
    kept = np.where(levels >= leaves.level - solid.adapted.step, levels, 0)
    fine = grown_near(tree_of(base).grown(leaves, kept), contact, adapt.contact_cells * finest)
    tree = grown_near(tree_of(base).grown(leaves, levels), contact, adapt.contact_cells * finest)
    tree = grown_near(tree, marks_of(fine), stretch * adapt.buffer * finest)
    return solid.adapted if same(tree.leaves, solid.adapted.leaves) else adapted_mesh(tree)
