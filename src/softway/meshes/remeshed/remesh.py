"""When and how the degraded mesh of a solid is replaced in a march."""

from dataclasses import dataclass
from typing import Literal

from softway.errors import InputError
from softway.units import Pure

WORSE = 0.8
"""Quality, relative to that of the last new mesh, below which a measure that the mesh cannot reach counts again."""
GAIN = 0.1
"""Part by which a measure of new cells is better than that of bad ones."""
Way = Literal["auto", "rezone", "new cells"]
"""How a mesh is replaced."""
Generator = Literal["own", "mmg"]
"""What makes new cells."""
SIMPLICES = ("tri3", "tri6"), ("tet4", "tet10")
"""Cells that new ones may replace, in the plane and in space."""
Quality = tuple[float, float, float]
"""Least scaled Jacobian of the cells of a mesh, least angle [degrees], greatest ratio of edges."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Remesh:
    """Replacement of the mesh of a solid before its cells degenerate.

    The mesh is replaced between two slabs when a cell falls below one of the limits, or when a slab had to be much
    shorter than asked for.  Where the shape of the body allows no mesh within a limit, the quality of the last mesh
    takes its place: the mesh is replaced again when it is a fifth worse than that.  Where no new mesh is found, the
    next try waits until the cells are a fifth worse.

    Parameters
    ----------
    by
        ``rezone``: the same cells with their nodes in other places; ``new cells``: other triangles or tetrahedra, and
        in the plane a boundary that is spaced anew; ``auto``: rezoning, and new cells where no rezoned mesh is within
        the limits and the cells are triangles or tetrahedra of one material.
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

    def asks(self, now: Quality, last: Quality) -> str:
        """The measure that asks for another mesh, as text; empty if none does.

        Parameters
        ----------
        now, last
            Quality of the worst cells at present, and when they were new.

        Examples
        --------
        >>> Remesh().asks((0.5, 40.0, 3.0), (1.0, 90.0, 1.0)), Remesh().asks((0.2, 40.0, 3.0), (1.0, 90.0, 1.0))
        ('', 'scaled Jacobian 0.2')
        """
        limits = (
            min(self.quality, WORSE * last[0]),
            min(self.angle, WORSE * last[1]),
            max(self.ratio, last[2] / WORSE),
        )
        if now[0] < limits[0]:
            return f"scaled Jacobian {now[0]:.3g}"
        if now[1] < limits[1]:
            return f"angle of {now[1]:.3g} degrees"
        return f"ratio of edges {now[2]:.3g}" if now[2] > limits[2] else ""

    def within(self, quality: Quality) -> bool:
        """Whether the worst cells are within the limits.

        Examples
        --------
        >>> Remesh().within((0.5, 40.0, 3.0)), Remesh().within((0.5, 40.0, 30.0))
        (True, False)
        """
        jacobian, angle, ratio = quality
        return jacobian >= self.quality and angle >= self.angle and ratio <= self.ratio

    def improves(self, new: Quality, now: Quality) -> bool:
        """Whether a new mesh is worth its change.

        Where the present cells are bad, beyond the standard limits, the new ones are within the limits, or a measure
        is a tenth better and none a fifth worse.  Where they are good no measure of the new ones is a fifth worse.

        Examples
        --------
        >>> [Remesh().improves(new, (0.2, 19.0, 5.0)) for new in ((0.27, 20.0, 5.0), (0.21, 20.0, 5.0))]
        [True, False]
        """
        if STANDARD.within(now):
            return not worse(new, now)
        better = any(a > b + GAIN * abs(b) for a, b in zip(new[:2], now[:2], strict=True))
        return self.within(new) or (better and not worse(new, now))


def worse(now: Quality, last: Quality) -> bool:
    """Whether a measure is a fifth worse than it was.

    Examples
    --------
    >>> worse((0.5, 40.0, 3.0), (0.6, 45.0, 2.5)), worse((-0.5, 40.0, 3.0), (-0.4, 40.0, 3.0))
    (False, True)
    """
    lower = any(a < b - (1.0 - WORSE) * abs(b) for a, b in zip(now[:2], last[:2], strict=True))
    return lower or now[2] > last[2] / WORSE


STANDARD = Remesh()
"""Standard limits."""
Remeshing = Remesh | Literal["auto"] | None
"""Replacement of the mesh of a solid; ``auto`` is that of ``Remesh()``, None that of a mesh that stays."""


def remesh_of(given: Remeshing) -> Remesh | None:
    """Replacement of a mesh; None if it stays.

    Examples
    --------
    >>> remesh_of("auto") == Remesh(), remesh_of(None)
    (True, None)
    """
    return Remesh() if given == "auto" else given
