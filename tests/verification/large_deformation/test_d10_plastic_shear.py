"""D10: simple shear of Jaumann's elastic, perfectly plastic material: no oscillation, a steady state in closed form.

Radial return is of first order in the slab: the direction of flow is the one in its middle, turned by half its spin.
"""

import numpy as np
import pytest

import results
from orders import order
from softway.apps.verify.cases.large_deformation.d10_plastic_shear import GAMMA, STEPS, path
from softway.apps.verify.exact.shear import plastic
from softway.apps.verify.scenes.driving import RATES


@pytest.mark.parametrize("k", [0.1, 0.5])
def test_the_flow(k: float) -> None:
    """At gamma = 1 and 5, where k = 0.5 is not yet steady."""
    for gamma in (1.0, GAMMA):
        s11, s12, s22 = path(k)[round(STEPS * gamma / GAMMA)]
        exact = plastic(k, gamma)
        assert s12 == pytest.approx(exact[1], rel=2e-3)
        assert s11 == pytest.approx(exact[0], rel=0.02)
        assert s22 == pytest.approx(-s11, rel=1e-9)


def test_the_case() -> None:
    assert results.missed("D10") == set()


@pytest.mark.parametrize("k", [0.1, 0.5])
def test_the_steady_state(k: float) -> None:
    """No oscillation: beyond the yield point the shear stress falls to its steady value, and stays."""
    found = path(k)
    assert found[-1, 1] == pytest.approx(k * np.sqrt(1.0 - k * k), rel=1e-3)
    assert found[-1, 0] == pytest.approx(k * k, rel=0.02)
    flowing = found[1 + int(np.ceil(2.0 * np.arcsin(0.5 * k) * STEPS / GAMMA)) :]
    assert (np.diff(flowing[:, 1]) < 1e-12).all()
    assert (np.diff(flowing[:, 0]) > -1e-12).all()
    np.testing.assert_allclose(np.hypot(*flowing[:, :2].T), k, rtol=1e-12)


def test_the_error_is_of_first_order() -> None:
    steps = np.array([50, 100, 200])
    errors = [abs(path(0.5, n)[-1, 0] - plastic(0.5, GAMMA)[0]) for n in steps]
    assert order(errors, 1.0 / steps) == pytest.approx(1.0, abs=0.05)


def test_the_turning_rates_agree_where_elastic_strains_are_small() -> None:
    """They differ in s11, by the elastic strain of 0.05 at yield; in the shear stress by the square of that."""
    for rate in RATES:
        if rate != "truesdell":
            assert path(0.1, 80, 2.0, rate)[-1, 1] == pytest.approx(0.0995, rel=0.005)
