"""Mechanisms of rigid bodies with known motions: every quantity is within its tolerance."""

import pytest

import results

CASES = ("F01", "F02", "F03", "F04", "F05", "F06", "F07", "F08", "F09", "F10", "F11", "F12")
LONG = ("F03", "F08", "F09")


@pytest.mark.parametrize("case", [pytest.param(c, marks=[pytest.mark.slow] if c in LONG else []) for c in CASES])
def test_case(case: str) -> None:
    assert results.missed(case) == set()
