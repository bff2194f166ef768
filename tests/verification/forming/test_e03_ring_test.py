"""E03: the ring test 6:3:2: the inner radius tells the friction, growing with little, shrinking with much."""

import pytest

import results
from softway.apps.verify.cases.forming.e03_ring_test import ALPHAS, ring

pytestmark = pytest.mark.slow


@pytest.mark.parametrize(
    "alpha", [pytest.param(a, marks=pytest.mark.minutes if a == max(ALPHAS) else []) for a in ALPHAS]
)
def test_the_radii(alpha: float) -> None:
    *_, force, outer, outer_platen, inner, inner_platen = results.case("E03")["reference"]["table"][str(alpha)][-1]
    press = ring(alpha)
    assert press.force_at(0.3) == pytest.approx(force, rel=4e-3)
    for side, height, value in (
        ("outer", "middle", outer),
        ("outer", "platen", outer_platen),
        ("inner", "middle", inner),
        ("inner", "platen", inner_platen),
    ):
        assert press.radius(side, height) == pytest.approx(value, abs=5e-3)
    assert press.ledger_error < 1e-8
    assert press.most_iterations <= 20


def test_the_case() -> None:
    assert results.missed("E03") == set()
