"""E06: upsetting of a plastic cylinder with little Coulomb friction: Siebel's mean pressure."""

import numpy as np
import pytest

import results
import softway as sw
from softway.verify.scenes.forming import Press

MU, E = 0.05, 2000.0


@pytest.mark.parametrize("height", [1.0, 2.0])
def test_the_mean_pressure(height: float) -> None:
    """``sigma0 (1 + 2 mu R/(3 H))`` of a cylinder of radius 1; half of its height is in the press."""
    press = Press(
        material=sw.J2(E=E, nu=0.3, yield_stress=1.0),
        outer=1.0,
        height=0.5 * height,
        friction=sw.Coulomb(mu=MU),
        cells=(10, 6),
        stroke=0.01,
        slabs=10,
    )
    radius = 0.5 * (press.radius("outer", "middle") + press.radius("outer", "platen"))
    mean = float(press.force[-1]) / (np.pi * radius**2)
    assert mean == pytest.approx(1.0 + 2.0 * MU / (3.0 * height), rel=0.01)
    assert press.ledger_error < 1e-8
    if height == 1.0:
        assert results.outside("E06", {"p_mean R/H=1": mean}) == set()
