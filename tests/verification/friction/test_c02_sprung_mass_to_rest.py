"""C02: a mass on a spring on a rough floor goes to rest at an offset."""

import numpy as np
import pytest

import results
from softway.apps.verify.cases.friction.c02_sprung_mass_to_rest import swung

pytestmark = pytest.mark.slow


def test_the_case():
    assert results.missed("C02") == set()


def test_it_turns_where_it_should():
    swing, reference = swung(), results.case("C02")["reference"]
    for t, place in reference["turning_points"][1:]:
        assert np.abs(swing.time - t).min() < 1e-4
        assert swing.at(t)[0] == pytest.approx(place, abs=2e-7)
    assert max(abs(s.ledger.energy_error) for s in swing.steps) < 1e-8
    assert not any(s.report.rejections for s in swing.steps)
