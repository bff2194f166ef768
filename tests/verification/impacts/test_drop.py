"""A real part: the steel bracket dropped from 1 m, read from its scenario, touches and rebounds in all three rules."""

from pathlib import Path

import numpy as np
import pytest

import softway as sw

pytestmark = pytest.mark.slow

SCENARIO = Path(__file__).parents[3] / "scenarios" / "bracket_drop.toml"
COARSE = ("time.step=4 us", "output.fields_every=20 us")
SPEED, GRAVITY, GAP, STEP = np.sqrt(2 * 9.81), 9.81, 20e-6, 4e-6


@pytest.fixture(scope="module")
def energy(tmp_path_factory):
    """The run by the default rule."""
    return sw.run(sw.load(SCENARIO, COARSE), tmp_path_factory.mktemp("drop") / "run")


def test_the_part_is_a_real_one():
    scenario = sw.load(SCENARIO)
    mesh = scenario.bodies["bracket"].mesh.build()
    assert mesh.n_nodes >= 3000
    assert set(mesh.blocks) == {"tet10"}
    assert scenario.bodies["bracket"].velocity.value[2] == pytest.approx(-SPEED, rel=1e-6)


def test_the_energy_balance_closes_through_contact_and_rebound(energy):
    history = energy.history
    total = history["energy_kinetic"][0] + history["energy_strain"][0]
    assert np.abs(history["energy_error"]).max() <= 1e-8 * total
    assert history["contact.floor.force_n"].max() > 1e4
    assert history["momentum_z"][0] < 0.0 < history["momentum_z"][-1]
    assert history["contact.floor.force_n"][-1] == 0.0


def test_the_impulse_of_the_floor_is_the_change_of_momentum(energy):
    history = energy.history
    impulse = np.cumsum(history["contact.floor.force_n"] * history["h"])
    mass = -history["momentum_z"][0] / SPEED
    change = history["momentum_z"] - history["momentum_z"][0] + mass * GRAVITY * history["time"]
    assert np.abs(impulse - change).max() <= 1e-9 * impulse[-1]
    assert np.abs(history["momentum_x"]).max() <= 1e-9 * impulse[-1]


def test_no_node_is_below_the_floor_at_the_end_of_a_slab(energy):
    assert energy.history["contact.floor.min_gap"].min() >= -1e-12 * 0.08
    assert energy.history["contact.floor.power_residual"].max() <= 1e-12 * energy.history["energy_kinetic"][0]


def test_touch_and_release_are_located(energy):
    kinds, times = energy.events["kind"], energy.events["time"]
    first = min(t for t, k in zip(times, kinds, strict=True) if k == "touch")
    exact = (np.sqrt(SPEED**2 + 2 * GRAVITY * GAP) - SPEED) / GRAVITY
    assert first == pytest.approx(exact, abs=GRAVITY * STEP**2 / SPEED)  # the path is straight within a slab
    assert "release" in set(kinds)


def test_the_fields_open_in_pyvista(energy):
    pyvista = pytest.importorskip("pyvista")
    grid = pyvista.get_reader(str(energy.path / "fields.vtkhdf")).read()
    assert grid.n_points == 3903
    assert {"displacement", "velocity"} <= set(grid.point_data)


@pytest.mark.few(1)
@pytest.mark.parametrize("rule", [sw.contact.Impulse(), sw.contact.Paper(), sw.contact.Paper(approach="extrapolated")])
def test_the_other_rules_run_it_too(rule):
    """They lose energy at every touch and may not gain any; the impulse is that of the floor."""
    scenario = sw.load(SCENARIO, COARSE)
    contacts = tuple(sw.Contact(between=c.between, name=c.name, timing=rule) for c in scenario.contacts)
    scene = sw.Scene(bodies=scenario.bodies, contacts=contacts, loads=scenario.loads)
    steps = list(sw.march(scene, until=scenario.time.end, step=scenario.time.step))
    ledgers = [s.ledger for s in steps]
    start = steps[0].before
    assert start.time == 0.0
    assert ledgers[-1].momentum[2] > 0.0
    assert min(x.contacts["floor"].min_gap for x in ledgers) >= -1e-12 * 0.08
    total = 0.5 * -ledgers[0].momentum[2] * SPEED
    energies = np.array([x.energy_kinetic + x.energy_strain - x.work_external for x in ledgers])
    assert energies.max() <= total * (1 + 1e-3)
    assert energies[-1] > 0.9 * total
    assert sum(len(s.events) for s in steps) > 4
