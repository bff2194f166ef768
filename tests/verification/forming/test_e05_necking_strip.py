"""E05: a viscous strip necks where it is a little thinner."""

import numpy as np
import pytest

import results
from softway.apps.verify.cases.forming.e05_necking_strip import FIRST, M, thicknesses, thin_at
from softway.apps.verify.exact.flow import neck

pytestmark = pytest.mark.slow


def test_the_case() -> None:
    assert results.missed("E05") == set()


def test_the_neck_grows_as_the_formula_says() -> None:
    thin, thick = thicknesses()
    assert thick[-1] < 0.5
    np.testing.assert_allclose(thin, neck(thick, M, FIRST), rtol=1e-2)
    for A2, A1 in results.case("E05")["reference"]["table"][:5]:
        assert thin_at(A2) == pytest.approx(A1, rel=0.01)
