"""Scenarios take no more slabs, iterations and rejections than they did: their cost on any computer."""

import pytest

from counts import KINDS, counted, stored

WITHIN = 0.05
"""Greatest difference, relative to the stored number."""
CASES = [
    pytest.param(kind, name, marks=pytest.mark.minutes if kind == "whole" else pytest.mark.slow)
    for kind, (_, names) in KINDS.items()
    for name in names
]


@pytest.mark.parametrize(("kind", "name"), CASES)
def test_the_cost_is_the_stored_one(kind, name):
    expected, found = stored()[kind][name], counted(KINDS[kind][0](name))
    assert found == pytest.approx(expected, rel=WITHIN), "python tests/scenarios/counts.py stores new numbers"


def test_numbers_are_stored_of_these_cases_only():
    assert {kind: sorted(names) for kind, names in stored().items()} == {k: sorted(n) for k, (_, n) in KINDS.items()}
