"""D05: a stiff bar swings about a pin; a slab force of the chord keeps energy and angular momentum.

Here it is a sixth of a turn; the ten of the case are made by ``softway verify``.
"""

import pytest

import results
from softway.verify.cases.d05 import quantities, swing
from softway.verify.scenes.spinning import Spin

pytestmark = pytest.mark.slow

REFERENCE = results.case("D05")["reference"]


@pytest.fixture(scope="module")
def sixth() -> Spin:
    """33 slabs."""
    return swing(1.0 / 6.0)


def test_the_case(sixth: Spin) -> None:
    assert results.outside("D05", quantities(sixth)) == set()
    assert sixth.drift("energy") < 1e-10
    assert sixth.period == pytest.approx(REFERENCE["period"], rel=3e-4)


def test_the_start_and_the_spin(sixth: Spin) -> None:
    """Energy and angular momentum are those of the rigid bar."""
    assert sixth.energy[0] == pytest.approx(REFERENCE["energy"], rel=1e-9)
    assert sixth.momentum[0] == pytest.approx(REFERENCE["angular_momentum"], rel=1e-9)
    assert sixth.drift("momentum") < 1e-9
