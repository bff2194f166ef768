"""Notes on ties that break: cells longer than the softening zone, and surfaces without a contact after the break."""

import softway as sw

TEXT = """
[bodies.a]
mesh = { kind = "Rectangle", size = ["100 mm", "10 mm"], cells = [50, 4] }
material = { kind = "LinearElastic", E = "2 MPa", nu = 0.0 }
density = "1000 kg/m^3"
[bodies.b]
mesh = { kind = "Rectangle", size = ["100 mm", "10 mm"], cells = [40, 4], origin = [0.0, "10 mm"] }
material = { kind = "LinearElastic", E = "2 MPa", nu = 0.0 }
density = "1000 kg/m^3"
[[ties]]
between = ["a.top", "b.bottom"]
breaks = { strength = "50 kPa", energy = "20 J/m^2", stiffness = "1 GPa/m" }
[time]
end = "1 ms"
"""
CONTACT = '[[contacts]]\nbetween = ["a.top", "b.bottom"]\n'


def told(text: str) -> list[str]:
    """Problems noted on the tie of a scenario."""
    return [note.problem for note in sw.check(sw.loads(text)).notes if note.where == "ties[0].breaks"]


def test_fine_cells_and_a_contact_are_not_noted() -> None:
    """The zone of ``E Gc / strength^2 = 16 mm`` has six cells or more."""
    assert told(TEXT + CONTACT) == []


def test_coarse_cells_are_noted() -> None:
    (problem,) = told((TEXT + CONTACT).replace('"50 kPa"', '"200 kPa"').replace('"1 GPa/m"', '"10 GPa/m"'))
    assert "softens over about 0.001 m" in problem


def test_surfaces_without_a_contact_are_noted() -> None:
    (problem,) = told(TEXT)
    assert "no contact of the two" in problem
