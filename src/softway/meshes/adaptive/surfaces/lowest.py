"""Lowest place of a body with a curved boundary."""

import numpy as np

from softway.meshes.adaptive.refinement import BISECTED, leaf_places
from softway.meshes.adaptive.tree import tree_of
from softway.meshes.cells import CELLS
from softway.meshes.mesh import Mesh

HALVINGS = 12
"""Times that edges at the lowest node are halved: the distance from the lowest place falls to a quarter each time."""


def lowest(base: Mesh) -> float:
    """Lowest coordinate along the last axis of a base mesh with its smooth surface, or with its quadratic cells [m].

    Cells at the lowest node are cut again and again, as they would be in a march.  A mesh that cannot be cut has its
    lowest node.

    Examples
    --------
    >>> from softway.meshes.adaptive.surfaces.surface import rounded
    >>> from softway.meshes.generators.shapes import disc
    >>> from softway.bodies.setup.placement import Placement, Rotation
    >>> turned = Placement(rotations=(Rotation(angle=0.1),), about=(0.0, 0.0)).applied(disc(1.0, 4, cell="tri3"))
    >>> [round(lowest(mesh), 7) for mesh in (turned, rounded(turned))]
    [-0.9950042, -1.0]
    """
    height = float(base.points[:, -1].min())
    if not _curved(base):
        return height
    tree = tree_of(base)
    for halvings in range(1, 1 + HALVINGS):
        found = leaf_places(tree)
        own = (found.nodes == np.argmin(found.points[:, -1])).any(axis=1)
        tree = tree.grown(tree.leaves, np.where(own, halvings * base.cell_dim, 0))
    return min(height, float(leaf_places(tree).points[:, -1].min()))


def _curved(base: Mesh) -> bool:
    """True if cuts of the cells of a base mesh may have lower nodes than it has."""
    name = next(iter(base.blocks))
    quadratic = len(base.blocks) == 1 and name in BISECTED and CELLS[name].order > 1 and base.dim > 1
    return base.rounding is not None or quadratic
