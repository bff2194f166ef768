"""A hot rigid body and a solid with heat from a scenario file: columns of the history, and a run that is resumed."""

from pathlib import Path

import numpy as np
import pytest

import softway as sw
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
