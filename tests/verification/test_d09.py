"""D09: Taylor's bar, a copper cylinder thrown at a rigid wall, as a body of revolution.

The corner folds: the side of the bar is a contact surface too.  A coarse mesh here, of 3 by 15 cells; 5 by 25 and 10 by
50 are in docs/verification/large_deformation.md, made by ``examples/taylor_bar.py``.
"""

import pytest

import results
from softway.verify.scenes import taylor
from softway.verify.scenes.taylor import Crushed


@pytest.fixture(scope="module")
def crushed() -> Crushed:
    """67 slabs of 1.3 us and less."""
    return taylor.crushed(cells=(3, 15), step=1.3e-6)


def test_the_case(crushed: Crushed) -> None:
    """The plastic strain is the greatest mean of a cell."""
    found = {
        "final length mm": crushed.length,
        "mushroom radius mm": crushed.radius,
        "max equivalent plastic strain": crushed.strain,
        "volume change": crushed.growth,
    }
    assert results.outside("D09", found) == set()


def test_energy_and_wall(crushed: Crushed) -> None:
    """The kinetic energy of 239.8 J becomes plastic work; nothing is lost, and nothing enters the wall."""
    first = 0.5 * crushed.mass * taylor.SPEED**2
    assert crushed.dissipated == pytest.approx(first, rel=5e-3)
    assert crushed.error < 1e-8 * first
    assert crushed.depth < 1e-15
    assert crushed.least_ratio > 0.9
