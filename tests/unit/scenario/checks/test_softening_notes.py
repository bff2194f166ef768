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
{more}

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
PRESS = """
inertia = {{ kind = "{inertia}" }}

[bodies.block]
kind = "Solid"
mesh = {{ kind = "Rectangle", size = ["1 m", "1 m"], cells = [4, 4] }}
material = {{ kind = "StVenantKirchhoff", E = "1 Pa", nu = 0.3 }}
density = "1 kg/m^3"
supports = [{{ on = "bottom" }}]

[bodies.platen]
kind = "Tool"
shape = {{ kind = "HalfSpace", point = [0, 1.01], normal = [0, -1] }}
motion = {{ kind = "Translation", velocity = [0, -1] }}

[[contacts]]
between = ["block.top", "platen"]

[time]
end = "0.1 s"
step = "0.01 s"
"""
WAVE = 1.1602387022306428
"""Speed of dilatational waves for nu = 0.3 [m/s]."""


def notes(law: str, nu: float, speed: float, other: str = FLOOR, more: str = "") -> list[sw.errors.Note]:
    """The notes on the material of the ball, hitting with a speed [m/s]."""
    text = SCENE.format(law=law, nu=nu, speed=-speed, other=other, more=more)
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


@pytest.mark.parametrize(
    ("nu", "section", "length"),
    [
        (0.5, "PlaneStrain", "to 1 of its length"),
        (0.499, "PlaneStress", "to 0.74 of its length"),
        (0.3, "PlaneStress", "to 0.65 of its length"),
        (-0.9, "PlaneStrain", "to 0.58 of its length"),
    ],
)
def test_every_ratio_of_poisson_in_every_section_has_its_stretch(nu: float, section: str, length: str) -> None:
    dilatation = 'dilatation = "mean"' if (nu, section) == (0.5, "PlaneStrain") else ""
    more = f'{dilatation}\nsection = {{ kind = "{section}" }}'
    (note,) = notes("StVenantKirchhoff", nu, 10.0, more=more)
    assert length in note.problem


@pytest.mark.parametrize(("inertia", "said"), [("Full", True), ("Off", False)])
def test_without_inertia_there_is_no_impact(inertia: str, said: bool) -> None:
    text = PRESS.format(inertia=inertia)
    assert bool([n for n in sw.check(sw.loads(text)).notes if n.where == "bodies.block.material"]) == said
