"""When and how the degraded mesh of a solid is replaced in a march."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from softway.adaptivity.rezoning.quality import CellQuality
from softway.bodies.solid import Solid
from softway.errors import InputError
from softway.meshes.mesh import Mesh
from softway.units import Pure

Way = Literal["auto", "rezone", "new cells"]
"""How a mesh is replaced."""
Generator = Literal["own", "mmg"]
"""What makes new cells."""
SIMPLICES = ("tri3", "tri6"), ("tet4", "tet10")
"""Cells that new ones may replace, in the plane and in space."""
WORSE = 0.8
"""Quality, relative to that of the last new mesh, below which a measure that the mesh cannot reach counts again."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Remesh:
    """Replacement of the mesh of a solid before its cells degenerate.

    The mesh is replaced between two slabs when a cell falls below one of the limits, or when a slab had to be much
    shorter than asked for.  Where the shape of the body allows no mesh within a limit, the quality of the last mesh
    takes its place: the mesh is replaced again when it is a fifth worse than that.

    Parameters
    ----------
    by
        ``rezone``: the same cells with their nodes in other places; ``new cells``: other triangles or tetrahedra, and
        in the plane a boundary that is spaced anew; ``auto``: rezoning, and new cells where no rezoned mesh is within
        the limits and the cells are triangles or tetrahedra.
    generator
        What makes new cells: ``own``, or ``mmg``, which needs the extra ``remesh``.
    quality
        Least scaled Jacobian of the cells.
    angle
        Least angle of the cells [degrees].
    ratio
        Greatest ratio of the edges of a cell.
    shortened
        Fraction of the requested length below which a slab asks for another mesh.
    every
        Least number of slabs between two meshes.

    Examples
    --------
    >>> Remesh(by="rezone", quality=0.4).angle
    15.0
    """

    by: Way = "auto"
    generator: Generator = "own"
    quality: Pure = 0.3
    angle: Pure = 15.0
    ratio: Pure = 20.0
    shortened: Pure = 0.1
    every: int = 1

    def __post_init__(self) -> None:
        for name, most in (("quality", 1.0), ("angle", 90.0), ("shortened", 1.0)):
            value = getattr(self, name)
            if not 0.0 <= value < most:
                raise InputError(name, f"{value:g}", f"from 0 to below {most:g}")
        if not self.ratio > 1.0:
            raise InputError("ratio", f"{self.ratio:g}", "a number above one")
        if self.every < 1:
            raise InputError("every", f"{self.every}", "a whole number from one on")

    def asks(self, now: CellQuality, last: CellQuality) -> str:
        """The measure that asks for another mesh, as text; empty if none does.

        Parameters
        ----------
        now, last
            Quality of the cells at present, and when they were new.
        """
        found, new = now.worst, last.worst
        limits = (min(self.quality, WORSE * new[0]), min(self.angle, WORSE * new[1]), max(self.ratio, new[2] / WORSE))
        if found[0] < limits[0]:
            return f"scaled Jacobian {found[0]:.3g}"
        if found[1] < limits[1]:
            return f"angle of {found[1]:.3g} degrees"
        return f"ratio of edges {found[2]:.3g}" if found[2] > limits[2] else ""

    def within(self, quality: CellQuality) -> bool:
        """Whether cells are within the limits."""
        jacobian, angle, ratio = quality.worst
        return jacobian >= self.quality and angle >= self.angle and ratio <= self.ratio


def makes_cells(how: Remesh, mesh: Mesh) -> bool:
    """Whether a mesh may get new cells: its cells are triangles or tetrahedra.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import rectangle
    >>> makes_cells(Remesh(), rectangle((1.0, 1.0), cells=(1, 1)))
    False
    """
    return how.by != "rezone" and any(tuple(mesh.blocks) == (cell,) for cell in SIMPLICES[mesh.dim - 2])


def require_cells(how: Remesh, mesh: Mesh, solid: Solid) -> None:
    """Refuse new cells for solids that cannot have them.

    Raises
    ------
    InputError
        For quadrilaterals and hexahedra, and for supports on nodes inside.
    """
    if how.by == "new cells" and not makes_cells(how, mesh):
        cells = ", ".join(mesh.blocks)
        names = " or ".join(SIMPLICES[mesh.dim - 2])
        remedy = f'a mesh of {names}, with dilatation = "corner" where the volume stays; or by = "rezone"'
        raise InputError("by", f"new cells for {cells}", remedy)
    if not makes_cells(how, mesh):
        return
    surface = np.isin(np.arange(mesh.n_nodes), mesh.nodes("surface"))
    for support in solid.supports:
        if not surface[mesh.nodes(support.on)].all():
            raise InputError("by", f"new cells with a support on nodes inside, {support.on!r}", 'by = "rezone"')
