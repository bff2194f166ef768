"""Balls of a pile: places, radii, density, and motion at the start."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from softway.arrays import Array
from softway.errors import InputError, positive
from softway.units import KilogramPerCubicMetre, Metre

FAR = 1e100
"""Coordinate beyond which nothing can be computed [m]."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Balls:
    """Uniform rigid balls in space, or discs in the plane, by the number of coordinates of their ``centres``.

    Parameters
    ----------
    centres
        (n, d) centres at the start [m].
    radius
        Radius [m]: one for all, or (n,).
    density
        Density [kg/m^3]: one for all, or (n,); discs are 1 m thick.
    velocities
        (n, d) velocities at the start [m/s]; none by default.
    spins
        (n,) angular velocities of discs, (n, 3) of balls, at the start [rad/s]; none by default.

    Raises
    ------
    InputError
        If there are no balls, a shape does not fit, or a radius or a density is not positive.

    Examples
    --------
    >>> two = Balls(centres=[[0.0, 0.0, 0.0], [0.3, 0.0, 0.0]], radius=0.1, density=1000.0)
    >>> two.dim, two.mass.round(4).tolist()
    (3, [4.1888, 4.1888])
    """

    centres: ArrayLike
    radius: ArrayLike
    density: ArrayLike
    velocities: ArrayLike | None = None
    spins: ArrayLike | None = None

    def __post_init__(self) -> None:
        centres = _numbers("centres", self.centres)
        if centres.ndim != 2 or centres.shape[1] not in (2, 3) or not len(centres):
            problem = f"has the shape {centres.shape}"
            raise InputError("centres", problem, "a row of 2 coordinates in the plane, or of 3 in space, for each ball")
        n, dim = centres.shape
        for name, given in (("radius", self.radius), ("density", self.density)):
            value = _numbers(name, given)
            if value.shape not in ((), (n,)):
                raise InputError(name, f"has the shape {value.shape} for {n} balls", f"one number, or {n}")
            positive(**{name: float(value.min())})
        shapes = {"velocities": (n, dim), "spins": (n,) if dim == 2 else (n, 3)}
        for name, motion in (("velocities", self.velocities), ("spins", self.spins)):
            if motion is not None and _numbers(name, motion).shape != shapes[name]:
                problem = f"has the shape {np.shape(motion)} for {n} balls in {dim}D"
                raise InputError(name, problem, f"the shape {shapes[name]}")

    @property
    def count(self) -> int:
        """Number of balls."""
        return len(np.asarray(self.centres))

    @property
    def dim(self) -> int:
        """2 in the plane, 3 in space."""
        return int(np.asarray(self.centres).shape[1])

    @property
    def radii(self) -> Array:
        """Radii (n,) [m]."""
        return np.broadcast_to(np.asarray(self.radius, float), self.count).copy()

    @property
    def mass(self) -> Array:
        """Masses (n,) [kg]."""
        volume = np.pi * self.radii**2 if self.dim == 2 else 4.0 / 3.0 * np.pi * self.radii**3
        return np.asarray(volume * np.asarray(self.density, float))

    @property
    def inertia(self) -> Array:
        """Moments of inertia (n,) about an axis through the centre [kg m^2]."""
        return np.asarray((0.5 if self.dim == 2 else 0.4) * self.mass * self.radii**2)


def lattice(
    *,
    count: tuple[int, ...],
    radius: Metre,
    density: KilogramPerCubicMetre,
    lowest: tuple[Metre, ...],
    spacing: Metre | None = None,
    jitter: Metre = 0.0,
    seed: int = 0,
) -> Balls:
    """Equal balls on a square lattice, each moved by a random part of ``jitter``.

    Parameters
    ----------
    count
        Number of balls along each axis: two axes in the plane, three in space.
    radius, density
        Of each ball [m], [kg/m^3].
    lowest
        Centre of the ball with the lowest coordinates, before it is moved [m].
    spacing
        Distance of neighbours [m]; the diameter and twice the jitter by default.
    jitter
        Greatest displacement along each axis [m], uniformly distributed on both sides.
    seed
        Seed of the random numbers: the same seed gives the same places.

    Raises
    ------
    InputError
        If the numbers do not fit, or balls could overlap.

    Examples
    --------
    >>> lattice(count=(3, 2), radius=0.5, density=1.0, lowest=(0.0, 0.0)).centres.tolist()
    [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0], [2.0, 0.0], [2.0, 1.0]]
    """
    positive(radius=radius)
    if len(count) not in (2, 3) or min(count) < 1:
        raise InputError("count", f"{count}", "numbers of 1 or more along two axes, or along three")
    if len(lowest) != len(count):
        raise InputError("lowest", f"{lowest} for a lattice in {len(count)}D", f"{len(count)} coordinates")
    if not 0.0 <= jitter < np.inf:
        raise InputError("jitter", f"{jitter:g} m is negative, or not finite", "zero or more")
    least = 2.0 * (radius + jitter)
    apart = least if spacing is None else spacing
    if not least <= apart * (1.0 + 1e-12) < np.inf:
        problem = f"{apart:g} m is less than the diameter and twice the jitter, {least:g} m"
        raise InputError("spacing", problem, f"{least:g} m or more")
    steps = np.stack(np.meshgrid(*(np.arange(k) for k in count), indexing="ij"), axis=-1).reshape(-1, len(count))
    moved = np.random.default_rng(seed).uniform(-jitter, jitter, steps.shape)
    return Balls(centres=np.asarray(lowest, float) + apart * steps + moved, radius=radius, density=density)


def _numbers(name: str, given: ArrayLike) -> Array:
    """Array of finite numbers."""
    try:
        found = np.asarray(given, float)
    except (TypeError, ValueError):
        raise InputError(name, "are no numbers, or rows of different lengths", "an array of numbers") from None
    if not (np.abs(found) < FAR).all():
        raise InputError(name, "has entries that are not finite, or too great", "an array of finite numbers")
    return found
