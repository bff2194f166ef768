"""E03: the ring test 6:3:2: the inner radius tells the friction, growing with little, shrinking with much."""

from functools import cache

import pytest

import results
import softway as sw
from softway.verify.scenes.forming import Press


@cache
def ring(alpha: float) -> Press:
    """16 x 8 linear cells, 30 per cent of the height."""
    return Press(
        material=sw.NortonHoff(K=1.0, m=0.2),
        inner=1.5,
        outer=3.0,
        height=1.0,
        friction=sw.NortonHoffFriction(alpha=alpha, p=0.2, K=1.0),
        cells=(16, 8),
        slabs=12,
    )


@pytest.mark.parametrize("alpha", [0.05, 0.2, 0.5])
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
    name = "inner radius (midplane) change at 30 percent, alpha={}"
    found = {name.format(a): ring(a).radius("inner", "middle") - 1.5 for a in (0.05, 0.2, 0.5)}
    found["F at 30%, alpha=.2"] = ring(0.2).force_at(0.3)
    assert results.outside("E03", found) == set()
