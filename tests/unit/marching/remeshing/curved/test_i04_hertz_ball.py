"""I04: Hertz's impact with 16 times fewer degrees of freedom than on the uniform mesh of the same finest cells."""

import pytest

from softway.apps.verify import compared
from softway.apps.verify.case import sheet
from softway.apps.verify.cases.refinement import i04_hertz_ball as case

pytestmark = pytest.mark.slow


def test_the_case() -> None:
    outcome = case.compute()
    assert all(quantity.passed for quantity in compared(sheet("I04"), outcome.values))
    assert outcome.values["degrees of freedom, relative to uniform"] < 0.07  # 0.061
