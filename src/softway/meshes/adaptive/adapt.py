"""How the mesh of a solid adapts during a march."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from softway.errors import InputError, positive
from softway.meshes.adaptive.leaves import DEPTH
from softway.meshes.mesh import Mesh
from softway.units import Pure, Radian

SMOOTH = float(np.pi / 6.0)
"""Angle between facets up to which a surface is smooth [rad]."""
HALVINGS = 2
"""Times that ``auto`` halves the edges of the cells."""
MOST = 8
"""Cells that ``auto`` makes of those of the base mesh, at most, or as many as have ``FEW`` nodes."""
FEW = {1: 4000, 2: 4000, 3: 1000}
"""Nodes of a mesh that is small, by the dimension of its cells: in space a factor costs as much with a quarter."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Adapt:
    """Adaption of the mesh of a solid of one type of cell: fine cells follow waves and contacts.

    Parameters
    ----------
    levels
        Greatest number of bisections of a cell of the mesh of the solid.  One halves the edges of bars, two those of
        triangles and quadrilaterals, three those of tetrahedra and hexahedra; ``auto`` halves edges twice, or less
        where the mesh would have more than 8 times the cells of that of the solid and more than about 4000 nodes, 1000
        in space, or where contacts close so fast that finer cells would make slabs short.
    tolerance
        Factor c of the threshold ``c sqrt(E (h / L)^k)`` of the indicator: E the energy of the scene, the greatest so
        far, h the shortest edge of the finest cells, L the size of the solid, k its dimension.
    every
        Slabs between two changes of the mesh.
    buffer
        Finest cells around fine cells that are as fine; at least the way of a wave in ``every`` slabs.
    contact_cells
        Finest cells at a contact that is closed or closes soon.
    smooth
        Greatest angle between facets of linear cells that form a smooth surface: new nodes on it lie on a curve through
        the nodes of the mesh.  Greater angles are corners; 0 keeps all facets flat.  The round shapes of softway, such
        as :class:`~softway.meshes.generators.recipes.Disc`, are round with any positive angle.

    Examples
    --------
    >>> Adapt(levels=5).every
    4
    >>> Adapt().deepest(dimension=2)
    4
    """

    levels: int | Literal["auto"] = "auto"
    tolerance: Pure = 0.15
    every: int = 4
    buffer: int = 4
    contact_cells: int = 12
    smooth: Radian = SMOOTH

    def __post_init__(self) -> None:
        positive(tolerance=self.tolerance)
        if not 0.0 <= self.smooth < 0.5 * np.pi:
            raise InputError("smooth", f"{self.smooth:g} rad", "an angle from 0 to less than 90 degrees")
        if self.levels != "auto" and not 0 <= self.levels <= DEPTH:
            raise InputError("levels", f"{self.levels} bisections", f"a whole number from 0 to {DEPTH}, or 'auto'")
        for name in ("every", "buffer", "contact_cells"):
            if getattr(self, name) < 1:
                raise InputError(name, f"{getattr(self, name)}", "a whole number from 1 on")

    def deepest(self, dimension: int) -> int:
        """Greatest number of bisections of a cell of a dimension."""
        return HALVINGS * dimension if self.levels == "auto" else self.levels

    def most(self, base: Mesh) -> float:
        """Greatest number of cells of the mesh in a march; infinite but for ``auto``."""
        few = FEW[base.cell_dim] * base.n_cells / base.n_nodes
        return max(float(MOST * base.n_cells), few) if self.levels == "auto" else np.inf

    def finest(self, base: Mesh) -> float:
        """Shortest edge of the finest cells [m]."""
        return float(np.ldexp(base.edge(), -(self.deepest(base.cell_dim) // base.cell_dim)))

    def threshold(self, base: Mesh, energy: float) -> float:
        """Threshold of the indicator [sqrt(J)] in a scene with an energy [J]."""
        share = (self.finest(base) / float(np.linalg.norm(np.ptp(base.points, axis=0)))) ** base.cell_dim
        return max(self.tolerance * float(np.sqrt(energy * share)), float(np.finfo(float).tiny))


Adapting = Adapt | Literal["auto"] | None
"""Adaption of the mesh of a solid; ``auto`` is that of ``Adapt()``, None that of a mesh that stays."""


def adaption(given: Adapting) -> Adapt | None:
    """Adaption of a mesh; None if it stays.

    Examples
    --------
    >>> adaption("auto") == Adapt(), adaption(None)
    (True, None)
    """
    return Adapt() if given == "auto" else given
