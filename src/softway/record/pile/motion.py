"""balls.f64: places, rotations and velocities of all balls at the stored instants.

The file is a row of numbers of 8 bytes, the lowest byte first, a block for each instant: the time, then the centres
(n, d), the unit quaternions (n, 4), scalar first, the velocities (n, d), and the angular velocities, (n, 1) of discs
and (n, 3) in space.  A block that is incomplete after a killed run is not read.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.piles.march import PileStep
from softway.record.storage.gate.own_files import plain_file

FILE = "balls.f64"
NUMBER = "<f8"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BallMotion:
    """Motion of the balls of a pile at the stored instants t.

    Parameters
    ----------
    times
        (t,) instants [s].
    centres, velocities
        (t, n, d) [m], [m/s].
    turns
        (t, n, 4) rotations from the start as unit quaternions, scalar first.
    spins
        Angular velocities [rad/s], (t, n, 1) of discs and (t, n, 3) in space.
    """

    times: Array
    centres: Array
    turns: Array
    velocities: Array
    spins: Array

    @property
    def speeds(self) -> Array:
        """Speeds (t, n) [m/s]."""
        return np.asarray(np.linalg.norm(self.velocities, axis=2))


def moved(step: PileStep, slabs: int) -> Iterator[bytes]:
    """Block of a step."""
    parts = (np.array([step.time]), step.centres, step.turns, step.velocities, step.spins)
    yield np.concatenate([part.ravel() for part in parts]).astype(NUMBER).tobytes()


def read_motion(folder: Path, count: int, dim: int) -> BallMotion:
    """Motion of a number of balls in ``dim`` dimensions in a run folder.

    Raises
    ------
    InputError
        If the file is missing or cannot be read.
    """
    widths = [1, count * dim, count * 4, count * dim, count * (2 * dim - 3)]
    path = folder / FILE
    try:
        rows = plain_file(path).stat().st_size // (8 * sum(widths))
        found = np.memmap(path, NUMBER, "r", shape=(rows, sum(widths))) if rows else np.zeros((0, sum(widths)))
    except (OSError, ValueError) as error:
        raise InputError(str(path), f"cannot be read: {error}", "the unchanged run folder") from None
    times, *parts = np.split(found, np.cumsum(widths)[:-1], axis=1)
    centres, turns, velocities, spins = (
        np.asarray(part).reshape(rows, count, part.shape[1] // count) for part in parts
    )
    return BallMotion(times=np.array(times[:, 0]), centres=centres, turns=turns, velocities=velocities, spins=spins)
