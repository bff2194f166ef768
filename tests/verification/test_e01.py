"""E01: frictionless upsetting of a cylinder of Norton-Hoff's material, homogeneous to the last digit."""

from functools import cache

import numpy as np
import pytest

import results
import softway as sw
from softway.typing import Array
from softway.verify.scenes.forming import Press


def exact(reduction: Array, m: float) -> Array:
    """``F = pi R^2 sqrt(3) K (sqrt(3) V/H)^m`` for half the height H, V = 1, K = 1."""
    half = 0.75 * (1.0 - reduction)
    return np.asarray(np.pi * 0.75 / half * np.sqrt(3.0) * (np.sqrt(3.0) / half) ** m)


@cache
def upset(m: float, slabs: int = 50) -> Press:
    """Half of the height reduced by 50 per cent."""
    return Press(material=sw.NortonHoff(K=1.0, m=m), outer=1.0, height=0.75, cells=(4, 3), stroke=0.5, slabs=slabs)


def test_the_case() -> None:
    press = upset(0.3)
    last = press.steps[-1].after
    assert last.memory is not None
    stress = last.memory["body"].stress[:, 1, 1]
    volume = (press.radius("outer", "middle")) ** 2 * 0.5
    found = {
        "force at 50%": press.force_at(0.5),
        "volume": volume,
        "uniformity of stress": float(np.ptp(stress) / np.abs(stress).max()),
    }
    assert results.outside("E01", found) == set()


@pytest.mark.parametrize("m", [1.0, 0.5, 0.3, 0.1])
def test_the_force_is_the_formula(m: float) -> None:
    press = upset(m, 20)
    np.testing.assert_allclose(press.force[1:], exact(press.reduction[1:], m), rtol=1e-3)
    assert press.ledger_error < 1e-10


def test_the_force_converges_with_the_square_of_the_slab() -> None:
    coarse, fine = (upset(0.3, n) for n in (10, 20))
    errors = [np.abs(p.force[1:] / exact(p.reduction[1:], 0.3) - 1.0).max() for p in (coarse, fine)]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.35)
