"""The scenarios of contact, on coarser meshes: what they conserve, and what their comments promise."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import softway as sw
from softway.scenario.files import dumps, load, loads
from softway.scenario.hints.units_text import Units

pytestmark = pytest.mark.slow

UNITS = Units.standard()
FOLDER = Path(__file__).parents[3] / "scenarios"
COARSE = {
    "ring_in_ring": ("bodies.small.mesh.cells=[2, 24]", "bodies.large.mesh.cells=[2, 40]", "time.end=7 ms"),
    "bar_through_die": ("bodies.bar.mesh.cells=[20, 3]", "time.step=0.4 ms"),
    "beam_on_cylinder": ("bodies.beam.mesh.cells=[20, 2]", "bodies.cover.mesh.cells=[2, 18]", "time.end=6 ms"),
    "stamp_on_pad": ("bodies.pad.mesh.cells=[5, 5, 2]", "time.step=0.2 ms"),
    "oblique_blocks": ("bodies.still.mesh.cells=[3, 3, 3]", "bodies.thrown.mesh.cells=[4, 4, 4]", "time.step=0.1 ms"),
}
LONG = ("ring_in_ring", "bar_through_die")
names = pytest.mark.parametrize(
    "name", [pytest.param(n, marks=pytest.mark.minutes if n in LONG else []) for n in COARSE]
)


def scenario(name: str) -> sw.Scenario:
    """A scenario on its coarse mesh."""
    return load(FOLDER / f"{name}.toml", COARSE[name], units=UNITS)


class Runs:
    """The coarse runs, each computed when it is first asked for."""

    def __init__(self) -> None:
        self.done: dict[str, sw.Run] = {}

    def __getitem__(self, name: str) -> sw.Run:
        if name not in self.done:
            self.done[name] = sw.run(scenario(name))
        return self.done[name]


@pytest.fixture(scope="module")
def runs() -> Runs:
    return Runs()


@names
def test_contact_holds_and_the_energy_balance_is_closed(name, runs):
    found = runs[name].summary
    (contact,) = found["contacts"].values()
    assert contact["touches"] >= 3 and contact["impulse"] > 0.0
    assert found["energy_error_relative"] < 1e-10 and found["dissipation"] == 0.0
    size = np.abs(runs[name].fields.cells.reference).max()
    assert found["penetration_worst"] < 1e-12 * size
    assert found["certificate"]["min_force"] >= 0.0


@names
def test_nodes_approach_before_they_touch(name, runs):
    events = runs[name].events
    touches = np.array([kind == "touch" for kind in events["kind"]])
    assert (events["normal_velocity_before"][touches] <= 1e-12).all()


@pytest.mark.parametrize("name", [pytest.param("ring_in_ring", marks=pytest.mark.minutes), "oblique_blocks"])
def test_free_bodies_keep_momentum_and_angular_momentum(name, runs):
    history, length = runs[name].history, np.abs(runs[name].fields.cells.reference).max()
    momenta = np.array([history[f"momentum_{i}"] for i in "xyz"])
    spins = np.array([history[f"spin_{i}"] for i in "xyz"])
    scale = np.linalg.norm(momenta[:, 0])
    assert np.abs(momenta - momenta[:, :1]).max() < 1e-10 * scale
    assert np.abs(spins - spins[:, :1]).max() < 1e-9 * scale * length


def test_a_node_between_two_faces_of_a_crushed_edge():
    """It goes to and fro, is held on one of them, overlaps the other, which is added: all in the same slab."""
    given = load(FOLDER / "oblique_blocks.toml", ("time.step=60 us", "time.end=1.14 ms"), units=UNITS)
    run = sw.run(given)
    assert run.history["iterations"].max() > 25 and run.history["h"][1:] == pytest.approx(60e-6, rel=1e-9)
    assert run.summary["energy_error_relative"] < 1e-12
    assert run.summary["certificate"]["min_gap"] > -1e-15


@pytest.mark.minutes
def test_the_large_ring_gains_what_the_small_one_loses(runs):
    """Masses of polygons with parabolic edges: parabolas add two thirds of chord times sagitta to a straight edge."""
    history = runs["ring_in_ring"].history
    turn = 2.0 * np.pi / 24
    area = 12 * (np.sin(turn) + 8.0 / 3.0 * np.sin(0.5 * turn) * (1.0 - np.cos(0.5 * turn))) * (30.0**2 - 26.0**2)
    momentum = 1100e-6 * area * 3.0
    assert history["momentum_x"] == pytest.approx(momentum, rel=1e-10)
    assert history["small"][-1] < 2.5 and history["large"][-1] > 0.1


@pytest.mark.minutes
def test_the_push_on_the_bar(runs):
    """It is the derivative of the stored energy: high while the die fills, none on average while the bar slides, and
    its work is the energy of the bar all through.
    """
    history = runs["bar_through_die"].history
    time, push = history["time"], history["push"]
    energy = history["energy_kinetic"] + history["energy_strain"]
    assert np.abs(history["work_external"] - energy).max() < 1e-10 * energy.max()
    filling, sliding, leaving = ((a < time) & (time < b) for a, b in ((7e-3, 13e-3), (18e-3, 38e-3), (40e-3, 46e-3)))
    assert push[filling].mean() > 2e3 and push[leaving].mean() < -2e3
    assert abs(push[sliding].mean()) < 0.1 * push[filling].mean()
    force = history["contact.die.force_n"][sliding]
    assert force.std() < 0.15 * force.mean()
    assert history["contact.die.force_n"][-1] == 0.0


def test_the_stamp_works_and_the_pad_gives_it_back(runs):
    history = runs["stamp_on_pad"].history
    time, deepest = history["time"], np.argmax(history["energy_strain"])
    assert time[deepest] == pytest.approx(5e-3, abs=0.3e-3)
    assert history["energy_strain"][-1] < 0.02 * history["energy_strain"][deepest]
    assert np.abs(history["work_external"][-1]) < 0.02 * history["work_external"].max()
    middle = (time > 2e-3) & (time < 8e-3)
    force, reaction = history["contact.stamp.force_n"][middle], history["pad"][middle]
    assert reaction.mean() == pytest.approx(force.mean(), rel=0.1)


def test_the_beam_slaps_outward_from_where_it_meets_the_roller(runs):
    events = runs["beam_on_cylinder"].events
    touches = events["x"][events["kind"] == "touch"]
    assert abs(touches[0]) < 8.1e-3 and np.ptp(touches) > 14e-3
    history = runs["beam_on_cylinder"].history
    assert history["left end"][-1] < 0.0 and history["right end"][-1] < 0.0


@pytest.mark.parametrize("name", COARSE)
def test_what_is_resolved_is_read_back(name):
    given = load(FOLDER / f"{name}.toml", units=UNITS)
    assert loads(dumps(given), units=UNITS) == given


FIELDS = {
    "supports": ("bodies.bar.supports", lambda s: s.bodies["bar"].supports[1].times, (0.0, 0.005)),
    "velocity": ("velocity", lambda s: s.bodies["bar"].supports[1].velocity, (0.0, 2.5)),
}


@pytest.mark.parametrize(
    ("change", "expected", "written"),
    [
        ("contacts[0].method=NodeToSurface", sw.contact.NodeToSurface(), 'nodes = "finer"'),
        (
            "contacts[0].method={kind='NodeToSurface', nodes='both'}",
            sw.contact.NodeToSurface(nodes="both"),
            'nodes = "both"',
        ),
        ("contacts[0].method=DualMortar", sw.contact.DualMortar(), 'kind = "DualMortar"'),
    ],
)
def test_methods_are_read_and_written(change, expected, written):
    found = load(FOLDER / "ring_in_ring.toml", [change], units=UNITS)
    text = dumps(found)
    assert found.contacts[0].method == expected and written in text and loads(text, units=UNITS) == found


def test_start_and_control_are_read_and_written():
    changes = ["contacts[0].start=fit", "time.control={approach=0.5, least=1e-5}"]
    found = load(FOLDER / "ring_in_ring.toml", changes, units=UNITS)
    assert found.contacts[0].start == "fit"
    assert found.time.control == replace(sw.StepControl(), approach=0.5, least=1e-5)
    text = dumps(found)
    assert 'start = "fit"' in text and "approach = 0.5" in text and loads(text, units=UNITS) == found


def test_driven_supports_are_read_and_written():
    found = load(FOLDER / "bar_through_die.toml", units=UNITS)
    driven = sw.Driven(on="left", components="x", velocity=(0.0, 2.5), times=(0.0, 0.005))
    assert found.bodies["bar"].supports == (sw.Fixed(on="bottom", components="y"), driven)
    text = dumps(found)
    assert '"2.5 m/s"' in text and '"0.005 s"' in text and loads(text, units=UNITS) == found
