"""Contacts with heat that another code has as tests, against the exact solutions: docs/verification/contact_heat.md."""

from math import log, pi

import numpy as np
import pytest

import heat_peers as peers
import softway as sw
from softway.contact import DualMortar, NodeToSurface

SLIGHT = 1.8e-11 / peers.STRETCH
"""Pressure of the blocks whose outer face is displaced by 1.8e-11 m [Pa]."""


def test_the_references_are_those_that_the_other_code_documents() -> None:
    assert peers.radiated(5.669e-8) == pytest.approx(37.532557, abs=5e-6)
    assert peers.steady(100.0, 26.875) == pytest.approx((7292.0183265, 349.87541194439, 284.72389679287), rel=1e-11)
    assert [round(t) for t in peers.steady(1.0, 1.0)[1:]] == [460, 276]
    assert peers.on_the_way(1e5, SLIGHT, 1.0, 8) == pytest.approx(peers.steady(SLIGHT, 1.0)[1:], rel=1e-10)
    coarse, fine, finer = (np.array(peers.on_the_way(240.0, SLIGHT, 1.0, n)) for n in (40, 80, 160))
    np.testing.assert_allclose(coarse - fine, 4.0 * (fine - finer), rtol=2e-2)


@pytest.mark.parametrize(
    ("dim", "method"),
    [(1, None), (2, None), (2, NodeToSurface(nodes="both")), (2, DualMortar()), (3, DualMortar())],
    ids=["bars", "plane", "both", "mortar", "space"],
)
def test_a_gap_with_gas_and_radiation(dim: int, method: object) -> None:
    assert peers.radiating(dim, method=method) == pytest.approx(peers.radiated(), rel=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("pressure", "hardness", "method", "within"),
    [
        (100.0, 26.875, NodeToSurface(nodes="both"), 5e-8),
        (100.0, 26.875, None, 5e-7),
        (SLIGHT, 1.0, NodeToSurface(nodes="both"), 5e-8),
    ],
    ids=["both, 100 Pa", "finer, 100 Pa", "both, 1 Pa"],
)
def test_blocks_under_pressure(pressure: float, hardness: float, method: object, within: float) -> None:
    heats = peers.STEEL, peers.ALUMINIUM
    scene = peers.pressed(pressure, hardness, heats, (1, 2, 3), 1.0, method=method)
    steps = list(sw.march(scene, until=9.1, step=0.35))
    flux, *exact = peers.steady(pressure, hardness)
    assert peers.last_flow(steps) / peers.HEIGHT == pytest.approx(flux, rel=within)
    for found, temperature in zip(peers.faces(scene, steps[-1]), exact, strict=True):
        np.testing.assert_allclose(found, temperature, rtol=within)
    assert abs(steps[-1].ledger.heat.error) < 1e-12 * steps[-1].ledger.heat.content


@pytest.mark.slow
def test_blocks_under_pressure_on_the_way() -> None:
    """Once slabs resolve the cells, the errors at 240 s fall faster than they."""
    exact = peers.on_the_way(240.0, SLIGHT, 1.0, 4)
    error = []
    for step in (8.0, 4.0):
        scene = peers.pressed(SLIGHT, 1.0, peers.HEATS, (4, 1, 1), 1.0)
        *_, last = sw.march(scene, until=240.0, step=step)
        error.append(max(abs(t.mean() - e) for t, e in zip(peers.faces(scene, last), exact, strict=True)))
    assert error[1] < 0.02 and 2.5 * error[1] < error[0] < 0.05


def test_a_gap_between_cylinders_is_that_of_plates() -> None:
    """The flow is that through the area of the surface whose nodes have rows, however wide the gap is."""
    for gap in (1.0, 0.02):
        plate = 2.0 * pi * 100.0 / gap
        assert peers.cylinders(gap) == pytest.approx(plate, rel=2e-4)
        assert peers.cylinders(gap, "ring") == pytest.approx(plate * (1.0 + gap), rel=2e-4)
        both = peers.cylinders(gap, method=NodeToSurface(nodes="both"))
        assert both == pytest.approx(plate * (1.0 + 0.5 * gap), rel=2e-4)
        assert abs(both / (2.0 * pi * 100.0 / log(1.0 + gap)) - 1.0) < gap**2 / 12.0 + 2e-4
