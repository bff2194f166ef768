"""Chords of hollow bodies: facets that stand out of the curves through their nodes."""

import numpy as np

from softway.arrays import Array
from softway.contact.surfaces.boundary import ContactSurface
from softway.contact.surfaces.sagitta import nodal_curvature
from softway.meshes.cells import CELLS
from softway.record.audit.geometry.solids import Solids


def outside(solids: Solids) -> Array:
    """Greatest distance (n,) by which the facets around each node stand out of the curve at rest [m].

    It is the sagitta where the surface is hollow, and zero where it is convex, at its sharp edges, and along the curved
    facets of quadratic cells.
    """
    out = np.zeros(len(solids.reference))
    straight = {n: f for n, f in solids.facets.items() if CELLS[n].dim > 0 and CELLS[n].order == 1 and len(f)}
    if straight:
        found = nodal_curvature(ContactSurface(facets=straight), solids.reference)
        out[found.node] = found.outside()
    return out
