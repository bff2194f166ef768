"""Arrays of a pile for the compiled slabs (time steps), in space; the ground is the last body."""

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.kernels.pile import tables
from softway.kernels.pile.search import near_pairs
from softway.piles.pile import Pile

OVERLAP = 1e-9
"""Overlap at the start, relative to the smallest radius, that is rounding."""
TOLERANCE = 8e-11
"""Overlap at the end of a slab that is left, relative to the smallest radius."""
ROUNDING = 16.0 * float(np.finfo(float).eps)
"""Rounding error of a gap, relative to the greatest coordinate."""


def ball_tables(pile: Pile) -> tables.Balls:
    """Table of the balls, and the ground."""
    mass, inertia = pile.balls.mass, pile.balls.inertia
    return tables.Balls(
        radius=np.append(pile.balls.radii, 0.0),
        mass=np.append(mass, 0.0),
        inertia=np.append(inertia, 0.0),
        inverse_mass=np.append(1.0 / mass, 0.0),
        inverse_inertia=np.append(1.0 / inertia, 0.0),
    )


def wall_tables(pile: Pile) -> tables.Walls:
    """Table of the walls."""
    normal, offset, laws = np.zeros((len(pile.walls), 3)), np.zeros(len(pile.walls)), np.zeros((2, len(pile.walls)))
    for k, wall in enumerate(pile.walls):
        direction = np.asarray(wall.normal, float) / np.linalg.norm(wall.normal)
        normal[k, : pile.balls.dim], offset[k] = direction, direction @ np.asarray(wall.point, float)
        laws[0, k] = pile.friction if wall.friction is None else wall.friction
        laws[1, k] = pile.restitution if wall.restitution is None else wall.restitution
    return tables.Walls(normal=normal, offset=offset, friction=laws[0].copy(), restitution=laws[1].copy())


def laws(pile: Pile, sweeps: int) -> tables.Laws:
    """Laws of the pile, with the tolerance of gaps."""
    extent = max(float(np.abs(part).max(initial=0.0)) for part in (pile.balls.centres, wall_tables(pile).offset))
    return tables.Laws(
        gravity=in_space(np.zeros(pile.balls.dim) if pile.gravity is None else pile.gravity),
        friction=float(pile.friction),
        restitution=float(pile.restitution),
        tolerance=max(TOLERANCE * float(pile.balls.radii.min()), ROUNDING * extent),
        sweeps=sweeps,
    )


def motion(pile: Pile) -> tuple[Array, Array]:
    """Places (n, 3), and velocities and spins (n + 1, 6), at the start."""
    n, dim = pile.balls.count, pile.balls.dim
    velocity = np.zeros((n + 1, 6))
    if pile.balls.velocities is not None:
        velocity[:n, :dim] = pile.balls.velocities
    if pile.balls.spins is not None:
        velocity[:n, 5 if dim == 2 else slice(3, 6)] = pile.balls.spins
    return in_space(pile.balls.centres), velocity


def in_space(given: object) -> Array:
    """Vectors (..., 2) or (..., 3) in space."""
    vectors = np.asarray(given, float)
    found = np.zeros((*vectors.shape[:-1], 3))
    found[..., : vectors.shape[-1]] = vectors
    return found


def require_apart(balls: tables.Balls, walls: tables.Walls, place: Array) -> None:
    """Refuse balls that overlap each other or walls at the start.

    Raises
    ------
    InputError
        With the numbers of the two.
    """
    n, least = len(place), OVERLAP * float(balls.radius[:-1].min())
    for i, j in near_pairs(place, balls.radius, np.zeros(n), walls):
        if j < n:
            gap = float(np.linalg.norm(place[j] - place[i])) - balls.radius[i] - balls.radius[j]
        else:
            gap = float(walls.normal[j - n] @ place[i]) - walls.offset[j - n] - balls.radius[i]
        if gap < -least:
            other = f"ball {j}" if j < n else f"wall {j - n}"
            raise InputError("balls", f"ball {i} overlaps {other} by {-gap:.3g} m at the start", "places further apart")
