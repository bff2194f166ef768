"""D03: closed cycles of a hypoelastic cell leave the stress and take the work that the differential equation has."""

import numpy as np
import pytest

import results
from orders import order
from softway.apps.verify.cases.large_deformation.d03_closed_cycle import cycled
from softway.apps.verify.scenes.driving import RATES
from softway.arrays import Array

REFERENCE = results.case("D03")["reference"]


def closed(rate: str, amplitude: float, *slabs: int) -> Array:
    """s11, s12, s22 and the work per volume after the cycle in which height and shift have one amplitude."""
    last = cycled(rate, amplitude, amplitude, *slabs)[-1]
    return np.array([*last.stress[0][[0, 0, 1], [0, 1, 1]], last.stored.mean()])


def test_the_case() -> None:
    """After each of the four legs, to 1e-6 where 1e-4 is allowed."""
    assert results.missed("D03") == set()
    for rate in ("jaumann", "truesdell"):
        legs = [m.stress[0][:2, :2] for m in cycled(rate)[100::100]]
        np.testing.assert_allclose(legs, REFERENCE["stress_after_each_step"][rate], rtol=0.0, atol=1e-6)


@pytest.mark.parametrize("rate", ["jaumann", "jaumann, polar", "green_naghdi", "truesdell"])
def test_great_and_small_cycles(rate: str) -> None:
    """Stress and work of amplitude 1 and 0.1: Truesdell's rate gives off half of what it was given."""
    for amplitude, digits in ((1.0, 3e-5), (0.1, 1e-7)):
        exact = REFERENCE["closed_cycles"]["table"][str(amplitude)].get(rate.partition(",")[0])
        if exact is not None:
            np.testing.assert_allclose(closed(rate, amplitude), exact, rtol=0.0, atol=digits)
    if rate == "truesdell":
        np.testing.assert_allclose(closed(rate, 0.1)[:3], [-0.02 / 11.0, 0.2 / 11.0, 0.0], rtol=0.0, atol=1e-7)


def test_the_logarithmic_rate_leaves_nothing() -> None:
    """The stress is a function of the stretch: what is left falls with the square of the step."""
    for amplitude in (1.0, 0.1):
        left = [np.abs(closed("log", amplitude, n)[:3]).max() for n in (20, 40, 80)]
        assert order(left, (4.0, 2.0, 1.0)) == pytest.approx(2.0, abs=0.05)
        assert left[-1] < 1e-5 * amplitude**3


def test_the_errors_are_of_second_order() -> None:
    for rate in RATES:
        coarse, middle, fine = (closed(rate, 0.5, n) for n in (10, 20, 40))
        assert np.abs(fine - middle).max() == pytest.approx(0.25 * np.abs(middle - coarse).max(), rel=0.05)
