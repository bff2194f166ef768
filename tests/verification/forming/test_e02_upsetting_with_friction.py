"""E02: upsetting of a cylinder with the friction of Norton and Hoff: force curve and barrelling."""

import numpy as np
import pytest

import results
from softway.apps.verify.cases.forming.e02_upsetting_with_friction import upset

pytestmark = pytest.mark.slow


def test_the_case() -> None:
    assert results.missed("E02") == set()


def test_the_whole_curve() -> None:
    """Far within the tolerance of the case, 12 x 10 linear cells against 12 x 10 quadratic ones."""
    press, table = upset(), np.array(results.case("E02")["reference"]["fine_12x10x24"])
    found = [press.force_at(r) for r in table[:, 0]]
    np.testing.assert_allclose(found, table[:, 1], rtol=2e-3)
    assert abs(press.radius("outer", "middle") - table[-1, 2]) < 1e-3
    assert abs(press.radius("outer", "platen") - table[-1, 3]) < 1e-3


def test_the_energy_balance_closes_with_the_work_of_friction() -> None:
    """All work is dissipated: what the volume stores is the share 1/bulk."""
    press = upset()
    assert press.ledger_error < 1e-8
    last = press.steps[-1].ledger
    assert 0.999 < last.dissipation / last.work_external <= 1.0
    assert last.contacts["platen"].force_t > 0.0
    assert press.most_iterations <= 20
