"""Random assemblies: several bodies, all with all and with themselves, in a box; their scenario, by its number.

Discs, boxes, thin closed rings and strips in the plane, balls, boxes and plates in space; friction, some pairs with a
contact of their own, some glued to each other, some of two materials.
"""

from dataclasses import dataclass
from math import degrees, pi

import numpy as np

from inputs.drops import Drop, Rng

PITCH = 0.14
"""Distance of the places of the bodies [m]; each of them is less than a tenth of a metre wide."""
MODULUS, DENSITY = 1e6, 1000.0
"""Modulus of elasticity [Pa] and density [kg/m^3]: waves need three milliseconds for a body."""
STEP = 5e-4
"""Length of the time step asked for [s]."""


@dataclass(frozen=True, slots=True)
class Piece:
    """One or two solids at a place: names, kind, their tables, ties between them, and a surface for contacts of two."""

    names: tuple[str, ...]
    kind: str
    text: str


def assembly(number: int) -> Drop:
    """The assembly of a number.

    Examples
    --------
    >>> assembly(1) == assembly(1), assembly(1) == assembly(2)
    (True, False)
    """
    rng = np.random.default_rng([2028, number])
    dim = int(rng.choice([2, 2, 2, 2, 3]))
    many = int(rng.integers(3, 9 if dim == 2 else 6))
    speed = float(10.0 ** rng.uniform(-0.5, 0.6))
    pieces: list[Piece] = []
    while (count := sum(len(p.names) for p in pieces)) < many:
        pieces.append(_piece(rng, dim, len(pieces), speed, glued=many - count > 1 and rng.random() < 0.2))
    friction = _friction(rng)
    pairs = _pairs(rng, pieces)
    floor = _walls(dim, columns=2)
    gravity = f'[[loads]]\nkind = "Gravity"\nacceleration = {[0.0] * (dim - 1) + [-9.81]}\n'
    end = 0.015 + float(rng.uniform(0.015, 0.035)) / max(speed, 1.0)
    text = f"""title = "Assembly {number}"

{"".join(p.text for p in pieces)}{floor}
[[contacts]]
between = "all"
{friction[1]}
{"".join(text for text, _ in pairs)}
{gravity}
[time]
end = {end:.6g}
step = {STEP}
"""
    kinds = sorted(p.kind for p in pieces)
    traits = {
        "space": f"{dim}D", "bodies": str(many), "pieces": ", ".join(kinds), "friction": friction[0],
        "pairs": ", ".join(name for _, name in pairs) or "none", "speed": f"{speed:.2g}",
    }  # fmt: skip
    return Drop(number=number, text=text, traits=traits)


