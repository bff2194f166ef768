"""How the mesh of a solid adapts, and the mesh that a state asks for."""

from dataclasses import dataclass

import numpy as np

from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.adaptivity.indicator import indicator, wanted_levels
from softway.adaptivity.neighbourhood import grown_around, grown_near
from softway.adaptivity.transfer import Motion
from softway.arrays import Array
from softway.errors import InputError, positive
from softway.meshes.adaptive.leaves import DEPTH, same
from softway.meshes.adaptive.refinement import AdaptedMesh, adapted_mesh
from softway.meshes.adaptive.tree import tree_of
from softway.meshes.mesh import Mesh
from softway.units import Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class Adapt:
    """Adaption of the mesh of a solid of bars, triangles or tetrahedra.

    Parameters
    ----------
    levels
        Greatest number of bisections of a cell of the mesh of the solid.  One halves the edges of bars, two those of
        triangles, three those of tetrahedra.
    tolerance
        Factor c of the threshold ``c sqrt(E (h / L)^k)`` of the indicator: E the energy of the scene, the greatest so
        far, h the shortest edge of the finest cells, L the size of the solid, k its dimension.
    every
        Slabs between two changes of the mesh.
    buffer
        Finest cells around fine cells that are as fine; at least the way of a wave in ``every`` slabs.
    contact_cells
        Finest cells at a contact that is closed or closes soon.

    Examples
    --------
    >>> Adapt(levels=5).every
    4
    """

    levels: int
    tolerance: Pure = 0.15
    every: int = 4
    buffer: int = 4
    contact_cells: int = 12

    def __post_init__(self) -> None:
        positive(tolerance=self.tolerance)
        if not 0 <= self.levels <= DEPTH:
            raise InputError("levels", f"{self.levels} bisections", f"a whole number from 0 to {DEPTH}")
        for name in ("every", "buffer", "contact_cells"):
            if getattr(self, name) < 1:
                raise InputError(name, f"{getattr(self, name)}", "a whole number from 1 on")

    def finest(self, base: Mesh) -> float:
        """Shortest edge of the finest cells [m]."""
        return float(np.ldexp(base.edge(), -(self.levels // base.cell_dim)))

    def mesh(self, solid: AdaptedSolid, motion: Motion, energy: float, touching: Array) -> AdaptedMesh:
        """Mesh for the coming slabs.

        Parameters
        ----------
        solid, motion
            The solid and its motion on the present mesh.
        energy
            Energy of the scene [J].
        touching
            (k, d) reference places of its nodes at contacts that are closed or close soon [m].
        """
        base = solid.adapted.base
        finest, size = self.finest(base), float(np.linalg.norm(np.ptp(base.points, axis=0)))
        share = (finest / size) ** base.cell_dim
        threshold = max(self.tolerance * float(np.sqrt(energy * share)), float(np.finfo(float).tiny))
        levels = wanted_levels(solid.adapted, indicator(solid, motion), threshold, self.levels)
        tree = tree_of(base).grown(solid.adapted.leaves, levels)
        tree = grown_near(tree, [(self.levels, touching)], self.contact_cells * finest)
        tree = grown_around(tree, self.buffer * finest)
        return solid.adapted if same(tree.leaves, solid.adapted.leaves) else adapted_mesh(tree)
