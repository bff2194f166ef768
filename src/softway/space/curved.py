"""Rigid obstacles with curved or cornered surfaces: signed distance and its gradient, positive outside."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

import numpy as np

from softway.errors import InputError
from softway.space.obstacles import HalfSpace
from softway.typing import Array
from softway.units import Metre, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class Sphere:
    """A ball; in 2D a disc.

    Parameters
    ----------
    centre
        Its centre [m].
    radius
        [m].

    Examples
    --------
    >>> float(Sphere(centre=(0.0, 0.0, 0.0), radius=1.0).gap(np.array([0.0, 3.0, 4.0])))
    4.0
    """

    centre: tuple[Metre, ...]
    radius: Metre

    def __post_init__(self) -> None:
        _positive("radius", self.radius)

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return len(self.centre)

    def gap(self, x: Array) -> Array:
        """Distance of points (..., d) [m], (...,); negative inside."""
        return np.linalg.norm(x - _fit(self.centre, x), axis=-1) - self.radius

    def normal_at(self, x: Array) -> Array:
        """Unit normals (..., d) at points (..., d)."""
        return _unit(x - _fit(self.centre, x))


@dataclass(frozen=True, slots=True, kw_only=True)
class Roller:
    """A cylinder without ends, in 3D.

    Parameters
    ----------
    point, axis
        A point of its axis [m] and the direction of the axis.
    radius
        [m].

    Examples
    --------
    >>> roll = Roller(point=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 2.0), radius=1.0)
    >>> float(roll.gap(np.array([3.0, 4.0, 7.0]))), roll.normal_at(np.array([3.0, 4.0, 7.0]))
    (4.0, array([0.6, 0.8, 0. ]))
    """

    point: tuple[Metre, Metre, Metre]
    axis: tuple[Pure, Pure, Pure]
    radius: Metre

    def __post_init__(self) -> None:
        _positive("radius", self.radius)
        _direction("axis", self.axis)

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return 3

    def gap(self, x: Array) -> Array:
        """Distance of points (..., 3) [m], (...,); negative inside."""
        return np.linalg.norm(self._across(x), axis=-1) - self.radius

    def normal_at(self, x: Array) -> Array:
        """Unit normals (..., 3) at points (..., 3)."""
        return _unit(self._across(x))

    def _across(self, x: Array) -> Array:
        axis = _unit(np.asarray(self.axis, float))
        arm = x - _fit(self.point, x)
        return np.asarray(arm - (arm @ axis)[..., None] * axis)


@dataclass(frozen=True, slots=True, kw_only=True)
class Block:
    """A box along the axes, with sharp edges; in 2D a rectangle.

    Outside, the distance is that from the closest point, so that the normal turns steadily around an edge.

    Parameters
    ----------
    low, high
        Opposite corners [m].

    Examples
    --------
    >>> step = Block(low=(0.0, 0.0), high=(2.0, 1.0))
    >>> step.gap(np.array([[1.0, 1.5], [5.0, 5.0], [1.0, 0.9]])).round(12)
    array([ 0.5,  5. , -0.1])
    """

    low: tuple[Metre, ...]
    high: tuple[Metre, ...]

    def __post_init__(self) -> None:
        if len(self.low) != len(self.high) or not all(a < b for a, b in zip(self.low, self.high, strict=True)):
            raise InputError("high", f"{self.high} is not above {self.low} in every direction", "low < high")

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return len(self.low)

    def gap(self, x: Array) -> Array:
        """Distance of points (..., d) [m], (...,); negative inside."""
        depth = self._depth(x)
        outside = np.linalg.norm(np.maximum(depth, 0.0), axis=-1)
        return np.asarray(outside + np.minimum(depth.max(axis=-1), 0.0))

    def normal_at(self, x: Array) -> Array:
        """Unit normals (..., d) at points (..., d); inside, that of the nearest face."""
        depth = self._depth(x)
        side = np.where(x >= 0.5 * (np.asarray(self.low) + np.asarray(self.high)), 1.0, -1.0)
        nearest = np.arange(depth.shape[-1]) == depth.argmax(axis=-1)[..., None]
        inside = depth.max(axis=-1, keepdims=True) <= 0.0
        return _unit(np.where(inside, nearest * side, np.maximum(depth, 0.0) * side))

    def _depth(self, x: Array) -> Array:
        """Signed distance (..., d) from the two faces across each axis."""
        return np.asarray(np.maximum(_fit(self.low, x) - x, x - _fit(self.high, x)))


@dataclass(frozen=True, slots=True, kw_only=True)
class Torus:
    """A ring with a round section, in 3D.

    Parameters
    ----------
    centre, axis
        Its centre [m] and the direction of its axis.
    radius, tube
        Radius of the centre line and of the section [m], ``tube < radius``.

    Examples
    --------
    >>> ring = Torus(centre=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0), radius=2.0, tube=0.5)
    >>> float(ring.gap(np.array([0.0, 0.0, 0.0])))
    1.5
    """

    centre: tuple[Metre, Metre, Metre]
    axis: tuple[Pure, Pure, Pure]
    radius: Metre
    tube: Metre

    def __post_init__(self) -> None:
        _positive("tube", self.tube)
        _direction("axis", self.axis)
        if not self.radius > self.tube:
            raise InputError(
                "radius", f"{self.radius:g} m is not greater than the tube {self.tube:g} m", "a greater one"
            )

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return 3

    def gap(self, x: Array) -> Array:
        """Distance of points (..., 3) [m], (...,); negative inside."""
        return np.linalg.norm(self._arm(x), axis=-1) - self.tube

    def normal_at(self, x: Array) -> Array:
        """Unit normals (..., 3) at points (..., 3)."""
        return _unit(self._arm(x))

    def _arm(self, x: Array) -> Array:
        """From the nearest point of the centre line (..., 3)."""
        axis = _unit(np.asarray(self.axis, float))
        arm = x - _fit(self.centre, x)
        across = arm - (arm @ axis)[..., None] * axis
        return np.asarray(arm - self.radius * _unit(across))


@dataclass(frozen=True, slots=True, kw_only=True)
class Cavity:
    """Everything outside of a shape: a bowl, a tube, a box to be in.

    Parameters
    ----------
    of
        The hollow.

    Examples
    --------
    >>> bowl = Cavity(of=Sphere(centre=(0.0, 0.0), radius=2.0))
    >>> float(bowl.gap(np.zeros(2) + 1e-300)), bowl.normal_at(np.array([1.0, 0.0]))
    (2.0, array([-1., -0.]))
    """

    of: Sphere | Roller | Block | Torus

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return self.of.dim

    def gap(self, x: Array) -> Array:
        """Distance of points (..., d) [m], (...,); negative in the wall."""
        return -self.of.gap(x)

    def normal_at(self, x: Array) -> Array:
        """Unit normals (..., d) at points (..., d), into the hollow."""
        return -self.of.normal_at(x)


Shape = HalfSpace | Sphere | Roller | Block | Torus | Cavity


KINDS: dict[str, type] = {k.__name__: k for k in (HalfSpace, Sphere, Roller, Block, Torus, Cavity)}
"""The obstacles by name."""


def described(shape: Shape) -> dict[str, Any]:
    """A shape as plain numbers with its ``kind``; :func:`recovered` turns them back.

    Examples
    --------
    >>> described(HalfSpace(point=1.0, normal=-1.0))
    {'kind': 'HalfSpace', 'point': 1.0, 'normal': -1.0}
    """
    values = {f.name: getattr(shape, f.name) for f in fields(shape)}
    plain = {n: described(v) if is_dataclass(v) else v for n, v in values.items()}  # type: ignore[arg-type]
    return {"kind": type(shape).__name__, **plain}


def recovered(data: Mapping[str, Any]) -> Shape:
    """The shape from what :func:`described` made of it.

    Examples
    --------
    >>> recovered(described(Sphere(centre=(0.0, 1.0), radius=2.0)))
    Sphere(centre=(0.0, 1.0), radius=2.0)
    """
    values = {n: recovered(v) if isinstance(v, Mapping) else v for n, v in data.items() if n != "kind"}
    values = {n: tuple(v) if isinstance(v, list) else v for n, v in values.items()}
    made: Shape = KINDS[data["kind"]](**values)
    return made


def _unit(v: Array) -> Array:
    """Unit vectors along (..., d); the first axis where there is no direction."""
    length = np.linalg.norm(v, axis=-1, keepdims=True)
    first = np.zeros(v.shape[-1])
    first[0] = 1.0
    return np.where(length > 0.0, v / np.where(length > 0.0, length, 1.0), first)


def _fit(point: tuple[float, ...], x: Array) -> Array:
    """The point as an array, if it lives in the space of x."""
    if x.shape[-1] != len(point):
        raise InputError(
            "", f"{len(point)} coordinates for a body in {x.shape[-1]} dimensions", "a shape of that space"
        )
    return np.asarray(point, float)


def _positive(where: str, value: float) -> None:
    if not 0.0 < value < np.inf:
        raise InputError(where, f"{value:g} m is not positive", "a positive length")


def _direction(where: str, vector: tuple[float, ...]) -> None:
    if not np.linalg.norm(vector) > 0.0:
        raise InputError(where, f"{list(vector)} is no direction", "a vector such as [0, 0, 1]")
