"""E06: upsetting of a plastic cylinder with little Coulomb friction: Siebel's mean pressure."""

import pytest

import results
from softway.apps.verify.cases.forming.e06_plastic_upsetting import MU, mean_pressure, pressed


def test_the_case() -> None:
    assert results.missed("E06") == set()


@pytest.mark.parametrize("height", [1.0, 2.0])
def test_the_mean_pressure(height: float) -> None:
    """``sigma0 (1 + 2 mu R/(3 H))`` of a cylinder of radius 1."""
    assert mean_pressure(height) == pytest.approx(1.0 + 2.0 * MU / (3.0 * height), rel=0.01)
    assert pressed(height).ledger_error < 1e-8
