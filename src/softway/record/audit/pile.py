"""Audit of the run of a pile: overlaps, energies and momenta computed again from the motion of its balls.

Nothing of the march is used.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from softway.arrays import Array
from softway.errors import InputError
from softway.piles.pile import Pile
from softway.record.pile.motion import BallMotion
from softway.record.pile.summary import energy_scale
from softway.record.read.records import Records

LIMIT = 1e-9
"""Overlap relative to the smallest radius, and error relative to the greatest value, beyond which it is a finding."""
ROUNDING = 16.0 * float(np.finfo(float).eps)
"""Rounding error of a gap, relative to the greatest coordinate."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PileAudit:
    """What the audit of the run of a pile found.

    Parameters
    ----------
    instants
        Number of stored instants.
    between, walls
        Deepest overlap of two balls, and of a ball with a wall [m], zero where none overlap.
    least
        Overlap from which on it is a finding [m].
    balances
        Greatest errors of the energies, of their balance, of momentum and of spin in ``history.csv``, and of the
        rotations, relative to the greatest of each.
    """

    instants: int
    between: float
    walls: float
    least: float
    balances: Mapping[str, float]

    @property
    def findings(self) -> tuple[str, ...]:
        """Sentences on errors beyond rounding."""
        depths = (("two balls overlap", self.between), ("a ball overlaps a wall", self.walls))
        found = [f"{what} by {depth:.3g} m" for what, depth in depths if not depth <= self.least]
        found += [
            f"{name}: error of {error:.3g} against the motion, relative to the greatest"
            for name, error in self.balances.items()
            if not error <= LIMIT
        ]
        return tuple(found)


def audited_pile(run: Records, pile: Pile) -> PileAudit:
    """Audit the run of a pile.

    Parameters
    ----------
    run
        The run.
    pile
        The pile that its scenario describes.

    Raises
    ------
    InputError
        If a record of the run is missing, damaged or empty, or of other balls.
    """
    motion, radii = run.balls, pile.balls.radii
    if not (len(motion.times) and run.history.rows):
        raise InputError(str(run.path), "holds no instant yet", "a run that has started to move")
    if motion.centres.shape[1:] != (pile.balls.count, pile.balls.dim):
        raise InputError(str(run.path), "holds other balls than its scenario", "the unchanged run folder")
    extent = float(np.abs(motion.centres).max()) + float(radii.max())
    return PileAudit(
        instants=len(motion.times),
        between=max(_between(centres, radii) for centres in motion.centres),
        walls=_into_walls(motion, pile),
        least=LIMIT * float(radii.min()) + ROUNDING * extent,
        balances=_balances(run, motion, pile),
    )


def _between(centres: Array, radii: Array) -> float:
    """Deepest overlap of two balls [m]."""
    pairs = cKDTree(centres).query_pairs(2.0 * float(radii.max()), output_type="ndarray")
    apart = np.linalg.norm(centres[pairs[:, 0]] - centres[pairs[:, 1]], axis=1)
    return float((radii[pairs].sum(axis=1) - apart).max(initial=0.0))


def _into_walls(motion: BallMotion, pile: Pile) -> float:
    """Deepest overlap of a ball with a wall [m]."""
    deepest = 0.0
    for wall in pile.walls:
        normal = np.asarray(wall.normal, float) / np.linalg.norm(wall.normal)
        gaps = motion.centres @ normal - float(np.dot(wall.point, normal)) - pile.balls.radii
        deepest = max(deepest, -float(gaps.min()))
    return deepest


def _balances(run: Records, motion: BallMotion, pile: Pile) -> dict[str, float]:
    """Relative errors of the columns of the history, and of the rotations."""
    history, mass, inertia = run.history, pile.balls.mass, pile.balls.inertia
    rows = slice(min(history.rows, len(motion.times)))  # a killed run may have written one instant more to one of them
    gravity = np.zeros(pile.balls.dim) if pile.gravity is None else np.asarray(pile.gravity, float)
    squares = (motion.velocities**2).sum(axis=2) @ mass + (motion.spins**2).sum(axis=2) @ inertia
    kinetic, potential = 0.5 * squares, -(motion.centres @ gravity) @ mass
    energy = max(energy_scale(history), float(np.abs(potential).max()), 1e-300)
    balance = (kinetic + potential)[rows] + history["dissipation"][rows]
    found = {
        "the kinetic energy": float(np.abs(kinetic[rows] - history["energy_kinetic"][rows]).max()) / energy,
        "the potential energy": float(np.abs(potential[rows] - history["energy_potential"][rows]).max()) / energy,
        "the energy balance": float(np.abs(balance - balance[0]).max()) / energy,
    }
    momenta, places = mass[:, None] * _space(motion.velocities), _space(motion.centres)
    turning = np.zeros_like(momenta)
    turning[..., 3 - motion.spins.shape[2] :] = inertia[:, None] * motion.spins
    for name, each in (("momentum", momenta), ("spin", np.cross(places, momenta) + turning)):
        columns = np.stack([history[f"{name}_{a}"][rows] for a in "xyz"], axis=1)
        scale = float(np.linalg.norm(each, axis=2).sum(axis=1).max()) or 1.0
        found[f"the {name}"] = float(np.abs(columns - each.sum(axis=1)[rows]).max()) / scale
    found["the rotations"] = float(np.abs(np.linalg.norm(motion.turns, axis=2) - 1.0).max())
    return found


def _space(vectors: Array) -> Array:
    """Vectors (t, n, 3) of those in the plane or in space."""
    out = np.zeros((*vectors.shape[:2], 3))
    out[..., : vectors.shape[2]] = vectors
    return out
