"""Scenarios of heat across contacts against closed forms: the heat of friction of a brake, a fit by shrinking."""

from pathlib import Path

import numpy as np
import pytest

import softway as sw

SCENARIOS = Path(__file__).parents[4] / "scenarios"


@pytest.mark.slow
def test_a_brake_pad_has_the_temperature_of_duhamels_integral() -> None:
    run = sw.run(sw.load(SCENARIOS / "brake_pad.toml"))
    history = run.history
    time = np.maximum(history["time"] - 0.1, 0.0)
    power, stop, effusivity = 1e6, 2.0, np.sqrt(50.0 * 7800.0 * 500.0)
    exact = 2.0 * power / (effusivity * np.sqrt(np.pi)) * (np.sqrt(time) - 2.0 / 3.0 * time**1.5 / stop)
    found = history["surface"] - 293.15
    assert found.max() == pytest.approx(exact.max(), rel=0.01) and exact.max() == pytest.approx(53.86994, rel=1e-6)
    later = time > 0.5
    np.testing.assert_allclose(found[later], exact[later], rtol=0.015)
    assert history["heat.friction"][-1] == pytest.approx(history["dissipation"][-1], rel=1e-12)
    assert history["heat.friction"][-1] == pytest.approx(0.5 * power * stop * 0.01, rel=0.012)
    assert abs(history["heat.error"]).max() < 1e-12 * history["heat.content"][-1]


@pytest.mark.slow
def test_a_ring_shrinks_onto_a_shaft_with_the_pressure_of_lame() -> None:
    run = sw.run(sw.load(SCENARIOS / "shrink_fit.toml"))
    history, shaft, ring, outer, E, nu = run.history, 0.025, 0.02506, 0.03506, 210e9, 0.3
    ends = history["shaft"][-1], history["ring"][-1]
    assert ends[0] == pytest.approx(ends[1], abs=1e-3)
    too_narrow = shaft * (1.0 + 12e-6 * (ends[0] - 293.15)) - ring * (1.0 - 12e-6 * (593.15 - ends[1]))
    gives = shaft * (1.0 - nu) + ring * ((outer**2 + ring**2) / (outer**2 - ring**2) + nu)
    pressure = E * too_narrow / gives
    force = history["contact.fit.force_n"][-1]
    assert force / (2.0 * np.pi * ring * 0.005) == pytest.approx(pressure, rel=5e-4)
    np.testing.assert_allclose(run.fields[-1].stress[:20, 0], -pressure, rtol=5e-3)
    # the heat of the ring at constant pressure, which is greater by 9 kappa alpha^2 theta
    volume, middle = np.pi * (outer**2 - ring**2) * 0.005, 0.5 * (593.15 + ends[1])
    capacity = 7800.0 * 500.0 + 9.0 * E / (3.0 * (1.0 - 2.0 * nu)) * 12e-6**2 * middle
    assert -history["heat.through.fit"][-1] == pytest.approx(capacity * volume * (593.15 - ends[1]), rel=5e-3)
    assert abs(history["heat.error"]).max() < 1e-12 * history["heat.content"][0]
    assert np.diff(history["heat.entropy"]).min() >= 0.0
