"""D01: simple shear of a hypoelastic cell, for each of the objective rates against its closed form."""

import numpy as np
import pytest

import results
from orders import order
from softway.apps.verify.cases.large_deformation.d01_simple_shear_rates import stresses
from softway.apps.verify.exact import shear
from softway.apps.verify.scenes.driving import RATES
from softway.arrays import Array

ROTATING = [name for name in RATES if name != "truesdell"]


def exact(rate: str, g: float) -> Array:
    """s11, s12 and s22 of unit shear modulus; the increment of Jaumann's rate makes no difference."""
    return shear.elastic(rate.partition(",")[0], g)


def found(rate: str, g: float, *slabs: int) -> Array:
    """Stress (3, 3) at the end."""
    return stresses(rate, g, *slabs)[-1]


def test_the_case() -> None:
    assert results.missed("D01") == set()


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("g", [1.0, 2.0, 4.0, 8.0])
def test_closed_forms(rate: str, g: float) -> None:
    """In 200 slabs, to four times the error that the case allows at gamma = 5."""
    s = found(rate, g)
    assert np.allclose([s[0, 0], s[0, 1], s[1, 1]], exact(rate, g), rtol=0.0, atol=1e-3)
    assert abs(s[2, 2]) < 1e-12


@pytest.mark.parametrize("rate", ROTATING)
def test_the_error_is_of_second_order(rate: str) -> None:
    slabs = np.array([50, 100, 200])
    errors = [np.abs(found(rate, 5.0, n)[[0, 0], [0, 1]] - exact(rate, 5.0)[:2]).max() for n in slabs]
    assert order(errors, 1.0 / slabs) == pytest.approx(2.0, abs=0.02)


def test_the_shear_of_truesdell_is_exact() -> None:
    """Its axes are those of the deformation: one slab is as good as many."""
    assert found("truesdell", 5.0, 1)[[0, 0, 1], [0, 1, 1]] == pytest.approx(exact("truesdell", 5.0), abs=1e-13)
