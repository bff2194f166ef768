"""Notes on impacts that bring St. Venant-Kirchhoff matter to where it loses its stability."""

import pytest

import softway as sw

SCENE = """
[bodies.ball]
kind = "Solid"
mesh = {{ kind = "Disc", radius = "1 m", cells = 4 }}
material = {{ kind = "{law}", E = "1 Pa", nu = {nu} }}
density = "1 kg/m^3"
velocity = [0, "{speed} m/s"]
place = {{ bottom = "1 cm" }}

[bodies.other]
{other}

[[contacts]]
between = ["ball", "other"]

[time]
end = "1 s"
"""
FLOOR = 'kind = "Tool"\nshape = { kind = "HalfSpace", point = [0, 0], normal = [0, 1] }'
BLOCK = """kind = "Solid"
mesh = { kind = "Rectangle", size = ["4 m", "1 m"], origin = ["-2 m", "-1 m"], cells = [4, 2] }
material = { kind = "NeoHookean", E = "1 Pa" }
density = "1 kg/m^3"
"""
WAVE = 1.1602387022306428
"""Speed of dilatational waves for nu = 0.3 [m/s]."""


def notes(law: str, nu: float, speed: float, other: str = FLOOR) -> list[sw.errors.Note]:
    """The notes on the material of the ball, hitting with a speed [m/s]."""
    text = SCENE.format(law=law, nu=nu, speed=-speed, other=other)
    return [n for n in sw.check(sw.loads(text)).notes if n.where == "bodies.ball.material"]


@pytest.mark.parametrize(
    ("law", "nu", "speed", "other", "said"),
    [
        ("StVenantKirchhoff", 0.3, 0.51 * 0.2244 * WAVE, FLOOR, True),
        ("StVenantKirchhoff", 0.3, 0.49 * 0.2244 * WAVE, FLOOR, False),
        ("StVenantKirchhoff", 0.3, 0.99 * 0.2244 * WAVE, BLOCK, False),
        ("StVenantKirchhoff", 0.3, 1.01 * 0.2244 * WAVE, BLOCK, True),
        ("NeoHookean", 0.3, 0.51 * 0.2244 * WAVE, FLOOR, False),
    ],
)
def test_fast_impacts_of_softening_matter_are_noted(law: str, nu: float, speed: float, other: str, said: bool) -> None:
    found = notes(law, nu, speed, other)
    assert len(found) == said
    for note in found:
        assert "a plane impact at 0.26 m/s" in note.problem and "to 0.71 of its length" in note.problem
        assert not notes(note.remedy.partition(",")[0], nu, speed, other)
