"""Cheap cases of the catalogue pass, but for what they are known to miss; others have tests of their own."""

import pytest

import results
from softway.apps.verify import listed

ELSEWHERE = {
    *(f"A{k:02}" for k in range(1, 13)),
    *(f"B{k:02}" for k in range(1, 10)),
    *(f"C{k:02}" for k in (1, 2, 4, 8, 9)),
    *(f"D{k:02}" for k in range(1, 11)),
    *(f"E{k:02}" for k in range(1, 7)),
    *(f"F{k:02}" for k in (1, 2, 3, 4, 5, 6, 8, 11, 12)),
    "G01",
    "G02",
    "G03",
    "G04",
    "I03",
    "I04",
}
"""Computed by a dedicated test, which says more about the same marches."""
DEAR = 10.0
"""Seconds beyond which a case is left to ``softway verify``."""
HERE = [case for case in listed() if case.id not in ELSEWHERE and case.seconds <= DEAR]


@pytest.mark.parametrize("case", HERE, ids=lambda case: case.id)
def test_the_case(case) -> None:
    known = {name for name, quantity in results.verdicts(case.id).items() if quantity.why}
    assert results.missed(case.id) == known


def test_whoever_is_computed_elsewhere_is_in_the_catalogue() -> None:
    assert {case.id for case in listed()} >= ELSEWHERE
