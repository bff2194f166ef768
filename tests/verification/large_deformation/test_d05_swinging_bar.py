"""D05: a stiff bar swings about a pin; a slab force of the chord keeps energy and angular momentum.

Here it is a sixth of a turn; the ten of the case are made by ``softway verify``.
"""

import numpy as np
import pytest

import results
from softway.apps.verify.case import sheet
from softway.apps.verify.cases.large_deformation.d05_swinging_bar import STEP, quantities, swing
from softway.apps.verify.scenes.spinning import Spin

pytestmark = pytest.mark.slow

REFERENCE = results.case("D05")["reference"]
GIVEN = sheet("D05")["definition"]
ULP = GIVEN["stiffness"] / GIVEN["length"] * float(np.spacing(GIVEN["length"]))
"""Axial force by which the last digit of the tip's place changes that of so stiff a bar [N]."""
ROUNDING = ULP * STEP * GIVEN["speed"]
"""Its work on the way of one slab [J]: digits of positions do not tell energies closer."""


@pytest.fixture(scope="module")
def sixth() -> Spin:
    """33 slabs."""
    return swing(1.0 / 6.0)


def test_the_case(sixth: Spin) -> None:
    assert results.outside("D05", quantities(sixth)) == set()
    assert sixth.drift("energy") < ROUNDING / REFERENCE["energy"]
    assert sixth.period == pytest.approx(REFERENCE["period"], rel=3e-4)


def test_the_start_and_the_spin(sixth: Spin) -> None:
    """Energy and angular momentum are those of the rigid bar."""
    assert sixth.energy[0] == pytest.approx(REFERENCE["energy"], rel=1e-9)
    assert sixth.momentum[0] == pytest.approx(REFERENCE["angular_momentum"], rel=1e-9)
    assert sixth.drift("momentum") < 1e-9
