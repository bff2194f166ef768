"""A hot rigid body and a solid with heat from a scenario file: columns of the history, and a run that is resumed."""

from pathlib import Path

import numpy as np
import pytest

import softway as sw
from softway.errors import InputError
from softway.record.view.pictures import picture

DIE = """
title = "A hot die on a plate"
[bodies.plate]
kind = "Solid"
mesh = { kind = "Rectangle", size = ["40 mm", "20 mm"], cells = [4, 2] }
material = { kind = "LinearElastic", E = "0.1 GPa", nu = 0.3 }
density = "2000 kg/m^3"
supports = [{ on = "bottom" }]
thermal = { temperature = "20 degC", law = { conductivity = "50 W/(m*K)", capacity = "500 J/(kg*K)" } }
[bodies.die]
kind = "Rigid"
density = "8000 kg/m^3"
velocity = ["50 mm/s", "-0.1 m/s"]
shape = { kind = "Block", low = ["-20 mm", "20 mm"], high = ["60 mm", "50 mm"] }
thermal = { temperature = "500 degC", specific_heat = "0.5 kJ/(kg*K)", conductivity = "30 W/(m*K)" }
[[contacts]]
between = ["plate.top", "die"]
friction = { kind = "Coulomb", mu = 0.3 }
heat = { conductance = "1e5 W/(m^2*K)" }
[time]
end = "1.5 ms"
step = "0.1 ms"
"""


@pytest.mark.slow
def test_the_history_has_the_temperature_and_a_resumed_run_the_same_bits(tmp_path: Path) -> None:
    seen: list[object] = []

    def stop(progress: object) -> None:
        seen.append(progress)
        if len(seen) == 7:
            raise KeyboardInterrupt

    whole = sw.run(sw.loads(DIE), tmp_path / "whole")
    with pytest.raises(KeyboardInterrupt):
        sw.run(sw.loads(DIE), tmp_path / "stopped", progress=stop)
    sw.resume(tmp_path / "stopped")
    for name in ("history.csv", "rigid.csv"):
        assert (tmp_path / "stopped" / name).read_bytes() == (whole.path / name).read_bytes(), name
    table, mass = whole.history, 8000.0 * 0.08 * 0.03
    assert table.units["temperature.die"] == "K" and table["temperature.die"][0] == pytest.approx(773.15)
    assert np.abs(table["energy_error"]).max() < 1e-11 * table["energy_kinetic"][0]
    assert np.abs(table["heat.error"]).max() < 1e-14 * table["heat.content"][0]
    taken = mass * 500.0 * (table["temperature.die"][-1] - 773.15)
    die, plate = (np.sqrt(k * rho * 500.0) for k, rho in ((30.0, 8000.0), (50.0, 2000.0)))
    shared = table["heat.friction"][-1] * die / (die + plate) + table["heat.through.plate.top-die"][-1]
    assert taken == pytest.approx(shared, rel=1e-9) and table["heat.friction"][-1] > 0.0
    assert (np.diff(table["heat.entropy"]) >= 0.0).all()
    assert picture(whole, "history").save(tmp_path / "history.png").stat().st_size > 5000


SEAT = """
[bodies.plate]
kind = "Solid"
mesh = { kind = "Rectangle", size = [1, 1], cells = [1, 1] }
material = { kind = "LinearElastic", E = 1e5, nu = 0.3 }
density = 1000
supports = [{ on = "bottom" }]
thermal = { temperature = 300, law = { conductivity = 1, capacity = 1 } }
[bodies.table]
kind = "Rigid"
mass = 3
centre = [5, -1]
inertia = 1
thermal = { temperature = 300, capacity = 2 }
[bodies.block]
kind = "Rigid"
mass = 2
centre = [5, 0]
inertia = 1
velocity = [1, 0]
thermal = { temperature = 300, capacity = 5 }
[joints.guide]
kind = "Slider"
between = ["ground", "table"]
at = [5, -1]
axis = [1, 0]
[stops.seat]
kind = "PlaneStop"
between = ["table", "block"]
point = [5, 0]
plane = [5, 0]
normal = [0, 1]
friction = 0.3
[[loads]]
kind = "Gravity"
acceleration = [0, -10]
[[heat_links]]
stop = "seat"
share = 0.25
[time]
end = 0.4
step = 0.02
"""


def test_a_file_of_two_rigid_bodies_that_rub_each_other(tmp_path: Path) -> None:
    """Both warm up by their shares of the energy that they lose until they move together."""
    scenario = sw.loads(SEAT)
    assert sw.loads(sw.dumps(scenario)) == scenario
    run = sw.run(scenario, tmp_path / "run")
    rise = {name: run.history[f"temperature.{name}"][-1] - 300.0 for name in ("table", "block")}
    assert rise["table"] == pytest.approx(0.25 * 0.6 / 2.0, rel=1e-9)
    assert rise["block"] == pytest.approx(0.75 * 0.6 / 5.0, rel=1e-9)
    assert run.history["heat.friction"][-1] == pytest.approx(0.6, rel=1e-10)


def test_a_second_link_of_the_same_stop_is_refused() -> None:
    twice = (
        "heat_links=[{between=['table', 'block'], conductance=1}, {stop='seat', share=0.25}, {stop='seat', share=1}]"
    )
    with pytest.raises(InputError, match="'seat', as in heat_links.1.") as found:
        sw.check(sw.loads(SEAT, changes=(twice,)))
    assert found.value.where == "heat_links[2].stop" and "one link of the stop" in found.value.remedy


def test_conductances_between_the_same_bodies_add_up(tmp_path: Path) -> None:
    """Two bodies that do not touch: the difference of their temperatures decays with the sum of both conductances."""
    links = [f"{{between=['table', 'block'], conductance={g}}}" for g in (2.0, 3.0)]
    changes = [f"heat_links=[{', '.join(links)}]", "loads=[]", "bodies.block.velocity=[0, 0]", "stops={}"]
    run = sw.run(sw.loads(SEAT, changes=(*changes, "bodies.block.thermal.temperature=370")), tmp_path / "run")
    table, block = (run.history[f"temperature.{name}"] for name in ("table", "block"))
    middle = (2.0 * 300.0 + 5.0 * 370.0) / 7.0
    assert 2.0 * table + 5.0 * block == pytest.approx(np.full(len(table), 7.0 * middle), rel=1e-12)
    rate = 5.0 * (1.0 / 2.0 + 1.0 / 5.0)
    assert block[-1] - table[-1] == pytest.approx(70.0 * np.exp(-rate * 0.4), rel=1e-3)
