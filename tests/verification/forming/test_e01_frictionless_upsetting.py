"""E01: frictionless upsetting of a cylinder of Norton-Hoff's material, homogeneous to the last digit."""

import numpy as np
import pytest

import results
from softway.apps.verify.cases.forming.e01_frictionless_upsetting import upset
from softway.apps.verify.exact.flow import upsetting


def test_the_case() -> None:
    assert results.missed("E01") == set()


@pytest.mark.few(2)
@pytest.mark.parametrize("m", [1.0, 0.5, 0.3, 0.1])
def test_the_force_is_the_formula(m: float) -> None:
    press = upset(m, 20)
    np.testing.assert_allclose(press.force[1:], upsetting(press.reduction[1:], m), rtol=1e-3)
    assert press.ledger_error < 1e-10


def test_the_force_converges_with_the_square_of_the_slab() -> None:
    coarse, fine = (upset(0.3, n) for n in (10, 20))
    errors = [np.abs(p.force[1:] / upsetting(p.reduction[1:], 0.3) - 1.0).max() for p in (coarse, fine)]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.35)
