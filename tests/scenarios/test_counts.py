"""Scenarios take no more slabs, iterations and rejections than they did: their cost on any computer."""

import pytest

from counts import KINDS, WITHIN, counted, stored
from variants import LONG

CASES = [
    *(pytest.param("whole", name, marks=pytest.mark.minutes) for name in KINDS["whole"][1]),
    *(pytest.param("small", name, marks=pytest.mark.slow) for name in sorted(LONG)),
]
"""Those of the other small variants are counted where they run anyway: test_jitter.py."""


@pytest.mark.parametrize(("kind", "name"), CASES)
def test_the_cost_is_the_stored_one(kind, name):
    expected, found = stored()[kind][name], counted(KINDS[kind][0](name))
    assert found == pytest.approx(expected, rel=WITHIN), "python tests/scenarios/counts.py stores new numbers"


def test_numbers_are_stored_of_these_cases_only():
    assert {kind: sorted(names) for kind, names in stored().items()} == {k: sorted(n) for k, (_, n) in KINDS.items()}
