"""Mechanisms of rigid bodies with known motions: every quantity is within its tolerance."""

import pytest

import results

CASES = ("F01", "F02", "F03", "F04", "F05", "F06", "F07", "F08", "F09", "F10", "F11", "F12")
LONG = {"F03": pytest.mark.slow, "F08": pytest.mark.slow, "F09": pytest.mark.minutes}


@pytest.mark.parametrize("case", [pytest.param(c, marks=LONG.get(c, [])) for c in CASES])
def test_case(case: str) -> None:
    assert results.missed(case) == set()
