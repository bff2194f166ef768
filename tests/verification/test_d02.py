"""D02: a body with a stress turns without strain, by any angle per slab, for every rate."""

import numpy as np
import pytest

import results
import softway as sw
from softway.bodies.memory import Memory
from softway.typing import Array
from softway.verify.scenes.driving import RATES, cube, square

CASE = results.case("D02")["definition"]
LAW = {name: sw.Hypoelastic(E=1.0, nu=0.3, rate=rate) for name, rate in RATES.items()}


def turn(angle: float, dim: int) -> Array:
    """Rotation (3, 3) about z, in space about the axis of the case."""
    return sw.Rotation(angle=angle, axis=(0.0, 0.0, 1.0) if dim == 2 else tuple(CASE["axis_3D"])).matrix()


def initial(dim: int) -> Array:
    """The stress (3, 3) of the case."""
    stress = np.zeros((3, 3))
    stress[:dim, :dim] = CASE[f"stress_{dim}D"]
    return stress


def turned(rate: str, dim: int, steps: int, quarters: int) -> tuple[Memory, Array]:
    """Memory after the turns, and the volume ratio (p,)."""
    body = (square if dim == 2 else cube)(LAW[rate])
    path = [turn(0.5 * np.pi * k / steps, dim)[:dim, :dim] for k in range(1, steps * quarters + 1)]
    last = body.history(path, initial(dim))[-1]
    return last, body.volume_ratio(last)


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize(("steps", "quarters"), [(1, 1), (4, 1), (36, 1), (1, 40)])
def test_stress_and_volume(rate: str, dim: int, steps: int, quarters: int) -> None:
    """A quarter and ten turns."""
    memory, ratio = turned(rate, dim, steps, quarters)
    R = turn(0.5 * np.pi * quarters, dim)
    np.testing.assert_allclose(memory.stress, [R @ initial(dim) @ R.T] * len(ratio), rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(ratio, 1.0, rtol=0.0, atol=1e-14)
    assert np.abs(memory.stored).max() < 1e-14


def test_the_case() -> None:
    memory, _ = turned("jaumann", 2, 36, 1)
    _, ratio = turned("jaumann", 2, 36, 40)
    quarter = np.array(results.case("D02")["reference"]["theta90_2D"])
    error = np.abs(memory.stress[:, :2, :2] - quarter).max()
    assert results.outside("D02", {"stress error N=36 per 90deg": error, "volume after 10 turns": ratio[0]}) == set()
    assert error < 1e-13


@pytest.mark.parametrize("angle", [0.9, 0.999])
def test_nearly_half_a_turn_in_a_slab(angle: float) -> None:
    """The middle between the ends of a half turn is a point, where only the polar increment still knows the way."""
    for rate in RATES:
        body = square(LAW[rate])
        R = turn(angle * np.pi, 2)
        last = body.history([R[:2, :2]], initial(2))[-1]
        np.testing.assert_allclose(last.stress[0], R @ initial(2) @ R.T, rtol=0.0, atol=1e-9)


def test_half_a_turn_by_the_polar_increment() -> None:
    for dim in (2, 3):
        R = turn(np.pi, dim)
        body = (square if dim == 2 else cube)(LAW["jaumann, polar"])
        memory = body.history([R[:dim, :dim]], initial(dim))[-1]
        np.testing.assert_allclose(memory.stress[0], R @ initial(dim) @ R.T, rtol=0.0, atol=1e-12)
