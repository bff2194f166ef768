"""Moments of volumes and of areas in the plane: mass, centre and inertia of bodies of a uniform density."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.obstacles.primitives import Block, Cylinder, Shape, Sphere
from softway.obstacles.triangulated import Facets, Surface


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Moments:
    """Volume (area in the plane), its first moments (d,), and its second moments (d, d) about a point (d,)."""

    volume: float
    first: Array
    second: Array
    about: Array

    @property
    def centre(self) -> tuple[float, ...]:
        """Centre (d,) [m]."""
        return tuple((self.about + self.first / self.volume).tolist())

    def inertia(self, density: float) -> float | tuple[tuple[float, ...], ...]:
        """Inertia about the centre: a number in the plane, else a tensor (3, 3)."""
        mean, dim = self.first / self.volume, len(self.first)
        spread = density * (self.second - self.volume * np.outer(mean, mean))
        polar = float(np.trace(spread))
        return polar if dim == 2 else tuple(map(tuple, (polar * np.eye(3) - spread).tolist()))


def facet_moments(surface: Facets) -> Moments:
    """Moments of the volume inside a closed surface of flat facets, exactly; further shells inside it are cavities.

    Raises
    ------
    InputError
        If the surface is open.
    """
    dim = surface.dim
    if not surface.closed:
        problem = f"the surface of {len(surface.cells)} facets is open and encloses no volume"
        raise InputError("cells", problem, "a surface without holes: each edge belongs to two facets")
    about = surface.points.mean(axis=0)
    corners = (surface.points - about)[surface.cells]
    volume = np.linalg.det(corners) / (2.0 if dim == 2 else 6.0)
    total = corners.sum(axis=1)
    first = np.einsum("f,fi->i", volume, total) / (dim + 1)
    second = np.einsum("f,fki,fkj->ij", volume, corners, corners) + np.einsum("f,fi,fj->ij", volume, total, total)
    second /= (dim + 1) * (dim + 2)
    return Moments(volume=float(volume.sum()), first=first, second=second, about=about)


def shape_moments(shape: Shape) -> Moments:
    """Moments of the volume of an obstacle: ball or disc, cylinder, block or rectangle, closed surface of facets.

    Raises
    ------
    InputError
        For a shape without a finite volume.

    Examples
    --------
    >>> shape_moments(Block(low=(0.0, 0.0), high=(2.0, 1.0))).volume
    2.0
    """
    match shape:
        case Sphere():
            r, d = shape.radius, shape.dim
            volume = np.pi * r**2 if d == 2 else 4.0 / 3.0 * np.pi * r**3
            return _about(shape.centre, volume, volume * r**2 / (d + 2.0) * np.eye(d))
        case Block():
            low, high = np.asarray(shape.low, float), np.asarray(shape.high, float)
            volume = float(np.prod(high - low))
            return _about(0.5 * (low + high), volume, volume / 12.0 * np.diag((high - low) ** 2))
        case Cylinder():
            start, end = np.asarray(shape.start, float), np.asarray(shape.end, float)
            length = float(np.linalg.norm(end - start))
            one, volume = (end - start) / length, np.pi * shape.radius**2 * length
            across = shape.radius**2 / 4.0 * (np.eye(3) - np.outer(one, one))
            return _about(0.5 * (start + end), volume, volume * (across + length**2 / 12.0 * np.outer(one, one)))
        case Surface() | Facets():
            return facet_moments(shape.facets if isinstance(shape, Surface) else shape)
        case _:
            problem = f"{type(shape).__name__} has no finite volume of a density"
            remedy = "a Sphere, Block, Cylinder or closed Surface; or mass, centre and inertia"
            raise InputError("", problem, remedy)


def _about(centre: object, volume: float, second: Array) -> Moments:
    """Moments about the centre."""
    place = np.asarray(centre, float)
    return Moments(volume=float(volume), first=np.zeros(len(place)), second=second, about=place)
