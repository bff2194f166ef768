"""A04: the struck bar of two elements without a stop."""

import numpy as np
import pytest

import results
import softway as sw
from orders import order
from softway.apps.verify.cases.waves.a04_struck_bar import free
from softway.apps.verify.exact import semidiscrete as discrete
from softway.apps.verify.scenes import bars
from softway.model.time_weight import TimeWeight, moments

STEPS = (0.04, 0.02)
WEIGHTS = (sw.model.EndPeaks(), sw.model.Momentum(), bars.MIDDLE, bars.FOURTH)


def error(step: float, weight: TimeWeight) -> float:
    """Greatest error of both nodes at t = 10, consistent mass."""
    exact = results.case("A04")["reference"]["consistent"]["displacement"]["10.0"]
    return float(np.abs(free(step, weight).displacement[-1, 1:] - exact).max())


@pytest.mark.slow
def test_case() -> None:
    assert results.missed("A04") == set()


@pytest.mark.slow
def test_the_end_of_the_motion_converges_at_second_order() -> None:
    for weight in (sw.model.EndPeaks(), bars.FOURTH):
        assert order([error(h, weight) for h in STEPS], STEPS) >= 1.9


@pytest.mark.slow
def test_the_weights_differ_in_their_phase_errors() -> None:
    """At h = 0.02: 4.7e-3 with the end peaks, half of it constant, a quarter in the middle, 4e-5 of fourth order."""
    found = [error(0.02, w) for w in WEIGHTS]
    assert found[0] == pytest.approx(4.66e-3, rel=0.01)
    assert np.array(found) / found[0] == pytest.approx([1.0, 0.5, 0.25, 0.008], abs=0.01)


@pytest.mark.few(2)
@pytest.mark.parametrize("weight", WEIGHTS, ids=str)
def test_the_energy_of_the_slab_is_constant(weight: TimeWeight) -> None:
    """It is T + V + h^2 (m2/2 - 1/4) 1/2 v K v for the moments 1/2, m2: with the end peaks T + V itself."""
    step = 0.02
    march = free(step, weight)
    mesh = discrete.bar(2, fixed=True)
    u, v = march.displacement[:, 1:], march.velocity[:, 1:]
    _, m2 = moments(weight)
    inertia = mesh.mass + step**2 * (0.5 * m2 - 0.25) * mesh.stiffness
    energy = 0.5 * np.einsum("ki,ij,kj->k", v, inertia, v) + 0.5 * np.einsum("ki,ij,kj->k", u, mesh.stiffness, u)
    assert np.ptp(energy) <= 1e-13
    assert march.energy[-1] == pytest.approx(1.0 / 12.0, abs=0.2 * step**2)


def test_the_motion_is_that_of_two_oscillators() -> None:
    motion = discrete.solve(discrete.bar(2, fixed=True), np.zeros(2), np.array([0.0, 1.0]), gap=np.inf, until=10.0)
    march = free(0.02, bars.FOURTH)
    table = np.array([motion.at(t)[0] for t in march.times])
    assert np.abs(march.displacement[:, 1:] - table).max() <= 2e-4
