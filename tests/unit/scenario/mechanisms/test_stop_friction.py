"""Friction of stops in scenario files: greater at rest, belts, against rolling."""

import numpy as np

import softway as sw
from softway.record.read.mechanism_summary import told
from softway.scenario.json_schema import schema

BELT = """
[bodies.mass]
kind = "Rigid"
mass = "1 kg"
centre = ["0 m", "0 m"]
inertia = "0.01 kg m^2"
velocity = ["10 cm/s", "0 m/s"]
[stops.belt]
kind = "PlaneStop"
between = ["ground", "mass"]
point = ["0 m", "0 m"]
plane = ["0 m", "-5 cm"]
radius = "5 cm"
normal = [0, 1]
friction = 0.2
mu_s = 0.4
rolling = "20 cm"
velocity = ["10 cm/s", "0 m/s"]
[[springs]]
between = ["ground", "mass"]
ends = [["-1 m", "0 m"], ["0 m", "0 m"]]
stiffness = "100 N/m"
[[loads]]
kind = "Gravity"
acceleration = ["0 m/s^2", "-9.81 m/s^2"]
[time]
end = "1 s"
step = "5 ms"
"""
"""A wheel on a belt, which does not roll."""


def test_a_belt_with_friction_that_is_greater_at_rest_is_told(tmp_path):
    file = tmp_path / "belt.toml"
    file.write_text(BELT, encoding="utf-8")
    run = sw.run(sw.load(file), tmp_path / "run")
    assert run.events["kind"].tolist() == ["slip", "stick"]
    np.testing.assert_allclose(run.events["time"], [0.3924, 0.8008322], rtol=3e-4)
    assert run.history["work_external"][-1] > 0.1
    assert "its sliding began once and ended once" in "".join(told(run.summary))


def test_the_schema_has_the_friction_of_stops():
    text = str(schema())
    for word in ("'mu_s'", "'rolling'", "'drilling'", "as of a belt"):
        assert word in text
