"""E04: a slice of Newton's fluid in plane strain under a platen with linear friction."""

import numpy as np
import pytest

import results
from softway.apps.verify.cases.forming.e04_viscous_slice import pressed

pytestmark = pytest.mark.slow


def test_the_case() -> None:
    assert results.missed("E04") == set()


def test_the_whole_curve() -> None:
    press, table = pressed(), np.array(results.case("E04")["reference"]["table"])
    np.testing.assert_allclose([press.force_at(r) for r in table[1:, 0]], table[1:, 1], rtol=4e-3)
    assert abs(press.radius("outer", "middle") - table[-1, 2]) < 2e-3
    assert abs(press.radius("outer", "platen") - table[-1, 3]) < 2e-3
    assert press.ledger_error < 1e-8
