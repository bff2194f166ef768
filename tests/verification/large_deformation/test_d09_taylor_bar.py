"""D09: Taylor's bar, a copper cylinder thrown at a rigid wall, as a body of revolution.

A coarse mesh here, of 3 by 15 cells; those of the case, 5 by 25 and 10 by 50, are made by ``softway verify``.
"""

import pytest

import results
from softway.apps.verify.cases.large_deformation.d09_taylor_bar import bar, quantities
from softway.apps.verify.scenes import taylor

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def crushed() -> taylor.Crushed:
    """67 slabs of 1.3 us and less."""
    return bar((3, 15), 1.3e-6)[0]


def test_the_case(crushed: taylor.Crushed) -> None:
    """But for what a finer mesh has to tell."""
    found = quantities(crushed)
    assert results.outside("D09", found) & set(found) == set()


def test_energy_and_wall(crushed: taylor.Crushed) -> None:
    """The kinetic energy of 239.8 J becomes plastic work; nothing is lost, and nothing enters the wall."""
    first = 0.5 * crushed.mass * taylor.SPEED**2
    assert crushed.dissipated == pytest.approx(first, rel=5e-3)
    assert crushed.error < 1e-8 * first
    assert crushed.depth < 1e-15
    assert crushed.least_ratio > 0.9
