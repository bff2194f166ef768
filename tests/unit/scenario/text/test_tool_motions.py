"""Smooth motions of tools in scenario files: every law, along a line and about an axis, in a run without inertia."""

import math
from typing import Any

import pytest

import softway as sw
from softway.bodies.setup.motion_laws import MotionLaw, value_and_rate

LAWS: dict[str, MotionLaw] = {
    "{ kind = 'Spline', times = [0.0, 0.4, 1.0], points = [0.0, 0.1, 0.05] }": sw.bodies.Spline(
        times=(0.0, 0.4, 1.0), points=(0.0, 0.1, 0.05)
    ),
    "{ kind = 'SmoothSteps', times = [0.0, 0.5, 1.0], points = [0.0, 0.1, 0.2] }": sw.bodies.SmoothSteps(
        times=(0.0, 0.5, 1.0), points=(0.0, 0.1, 0.2)
    ),
    "{ kind = 'Sine', amplitude = 0.01, frequency = 2.0 }": sw.bodies.Sine(amplitude=0.01, frequency=2.0),
    "{ kind = 'Haversine', height = 0.1, duration = '500 ms' }": sw.bodies.Haversine(height=0.1, duration=0.5),
    "{ kind = 'RatePolyline', times = [0.0, 0.5, 1.0], rates = [0.0, 0.2, 0.0] }": sw.bodies.RatePolyline(
        times=(0.0, 0.5, 1.0), rates=(0.0, 0.2, 0.0)
    ),
}
TEXT = """
inertia = {{ kind = "Off" }}
time = {{ end = 1.0, step = 0.3 }}

[bodies.block]
kind = "Solid"
mesh = {{ kind = "Rectangle", size = [1.0, 1.0], cells = [2, 2] }}
material = {{ kind = "LinearElastic", E = 1.0, nu = 0.0 }}
density = 1.0
supports = [{{ on = "bottom" }}]

[bodies.ram]
kind = "Tool"
shape = {{ kind = "HalfSpace", point = [0.0, 0.7], normal = [0.0, -1.0] }}
motion = {motion}

[[contacts]]
between = ["block.top", "ram"]
start = "fit"
"""


@pytest.mark.few(3)
@pytest.mark.parametrize("law", LAWS)
def test_a_block_is_pressed_by_the_law(law: str) -> None:
    motion = f"{{ kind = 'Sliding', direction = [0.0, 1.0], travel = {law} }}"
    scenario = sw.loads(TEXT.format(motion=motion))
    assert sw.loads(sw.dumps(scenario)) == scenario
    checked = sw.check(scenario)
    for step in sw.march(checked.model, until=1.0, step=0.3):
        value, _ = value_and_rate(LAWS[law].pieces, step.after.time)
        top = step.after.displacement["block"][-3:, 1]
        assert top == pytest.approx([-0.3 + value - value_and_rate(LAWS[law].pieces, 0.0)[0]] * 3, abs=1e-13)


@pytest.mark.parametrize("law", LAWS)
def test_a_tool_turns_by_the_law(law: str) -> None:
    motion = f"{{ kind = 'Swinging', point = [0.0, 5.0], angle = {law} }}"
    scenario = sw.loads(TEXT.format(motion=motion))
    ram = scenario.bodies["ram"]
    assert isinstance(ram, sw.Tool) and ram.motion == sw.bodies.Swinging(point=(0.0, 5.0), angle=LAWS[law])
    assert sw.loads(sw.dumps(scenario)) == scenario


def _moved(motion: str) -> Any:
    """Motion of the ram that a text describes."""
    ram: Any = sw.loads(TEXT.format(motion=motion)).bodies["ram"]
    return ram.motion


def test_values_of_a_law_have_the_unit_of_what_moves() -> None:
    law = "{{ kind = 'SmoothSteps', times = [0, '500 ms'], points = [0, '{value}'] }}"
    along = f"{{ kind = 'Sliding', direction = [0.0, 1.0], travel = {law.format(value='25 mm')} }}"
    about = f"{{ kind = 'Swinging', point = [0.0, 5.0], angle = {law.format(value='90 deg')} }}"
    assert _moved(along).travel.points == pytest.approx((0.0, 0.025))
    assert _moved(about).angle.points == pytest.approx((0.0, math.pi / 2))
    with pytest.raises(sw.InputError, match="expected a length"):
        _moved(along.replace("25 mm", "25 ms"))


@pytest.mark.parametrize(
    ("law", "same"),
    [
        (
            "{ kind = 'RatePolyline', times = [0.0, 1.0], rates = [0.0, '36 km/h'] }",
            sw.bodies.RatePolyline(times=(0.0, 1.0), rates=(0.0, 10.0)),
        ),
        (
            "{ kind = 'Sine', amplitude = '2 m', frequency = '50 Hz', phase = '0 deg' }",
            sw.bodies.Sine(amplitude=2.0, frequency=50.0),
        ),
    ],
)
def test_rates_and_frequencies_have_units(law: str, same: MotionLaw) -> None:
    assert _moved(f"{{ kind = 'Sliding', direction = [0.0, 1.0], travel = {law} }}").travel == same
