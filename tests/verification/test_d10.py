"""D10: simple shear of Jaumann's elastic, perfectly plastic matter: no oscillation, a steady state in closed form.

Radial return is of first order in the slab: the direction of flow is the one in its middle, turned by half its spin.
"""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import results
import softway as sw
from orders import order
from softway.typing import Array
from softway.verify.scenes.driving import RATES, sheared, square

GAMMA, STEPS = 5.0, 1600


@cache
def path(k: float, steps: int, gamma: float = GAMMA, rate: str = "jaumann") -> Array:
    """s11, s12, s22 (steps + 1, 3) of one element with shear modulus 1."""
    law = sw.J2(E=2.6, nu=0.3, yield_stress=np.sqrt(3.0) * k, rate=RATES[rate])
    memories = square(law).history(sheared(gamma, steps))
    return np.array([m.stress[0][[0, 0, 1], [0, 1, 1]] for m in memories])


def angle(k: float, gamma: float) -> float:
    """phi of ``s11 = k sin(phi)``, ``s12 = k cos(phi)``: phi' = 1 - sin(phi)/k from the yield point on."""
    start = 2.0 * np.arcsin(0.5 * k)
    first = np.arctan2(1.0 - np.cos(start), np.sin(start))
    flow = solve_ivp(lambda _, y: 1.0 - np.sin(y) / k, (start, gamma), [first], rtol=1e-10, atol=1e-12)
    return float(flow.y[0, -1])


@pytest.mark.parametrize("k", [0.1, 0.5])
def test_the_flow(k: float) -> None:
    """At gamma = 1 and 5, where k = 0.5 is not yet steady."""
    for gamma in (1.0, GAMMA):
        s11, s12, s22 = path(k, STEPS)[round(STEPS * gamma / GAMMA)]
        phi = angle(k, gamma)
        assert s12 == pytest.approx(k * np.cos(phi), rel=2e-3)
        assert s11 == pytest.approx(k * np.sin(phi), rel=0.02)
        assert s22 == pytest.approx(-s11, rel=1e-9)


def test_the_case() -> None:
    s11, s12, _ = path(0.1, STEPS)[-1]
    assert results.outside("D10", {"s12 at gamma=5, k=.1": s12, "s11 at gamma=5,k=.1": s11}) == set()


@pytest.mark.parametrize("k", [0.1, 0.5])
def test_the_steady_state(k: float) -> None:
    """No oscillation: beyond the yield point the shear stress falls to its steady value, and stays."""
    found = path(k, STEPS)
    assert found[-1, 1] == pytest.approx(k * np.sqrt(1.0 - k * k), rel=1e-3)
    assert found[-1, 0] == pytest.approx(k * k, rel=0.02)
    flowing = found[1 + int(np.ceil(2.0 * np.arcsin(0.5 * k) * STEPS / GAMMA)) :]
    assert (np.diff(flowing[:, 1]) < 1e-12).all()
    assert (np.diff(flowing[:, 0]) > -1e-12).all()
    np.testing.assert_allclose(np.hypot(*flowing[:, :2].T), k, rtol=1e-12)


def test_the_error_is_of_first_order() -> None:
    steps = np.array([50, 100, 200])
    errors = [abs(path(0.5, n)[-1, 0] - 0.5 * np.sin(angle(0.5, GAMMA))) for n in steps]
    assert order(errors, 1.0 / steps) == pytest.approx(1.0, abs=0.05)


def test_the_turning_rates_agree_where_elastic_strains_are_small() -> None:
    """They differ in s11, by the elastic strain of 0.05 at yield; in the shear stress by the square of that."""
    for rate in RATES:
        if rate != "truesdell":
            assert path(0.1, 80, 2.0, rate)[-1, 1] == pytest.approx(0.0995, rel=0.005)
