"""D02: rigid rotation of a stressed body, by any angle per slab. E = 1, nu = 0.3."""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome, sheet
from softway.apps.verify.scenes.driving import RATES, cube, square
from softway.arrays import Array
from softway.bodies.internal_force.material_state import MaterialState


def law(rate: str) -> sw.Hypoelastic:
    """Hypoelastic material with the given rate."""
    return sw.Hypoelastic(E=1.0, nu=0.3, rate=RATES[rate])


def turn(angle: float, dim: int) -> Array:
    """Rotation (3, 3) about z; in 3D about the axis of the case."""
    x, y, z = sheet("D02")["definition"]["axis_3D"]
    return sw.bodies.Rotation(angle=angle, axis=(0.0, 0.0, 1.0) if dim == 2 else (x, y, z)).matrix()


def initial(dim: int) -> Array:
    """Initial stress (3, 3) of the case."""
    stress = np.zeros((3, 3))
    stress[:dim, :dim] = sheet("D02")["definition"][f"stress_{dim}D"]
    return stress


@cache
def turned(rate: str, dim: int, steps: int, quarters: int) -> tuple[MaterialState, Array]:
    """History variables after the rotations, and the volume ratio (p,)."""
    body = (square if dim == 2 else cube)(law(rate))
    path = [turn(0.5 * np.pi * k / steps, dim)[:dim, :dim] for k in range(1, steps * quarters + 1)]
    last = body.history(path, initial(dim))[-1]
    return last, body.volume_ratio(last)


def compute() -> Outcome:
    """Compute a quarter turn and ten turns, with 36 slabs per quarter and the Jaumann rate."""
    memory, _ = turned("jaumann", 2, 36, 1)
    _, ratio = turned("jaumann", 2, 36, 40)
    quarter = np.array(sheet("D02")["reference"]["theta90_2D"])
    error = float(np.abs(memory.stress[:, :2, :2] - quarter).max())
    return Outcome(values={"stress error N=36 per 90deg": error, "volume after 10 turns": float(ratio[0])})
