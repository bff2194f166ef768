"""A11: a bar released from uniform strain above a stop: three periods."""

import numpy as np
import pytest

import results
import softway as sw
from softway.apps.verify.cases.waves.a11_released_bar import BAR, pulled
from softway.apps.verify.exact import bar as waves
from softway.apps.verify.scenes import bars

pytestmark = pytest.mark.slow


def test_case() -> None:
    assert results.missed("A11") == set()


@pytest.mark.parametrize("cells", [100, 200])
def test_the_start_relaxes_the_node_without_inertia(cells: int) -> None:
    """The uniform strain is not in equilibrium at the free end: the share 1/N of the energy 1/8 goes at once."""
    march = pulled(cells)
    assert march.energy[0] == pytest.approx(0.125 * (1.0 - 1.0 / cells), rel=1e-12)


@pytest.mark.parametrize("cells", [100, 200])
def test_after_that_the_energy_stays(cells: int) -> None:
    march = pulled(cells)
    assert np.abs(march.error).max() <= 1e-9 * 0.125
    assert np.ptp(march.energy) <= 1e-12 * 0.125
    assert march.gap.min() >= -1e-12
    assert march.power.max() <= 1e-12 * 0.125


def test_the_force_level() -> None:
    march = pulled(200)
    for k in range(3):
        assert march.mean_force(1.1 + 3 * k, 1.9 + 3 * k) == pytest.approx(0.5, rel=0.01)
        assert march.force_error(1.1 + 3 * k, 1.9 + 3 * k, 0.5) <= 0.05


def test_the_drift_over_the_periods_is_small() -> None:
    """Each touch comes later than the exact one by about 0.002 to 0.003 a period with 100 elements."""
    starts = np.array([start for start, _ in pulled(100).contacts(apart=0.5)])
    assert np.all(np.diff(starts - [1.0, 4.0, 7.0]) <= 0.004)


def test_the_tip_follows_the_exact_bar() -> None:
    march, exact = pulled(200), waves.solve(BAR, 9.5)
    assert np.abs(march.displacement[:, 0] + exact.tip(march.times)).max() <= 0.01


def test_located_instants_give_the_same_motion() -> None:
    scalar, located = (bars.pulled(20, sw.contact.Energy(located=x), until=6.0, step=0.02) for x in (False, True))
    assert located.kinds == scalar.kinds
    assert np.abs(located.error).max() <= 1e-12 * 0.125
    assert np.abs(located.instants - scalar.instants).max() <= 0.1 * 0.02
    assert np.abs(located.displacement - scalar.displacement).max() <= 5e-3
