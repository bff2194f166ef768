"""I03: a bar on a mesh that adapts: as accurate as the uniform one, far smaller, its balances exact."""

import pytest

from softway.apps.verify import compared
from softway.apps.verify.case import sheet
from softway.apps.verify.cases.refinement import i03_adapted_bar as case

pytestmark = pytest.mark.slow


def test_the_case() -> None:
    outcome = case.compute()
    assert all(quantity.passed for quantity in compared(sheet("I03"), outcome.values))
    assert outcome.values["degrees of freedom times slabs, relative to uniform"] < 0.15  # 0.115


def test_flights_are_in_few_cells_and_long_slabs() -> None:
    flight = [step for step in case.adapted() if step.slab.end < 0.9 * case.TOUCH]
    assert max(step.model.dofs.size for step in flight[4:-1]) < 3 * case.CELLS
    assert max(step.slab.span for step in flight) > 8.0 * min(step.slab.span for step in case.uniform())


def test_nothing_is_tried_twice_but_at_events() -> None:
    assert sum(len(step.report.rejections) for step in case.adapted()) <= 12
