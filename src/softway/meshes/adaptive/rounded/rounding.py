"""Smooth surface through the nodes of a base mesh of linear cells."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray

NONE = -1
"""Number of no patch, and of no corner."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Rounding:
    """Smooth surface through the n nodes of a base mesh with e cells.

    The boundary consists of patches: facets that meet at small angles.

    Parameters
    ----------
    patches
        (n, s) patches at each node; -1 for none.
    normals
        (n, s, d) normals of these patches at the node; not a number where unknown.
    tangents
        (n, d) tangents of the edges between two patches; not a number where they end, or have a corner.
    edges, sides
        (k, 2) corners, the greater number first, of the curved edges on the boundary, and (k, 2) their patches: one and
        -1, or two where patches meet.
    facets, on
        (f, c) corners, in falling order, of the curved facets in space, and (f,) their patch.
    moments
        (e, 1 + d) integrals of 1 and the place over the body in each cell, that is the cell with its curved facets, by
        :func:`~softway.meshes.adaptive.rounded.volumes.moments_by_root`; not a number where it is not curved.
    bulge
        (e,) greatest distance of the surface from the facets and edges of each cell [m].
    radial
        True for a body of revolution: the integrals are those of the distance from the axis.
    """

    patches: IntArray
    normals: Array
    tangents: Array
    edges: IntArray
    sides: IntArray
    facets: IntArray
    on: IntArray
    moments: Array
    bulge: Array
    radial: bool = False

    def sides_of(self, carriers: IntArray) -> IntArray:
        """Patches (k, 2) of new nodes by their ``carriers`` (k, c), corners of the base mesh that they lie between, in
        falling order and filled with -1; -1 off the curved boundary.
        """
        out = np.full((len(carriers), 2), NONE)
        for table, own in ((self.edges, self.sides), (self.facets, self.on[:, None])):
            wide = np.full((len(table), carriers.shape[1]), NONE)
            wide[:, : table.shape[1]] = table
            number = np.unique(np.concatenate([wide, carriers]), axis=0, return_inverse=True)[1].ravel()
            place = np.full(number.max(initial=0) + 1, NONE)
            place[number[: len(table)]] = np.arange(len(table))
            at = place[number[len(table) :]]
            out[at >= 0, : own.shape[1]] = own[at[at >= 0]]
        return out
