"""Cells of one size along surfaces that may touch, so that no node hangs on a contact node."""

from collections.abc import Sequence

import numpy as np

from softway.meshes.adaptive.refinement import AdaptedMesh, refined
from softway.meshes.cells import CELLS


def even(adapted: AdaptedMesh, tags: Sequence[str]) -> AdaptedMesh:
    """Mesh in which all cells at the nodes of a tag have the level of the finest of them; itself without hanging nodes.

    Parameters
    ----------
    adapted
        The mesh.
    tags
        Tags of the surfaces.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import rectangle
    >>> found = even(refined(rectangle((3.0, 2.0), (3, 2)), np.array([2, 0, 0, 0, 0, 0])), ["bottom"])
    >>> found.leaves.level.tolist()
    [2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 0, 0, 0]
    """
    found = adapted
    while found.mesh.hanging is not None:
        cells = next(iter(found.mesh.blocks.values()))[:, : CELLS[found.cell].corners]
        level = found.leaves.level.copy()
        for tag in tags:
            strip = np.isin(cells, found.mesh.nodes(tag)).any(axis=1)
            level[strip] = level[strip].max()
        if np.array_equal(level, found.leaves.level):
            break
        found = refined(found.base, level, found.leaves)
    return found
