"""D02: a body with a stress turns without strain, by any angle per slab, for every rate."""

import numpy as np
import pytest

import results
from softway.apps.verify.cases.large_deformation.d02_rotated_stress import initial, law, turn, turned
from softway.apps.verify.scenes.driving import RATES, cube, square


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
    """To 1e-13 where 1e-10 is allowed."""
    assert results.missed("D02") == set()
    assert results.verdicts("D02")["stress error N=36 per 90deg"].error < 1e-13


@pytest.mark.parametrize("angle", [0.9, 0.999])
def test_nearly_half_a_turn_in_a_slab(angle: float) -> None:
    """The middle between the ends of a half turn is a point, where only the polar increment still knows the way."""
    for rate in RATES:
        body = square(law(rate))
        R = turn(angle * np.pi, 2)
        last = body.history([R[:2, :2]], initial(2))[-1]
        np.testing.assert_allclose(last.stress[0], R @ initial(2) @ R.T, rtol=0.0, atol=1e-9)


def test_half_a_turn_by_the_polar_increment() -> None:
    for dim in (2, 3):
        R = turn(np.pi, dim)
        body = (square if dim == 2 else cube)(law("jaumann, polar"))
        memory = body.history([R[:dim, :dim]], initial(dim))[-1]
        np.testing.assert_allclose(memory.stress[0], R @ initial(dim) @ R.T, rtol=0.0, atol=1e-12)
