"""D05: a stiff bar swings about a pin; a slab force of the chord keeps energy and angular momentum.

The case asks for ten turns (docs/verification/large_deformation.md); here it is a sixth of one.
"""

import numpy as np
import pytest

import results
from softway.verify.scenes.spinning import Spin, pendulum

CASE = results.case("D05")


@pytest.fixture(scope="module")
def swing() -> Spin:
    """Slabs of h = 0.0125."""
    d = CASE["definition"]
    return pendulum(d["L"], d["EA"], d["rhoA"], d["v_tip"], step=0.0125, turns=1.0 / 6.0)


def test_the_case(swing: Spin) -> None:
    found = {
        "energy drift 10 rev": swing.drift("energy"),
        "period": swing.period,
        "length change": np.abs(swing.length / CASE["definition"]["L"] - 1.0).max(),
    }
    assert results.outside("D05", found) == set()
    assert swing.drift("energy") < 1e-10
    assert swing.period == pytest.approx(CASE["reference"]["period"], rel=3e-4)


def test_the_start_and_the_spin(swing: Spin) -> None:
    """Energy and angular momentum are those of the rigid bar."""
    assert swing.energy[0] == pytest.approx(CASE["reference"]["energy"], rel=1e-9)
    assert swing.momentum[0] == pytest.approx(CASE["reference"]["angular_momentum"], rel=1e-9)
    assert swing.drift("momentum") < 1e-9
