"""Groups of balls for scenario files: a lattice, a list, or a table in a file; and the pile of several groups."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from softway.arrays import Array
from softway.errors import InputError
from softway.piles.ball_table import table_columns
from softway.piles.balls import Balls, lattice
from softway.units import KilogramPerCubicMetre, Metre, MetrePerSecond, RadianPerSecond


@dataclass(frozen=True, slots=True, kw_only=True)
class BallLattice:
    """Equal balls on a square lattice, each moved by a random part of ``jitter``: discs in the plane, spheres in space.

    Parameters
    ----------
    count
        Number of balls along each axis.
    radius, density
        Of each ball [m], [kg/m^3]; discs are 1 m thick.
    lowest
        Centre of the ball with the lowest coordinates, before it is moved [m].
    spacing
        Distance of neighbours [m]; the diameter and twice the jitter by default.
    jitter
        Greatest displacement along each axis [m], uniformly distributed on both sides.
    seed
        Seed of the random numbers: the same seed gives the same places.
    velocity
        Velocity of all balls at the start [m/s]; none by default.

    Examples
    --------
    >>> BallLattice(count=(3, 2), radius=0.5, density=1.0, lowest=(0.0, 0.0)).build().count
    6
    """

    count: tuple[int, ...]
    radius: Metre
    density: KilogramPerCubicMetre
    lowest: tuple[Metre, ...]
    spacing: Metre | None = None
    jitter: Metre = 0.0
    seed: int = 0
    velocity: tuple[MetrePerSecond, ...] | None = None

    def build(self) -> Balls:
        """Balls of the group.

        Raises
        ------
        InputError
            As for :func:`~softway.piles.lattice`.
        """
        balls = lattice(
            count=self.count,
            radius=self.radius,
            density=self.density,
            lowest=self.lowest,
            spacing=self.spacing,
            jitter=self.jitter,
            seed=self.seed,
        )
        return moving(balls, self.velocity)


@dataclass(frozen=True, slots=True, kw_only=True)
class BallList:
    """Balls in a list.

    Parameters
    ----------
    centres
        Centre of each ball at the start [m]: two coordinates in the plane, three in space.
    radius, density
        One for all, or one for each ball [m], [kg/m^3]; discs are 1 m thick.
    velocities
        Velocity of each ball at the start [m/s]; none by default.
    spins
        Angular velocity of each ball at the start [rad/s], one number for a disc and three in space; none by default.

    Examples
    --------
    >>> BallList(centres=((0.0, 0.0), (1.0, 0.0)), radius=(0.5,), density=(1.0,)).build().mass.round(4).tolist()
    [0.7854, 0.7854]
    """

    centres: tuple[tuple[Metre, ...], ...]
    radius: tuple[Metre, ...]
    density: tuple[KilogramPerCubicMetre, ...]
    velocities: tuple[tuple[MetrePerSecond, ...], ...] | None = None
    spins: tuple[tuple[RadianPerSecond, ...], ...] | None = None

    def build(self) -> Balls:
        """Balls of the group.

        Raises
        ------
        InputError
            As for :class:`~softway.piles.Balls`.
        """
        return balls_of(self.centres, self.radius, self.density, self.velocities, self.spins)


@dataclass(frozen=True, slots=True, kw_only=True)
class BallFile:
    """Balls in a table: a file of comma-separated numbers in SI units, one line for each ball, with a header.

    Parameters
    ----------
    path
        The file, from the folder of the scenario.  Columns ``x``, ``y`` and, in space, ``z``; ``radius`` and
        ``density`` unless they are given here; if wanted ``velocity_x`` ..., and ``spin`` of discs or ``spin_x`` ...;
        units in brackets after the names, such as ``x [m]``, are for the reader.
    radius, density
        Of all balls [m], [kg/m^3]; by default as in the file.

    Examples
    --------
    >>> BallFile(path=Path("gravel.csv"), density=2600.0).radius is None
    True
    """

    path: Path
    radius: Metre | None = None
    density: KilogramPerCubicMetre | None = None

    def build(self) -> Balls:
        """Balls of the file.

        Raises
        ------
        InputError
            If the file cannot be read, or as for :class:`~softway.piles.Balls`.
        """
        given = {"radius": self.radius, "density": self.density}
        columns = table_columns(self.path, [name for name, value in given.items() if value is None])
        axes = "xyz" if "z" in columns else "xy"
        velocities = _several(columns, [f"velocity_{a}" for a in axes])
        spins = _several(columns, ["spin"] if len(axes) == 2 else [f"spin_{a}" for a in axes])
        centres = np.stack([columns[a] for a in axes], axis=1)
        radius, density = (columns[name] if value is None else np.array([value]) for name, value in given.items())
        return balls_of(centres, radius, density, velocities, spins)


BallGroup = BallLattice | BallList | BallFile


def balls_of(
    centres: ArrayLike, radius: ArrayLike, density: ArrayLike, velocities: ArrayLike | None, spins: ArrayLike | None
) -> Balls:
    """Balls with rows of numbers; a single radius or density is that of all, and spins of discs may be rows of one."""
    one = spins is not None and all(np.size(spin) == 1 for spin in np.asarray(spins, object))
    return Balls(
        centres=centres,
        radius=np.ravel(radius)[0] if np.size(radius) == 1 else radius,
        density=np.ravel(density)[0] if np.size(density) == 1 else density,
        velocities=velocities,
        spins=np.ravel(np.asarray(spins, float)) if one else spins,
    )


def moving(balls: Balls, velocity: Sequence[float] | None) -> Balls:
    """Balls that all have a velocity at the start.

    Raises
    ------
    InputError
        If it has another number of components.
    """
    if velocity is None:
        return balls
    if len(velocity) != balls.dim:
        raise InputError("velocity", f"{velocity} in {balls.dim}D", f"{balls.dim} components")
    return replace(balls, velocities=np.tile(velocity, (balls.count, 1)))


def _several(columns: Mapping[str, Array], names: Sequence[str]) -> Array | None:
    """Columns side by side; None without any of them, zeros for a missing one."""
    if not any(name in columns for name in names):
        return None
    none = np.zeros_like(columns["x"])
    return np.stack([columns.get(name, none) for name in names], axis=1)


def together(groups: Mapping[str, Balls]) -> Balls:
    """Balls of all groups, one after the other.

    Raises
    ------
    InputError
        If groups are in the plane and in space.

    Examples
    --------
    >>> one = BallLattice(count=(2, 2), radius=0.5, density=1.0, lowest=(0.0, 0.0)).build()
    >>> together({"a": one, "b": one}).count
    8
    """
    parts = list(groups.values())
    for name, part in groups.items():
        if part.dim != parts[0].dim:
            problem = f"balls in {part.dim}D together with {next(iter(groups))!r} in {parts[0].dim}D"
            raise InputError(name, problem, f"{parts[0].dim} coordinates")
    n, dim = sum(part.count for part in parts), parts[0].dim
    velocities, spins = np.zeros((n, dim)), np.zeros((n, 3) if dim == 3 else n)
    first = 0
    for part in parts:
        rows = slice(first, first := first + part.count)
        velocities[rows] = 0.0 if part.velocities is None else part.velocities
        spins[rows] = 0.0 if part.spins is None else part.spins
    return Balls(
        centres=np.concatenate([np.asarray(part.centres, float) for part in parts]),
        radius=np.concatenate([part.radii for part in parts]),
        density=np.concatenate([np.broadcast_to(np.asarray(part.density, float), part.count) for part in parts]),
        velocities=velocities,
        spins=spins,
    )
