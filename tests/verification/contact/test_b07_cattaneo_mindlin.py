"""B07: Cattaneo's and Mindlin's line contact, pressed and then pulled along."""

import numpy as np
import pytest

import results
from softway.apps.verify.cases.contact.b07_cattaneo_mindlin import pulled


def test_case():
    """The case allows 0.05 for the zone and 5 percent for the greatest traction."""
    assert results.missed("B07") == set()


def test_the_zone_that_sticks():
    """It is b sqrt(1 - Q/(mu P)) for every pull that leaves some of it, and never grows."""
    march = pulled()
    some = march.ratio < 0.9
    assert march.zone[some] == pytest.approx(np.sqrt(1.0 - march.ratio[some]), abs=0.05)
    assert (np.diff(march.zone) < 1e-12).all()


def test_the_greatest_traction():
    """It is mu p0 sqrt(Q/(mu P)), as near as nodes come to the edge of the zone."""
    march = pulled()
    middle = (march.ratio > 0.45) & (march.ratio < 0.55)
    assert march.peak[middle] == pytest.approx(np.sqrt(march.ratio[middle]), rel=0.05)
