"""What the expansion of a solid gives to its heat and takes back is no dissipation: ledger, summary and picture."""

import numpy as np
import pytest

import softway as sw
from softway.record.view.bodies.bodies import _stressed
from softway.scenario.files import loads

PLATE = """
title = "A free elastic plate is heated and cooled"
[bodies.b]
kind = "Solid"
mesh = { kind = "Rectangle", size = ["20 mm", "10 mm"], cells = [2, 1] }
section = { kind = "PlaneStress" }
material = { kind = "LinearElastic", E = "200 GPa", nu = 0.3 }
density = "7800 kg/m^3"
supports = [{ on = "left", components = "x" }, { on = "bottom", components = "y" }]
[bodies.b.thermal]
temperature = "300 K"
expansion = "1e-5 1/K"
law = { conductivity = "1e5 W/(m*K)", capacity = "500 J/(kg*K)" }
[[loads]]
kind = "HeatSource"
of = "b"
value = "39 MW/m^3"
ramp = { times = ["0 s", "5 s", "6 s", "11 s"], factors = [1, 1, -1, -1] }
[inertia]
kind = "Off"
[output]
fields_every = "0.5 s"
[time]
end = "11 s"
step = "0.5 s"
"""


def made(text: str, folder) -> sw.Run:
    return sw.run(loads(text), folder / "run")


def test_a_free_plate_takes_energy_and_gives_it_back(tmp_path):
    """The strain e of both directions costs E e^2/(1 - nu) per volume, and the energy of the expansion is -2 of it."""
    run = made(PLATE, tmp_path)
    rise = np.array([frame["temperature"].mean() for frame in run.fields]) - 300.0
    energy = 200e9 / 0.7 * (1e-5 * rise) ** 2 * 2e-4
    history = run.history
    assert energy.max() == pytest.approx(15.6, rel=1e-3)
    assert history["energy_strain"] == pytest.approx(-energy, abs=1e-9 * energy.max())
    assert history["heat.reversible"] == pytest.approx(energy, abs=1e-9 * energy.max())
    assert history["dissipation"] == pytest.approx(history["heat.reversible"], abs=1e-12)
    assert abs(run.summary["dissipation"]) < 1e-12 and abs(run.summary["heat"]["heat_reversible"]) < 1e-9
    assert _stressed(run) is None


def test_heated_half_way_nothing_is_dissipated(tmp_path):
    run = made(PLATE.replace('end = "11 s"', 'end = "5 s"'), tmp_path)
    assert run.history["dissipation"][-1] > 10.0 and abs(run.summary["dissipation"]) < 1e-12


def test_the_picture_of_a_clamped_plate_is_that_of_the_greatest_stress(tmp_path):
    held = PLATE.replace("supports = [", 'supports = [{ on = "right", components = "x" }, ')
    run = made(held, tmp_path)
    stress = [float(frame.von_mises.max()) for frame in run.fields]
    assert _stressed(run) == int(np.argmax(stress)) and run.fields.times[_stressed(run)] == pytest.approx(5.5)
    assert max(stress) == pytest.approx(200e9 * 1e-5 * 52.2, rel=5e-3)