def _piece(rng: Rng, dim: int, place: int, speed: float, glued: bool) -> Piece:
    """Body, or two glued ones, at a place of the grid: two columns in the plane, two by two in space."""
    level, rest = divmod(place, 2 ** (dim - 1))
    grid = [rest % 2 - 0.5, rest // 2 - 0.5][: dim - 1]
    middle = [PITCH * g for g in grid] + [0.5 * PITCH + PITCH * level]
    centre = np.array(middle) + rng.uniform(-0.008, 0.008, dim)
    velocity = speed * rng.normal(0.0, 0.5, dim) - speed * np.eye(dim)[-1] * float(rng.uniform(0.0, 1.0))
    turn = _turn(rng, dim)
    where = f"about = {[0.0] * dim}, translation = {[round(v, 6) for v in centre.tolist()]}{turn}"
    more = f"group = [{{ {where} }}]\nvelocity = {[round(v, 4) for v in velocity.tolist()]}\n"
    if glued:
        return _glued(rng, dim, place, more)
    kinds = ["disc", "disc", "box", "ring", "ring", "strip"] if dim == 2 else ["ball", "box", "plate"]
    kind = str(rng.choice(kinds))
    mesh = _mesh(rng, dim, kind)
    if rng.random() < 0.25:
        zone = f'{{ kind = "InBox", low = {[-1.0] * (dim - 1) + [0.0]} }}'
        mesh = f'{{ kind = "Divided", mesh = {mesh}, regions = {{ upper = {zone} }}, rest = "lower" }}'
        material = f"{{ upper = {_material(rng)}, lower = {_material(rng)} }}"
        kind += " of two materials"
    else:
        material = _material(rng)
    return Piece((f"b{place}",), kind, _solid(f"b{place}", mesh, material, more))


def _solid(name: str, mesh: str, material: str, more: str) -> str:
    return f"""[bodies.{name}]
kind = "Solid"
mesh = {mesh}
material = {material}
density = {DENSITY}
{more}
"""


def _glued(rng: Rng, dim: int, place: int, more: str) -> Piece:
    """Two boxes, one on the other, whose meshes do not match."""
    wide = float(rng.uniform(0.05, 0.065))
    few = int(rng.integers(4, 6))
    lower = _block([wide] * (dim - 1) + [0.03], [few] * (dim - 1) + [2], [-0.5 * wide] * (dim - 1) + [-0.03], dim)
    upper = _block([wide] * (dim - 1) + [0.03], [few - 1] * (dim - 1) + [2], [-0.5 * wide] * (dim - 1) + [0.0], dim)
    names = f"b{place}", f"c{place}"
    text = _solid(names[0], lower, _material(rng), more) + _solid(names[1], upper, _material(rng), more)
    return Piece(names, "glued boxes", f'{text}[[ties]]\nbetween = ["{names[0]}.top", "{names[1]}.bottom"]\n\n')


def _block(size: list[float], cells: list[int], origin: list[float], dim: int) -> str:
    kind = "Rectangle" if dim == 2 else "Box"
    size, origin = ([round(v, 6) for v in values] for values in (size, origin))
    return f'{{ kind = "{kind}", size = {size}, cells = {cells}, origin = {origin} }}'


def _mesh(rng: Rng, dim: int, kind: str) -> str:
    """Mesh of a body around the origin."""
    r = float(np.round(rng.uniform(0.03, 0.05), 4))
    cell = str(rng.choice(["quad4", "tri3", "quad9"]))
    match kind:
        case "disc":
            return f'{{ kind = "Disc", radius = {r}, cells = {2 * int(rng.integers(2, 4))}, cell = "{cell}" }}'
        case "ball":
            return f'{{ kind = "Ball", radius = {r}, cells = 4 }}'
        case "ring":
            inner = round(r * float(rng.uniform(0.6, 0.85)), 5)
            around = int(rng.integers(12, 24))
            cell = cell if cell != "quad9" else "quad4"
            return f'{{ kind = "Ring", inner = {inner}, outer = {r}, cells = [2, {around}], cell = "{cell}" }}'
        case "strip":
            thick = float(np.round(rng.uniform(0.008, 0.02), 4))
            return _block([0.09, thick], [int(rng.integers(6, 12)), 2], [-0.045, -0.5 * thick], dim)
        case "plate":
            thick = float(np.round(rng.uniform(0.01, 0.02), 4))
            return _block([0.08, 0.06, thick], [4, 3, 2], [-0.04, -0.03, -0.5 * thick], dim)
    few = int(rng.integers(3, 5)) if dim == 2 else 3
    return _block([1.3 * r] * dim, [few] * dim, [-0.65 * r] * dim, dim)


def _material(rng: Rng) -> str:
    """Rubber of different moduli, damped in part; the softest is ten times as soft as the stiffest."""
    modulus = MODULUS * 10.0 ** float(rng.uniform(-0.5, 0.5))
    nu = float(rng.choice([0.3, 0.4]))
    kind = str(rng.choice(["NeoHookean", "NeoHookean", "MooneyRivlin", "Kelvin"]))
    if kind == "MooneyRivlin":
        return f'{{ kind = "MooneyRivlin", c10 = {modulus / 8:.6g}, c01 = {modulus / 24:.6g}, bulk = {modulus:.6g} }}'
    more = f", shear_viscosity = {2e-5 * modulus:.6g}" if kind == "Kelvin" else ""
    return f'{{ kind = "{kind}", E = {modulus:.6g}, nu = {nu}{more} }}'


def _turn(rng: Rng, dim: int) -> str:
    """Random rotation, or none: boxes that lie flat on each other are a case of their own."""
    if rng.random() < 0.3:
        return ""
    axis = rng.normal(size=3).round(3).tolist() if dim == 3 else [0, 0, 1]
    return f', rotations = [{{ axis = {axis}, angle = "{degrees(float(rng.uniform(0, pi))):.6g} deg" }}]'


def _friction(rng: Rng) -> tuple[str, str]:
    """Name and text of the law of all surfaces."""
    if rng.random() < 0.35:
        return "none", ""
    mu = float(np.round(rng.uniform(0.1, 0.7), 2))
    return f"mu = {mu}", f'friction = {{ kind = "Coulomb", mu = {mu} }}\n'


def _pairs(rng: Rng, pieces: list[Piece]) -> list[tuple[str, str]]:
    """Contacts of two bodies that have a friction of their own, and their methods."""
    found = []
    for one, two in zip(pieces[:-1], pieces[1:], strict=True):
        if rng.random() < 0.25:
            mu = float(np.round(rng.uniform(0.1, 0.7), 2))
            method = str(rng.choice(["DualMortar", "NodeToSurface"]))
            text = f'[[contacts]]\nbetween = ["{one.names[0]}", "{two.names[0]}"]\nmethod = {{ kind = "{method}" }}\n'
            found.append((f'{text}friction = {{ kind = "Coulomb", mu = {mu} }}\n\n', method))
    return found


def _walls(dim: int, columns: int) -> str:
    """Floor, and walls beside the bodies."""
    half = 0.5 * columns * PITCH + 0.01
    planes = [("floor", [0.0] * dim, [0.0] * (dim - 1) + [1.0])]
    for axis in range(dim - 1):
        for name, side in (("low", -1.0), ("high", 1.0)):
            point, normal = [0.0] * dim, [0.0] * dim
            point[axis], normal[axis] = round(side * half, 6), -side
            planes.append((f"{name}{axis}", point, normal))
    return "".join(
        f'[bodies.{name}]\nkind = "Tool"\nshape = {{ kind = "HalfSpace", point = {point}, normal = {normal} }}\n\n'
        for name, point, normal in planes
    )
