"""Castings and drops that freeze: the gap that opens, and the energy of a splash with latent heat."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

import softway as sw
from softway.record.run import Run

SCENARIOS = Path(__file__).parents[4] / "scenarios"


@cache
def ran(name: str, *changes: str) -> Run:
    return sw.run(sw.load(SCENARIOS / f"{name}.toml", changes))


@pytest.mark.slow
def test_a_cold_elastic_casting_has_the_gap_of_the_free_strains() -> None:
    """All at 20 degrees Celsius and solid: both bodies have their free strains and no stress."""
    elastic = (
        'bodies.casting.material={ kind = "LinearElastic", E = "70 GPa", nu = 0.33 }',
        "bodies.casting.mesh.cells=[2, 2]",
        "bodies.mould.mesh.cells=[2, 2]",
    )
    fast = ("contacts[0].heat.gas=6 W/(m*K)", "loads[0].coefficient=1e4 W/(m^2*K)", "time.end=400 s", "time.step=5 s")
    run = ran("casting", *elastic, *fast)
    end = run.fields[-1]
    np.testing.assert_allclose(end["temperature"], 293.15, atol=0.05)
    casting = 24e-6 * (20.0 - 615.0) - 0.02 * 0.5  # half liquid at the start
    mould = 12e-6 * (20.0 - 200.0)
    assert run.history["contact.wall.min_gap"][-1] == pytest.approx(0.025 * (mould - casting), rel=2e-4)
    assert run.history["liquid.casting"][-1] == 0.0
    assert end.von_mises.max() < 1e-3 * 70e9 * abs(casting)


@pytest.mark.minutes
def test_the_gap_delays_the_freezing() -> None:
    """The casting with the gap that it opens, against one that does not shrink."""
    run, tight = (ran("casting", *more) for more in ((), ("bodies.casting.thermal.expansion=0 1/K",)))
    gap = run.history["contact.wall.min_gap"]
    assert (np.diff(gap) > 0.0).all() and 2e-4 < gap[-1] < 5e-4
    frozen = [float(r.history["time"][np.argmax(r.history["liquid.casting"] == 0.0)]) for r in (run, tight)]
    assert frozen[1] < 0.8 * frozen[0]
    content = run.history["heat.content"]
    assert np.abs(run.history["heat.error"]).max() < 1e-11 * np.ptp(content)


@pytest.mark.slow
def test_a_drop_keeps_energy_with_latent_heat_as_it_spreads_and_freezes() -> None:
    run = ran("freezing_drop", "bodies.drop.mesh.cells=4", "time.end=3 ms")
    table = run.history
    whole = table["energy_kinetic"] + table["energy_strain"] + table["heat.content"] - table["heat.brought"]
    assert np.ptp(whole) < 1e-9 * table["energy_kinetic"][0]
    liquid = table["liquid.drop"]
    assert liquid[-1] < 0.999 * liquid[0] and (np.diff(liquid) < 1e-6 * liquid[0]).all()
    assert np.abs(table["energy_error"]).max() < 1e-10 * table["energy_kinetic"][0]
    assert run.fields[-1]["liquid"].min() < 0.9 and run.fields[-1]["temperature"].min() < 505.15


@pytest.mark.minutes
def test_the_spread_of_the_drop_hardly_depends_on_mesh_and_slab() -> None:
    fine = ("bodies.drop.mesh.cells=7", "time.step=50 us")
    width = [float(ran("freezing_drop", *more).fields[-1].points[:, 0].max()) for more in ((), fine)]
    assert width[0] == pytest.approx(width[1], rel=0.03)
    assert 1.3 < width[0] / 0.002 < 1.6
