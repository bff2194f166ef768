"""When and how the degraded mesh of a solid is replaced in a march."""

from dataclasses import dataclass
from typing import Literal

from softway.errors import InputError
from softway.units import Pure

Way = Literal["rezone"]
"""How a mesh is replaced."""
WORSE = 0.8
"""Quality, relative to that of the last new mesh, below which a measure that the mesh cannot reach counts again."""
Quality = tuple[float, float, float]
"""Least scaled Jacobian of the cells of a mesh, least angle [degrees], greatest ratio of edges."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Remesh:
    """Replacement of the mesh of a solid before its cells degenerate.

    The mesh is replaced between two slabs when a cell falls below one of the limits, or when a slab had to be much
    shorter than asked for.  Where the shape of the body allows no mesh within a limit, the quality of the last mesh
    takes its place: the mesh is replaced again when it is a fifth worse than that.

    Parameters
    ----------
    by
        ``rezone``: the same cells with their nodes in other places.
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

    by: Way = "rezone"
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


Remeshing = Remesh | Literal["auto"] | None
"""Replacement of the mesh of a solid; ``auto`` is that of ``Remesh()``, None that of a mesh that stays."""


def replacement(given: Remeshing) -> Remesh | None:
    """Replacement of a mesh; None if it stays.

    Examples
    --------
    >>> replacement("auto") == Remesh(), replacement(None)
    (True, None)
    """
    return Remesh() if given == "auto" else given
