"""Small scenes from which scenarios are mutated: every dimension, rule, solver and kind of tool, a few cells a body."""

import tomllib
from typing import Any

WALL = "[bodies.wall]\nkind = 'Tool'\nshape = { kind = 'HalfSpace', point = @, normal = # }\n"
BAR = """
[bodies.bar]
kind = 'Solid'
mesh = { kind = 'Interval', length = '1 m', cells = 2 }
material = { kind = 'LinearElastic', E = '1 Pa' }
density = '1 kg/m^3'
velocity = '1 m/s'
"""
PLATE = """
[bodies.plate]
kind = 'Solid'
mesh = { kind = 'Rectangle', size = ['1 m', '1 m'], cells = [2, 2] }
material = { kind = 'NeoHookean', E = '100 Pa', nu = 0.3 }
density = '1 kg/m^3'
velocity = ['0.1 m/s', '-1 m/s']
place = { bottom = '1 mm' }
"""
BLOCK = """
[bodies.block]
kind = 'Solid'
mesh = { kind = 'Box', size = ['1 m', '1 m', '1 m'], cells = [2, 1, 2] }
material = { kind = 'NeoHookean', E = '100 Pa', nu = 0.3 }
density = '1 kg/m^3'
velocity = ['0.1 m/s', '0 m/s', '-1 m/s']
place = { bottom = '1 mm' }
"""
HELD = "supports = [{ on = 'bottom' }]"
DRIVEN = "[{ kind = 'Driven', on = 'top', components = 'y', velocity = [0, '-0.2 m/s'], times = [0, '1 s'] }]"
TIME = "[time]\nend = '2 s'\n"
PROBE = "[[output.probes]]\nname = 'low'\nof = '@'\ntag = 'bottom'\nquantity = 'position'\ncomponent = 'y'\n"
GRAVITY = "[[loads]]\nkind = 'Gravity'\nacceleration = @\n"


def _wall(point: str, normal: str) -> str:
    return WALL.replace("@", point).replace("#", normal)


def _touch(one: str, other: str, more: str = "") -> str:
    return f"[[contacts]]\nname = 'touch'\nbetween = ['{one}', '{other}']\n{more}\n"


def _second(text: str, name: str, new: str, place: str, more: str = "") -> str:
    """The same body once more, by another name, at rest, at another place."""
    lines = [line for line in text.splitlines() if not line.startswith(("place", "velocity"))]
    return "\n".join(lines).replace(f"bodies.{name}", f"bodies.{new}") + f"\nplace = {place}\n{more}\n"


SCENES = {
    "bar": BAR + _wall("1.1", "-1") + _touch("bar.right", "wall", "timing = 'Energy'") + TIME,
    "two bars": BAR
    + _second(BAR, "bar", "rod", "{ bottom = '1.05 m' }")
    + _touch("bar.right", "rod.left", "timing = 'Impulse'")
    + TIME,
    "plate": PLATE
    + _wall("[0, 0]", "[0, 1]")
    + _touch("plate.bottom", "wall", "friction = { kind = 'Coulomb', mu = 0.3 }")
    + GRAVITY.replace("@", "[0, -1]")
    + TIME
    + PROBE.replace("@", "plate"),
    "two plates": PLATE
    + _second(PLATE, "plate", "slab", "{ translation = ['-0.3 m', '-1 m'] }", HELD)
    + _touch("plate.bottom", "slab.top")
    + TIME,
    "pressed ring": """inertia = { kind = 'Off' }
[bodies.ring]
kind = 'Solid'
mesh = { kind = 'Rectangle', size = ['1.5 m', '1 m'], cells = [3, 2] }
material = { kind = 'NortonHoff', K = 1, m = 0.2 }
density = 1
section = { kind = 'Axisymmetric' }
dilatation = 'mean'
supports = [{ kind = 'Fixed', on = 'bottom', components = 'y' }]
place = { translation = ['1.5 m', '0 m'] }
[bodies.platen]
kind = 'Tool'
shape = { kind = 'HalfSpace', point = [0, 1], normal = [0, -1] }
motion = { kind = 'Translation', velocity = [0, -1] }
"""
    + _touch("ring.top", "platen", "friction = { kind = 'NortonHoff', alpha = 0.05, p = 0.2, K = 1 }")
    + "[time]\nend = '0.1 s'\nstep = '0.02 s'\n",
    "block": BLOCK + _wall("[0, 0, 0]", "[0, 0, 1]") + _touch("block.bottom", "wall") + TIME,
    "two blocks": BLOCK
    + _second(BLOCK, "block", "anvil", "{ translation = ['0.2 m', '0.1 m', '-1 m'] }", HELD)
    + _touch("block.bottom", "anvil.top", "friction = { kind = 'Tresca', shear = '1 Pa' }")
    + TIME,
    "block under a ball": BLOCK.replace("velocity", f"{HELD}\nvelocity").replace("-1 m/s", "0 m/s")
    + "[bodies.ball]\nkind = 'Tool'\nshape = { kind = 'Sphere', centre = [0.5, 0.5, 1.6], radius = '0.55 m' }\n"
    + "motion = { kind = 'Table', times = ['0 s', '1 s'], displacements = [[0, 0, 0], [0, 0, '-0.1 m']] }\n"
    + _touch("block.top", "ball")
    + "[start]\nkind = 'StaticStart'\nloads = [{ kind = 'Traction', on = 'block.top', value = [0, 0, '-0.1 Pa'] }]\n"
    + TIME,
    "driven plate": PLATE.replace("velocity", f"supports = {DRIVEN}\nvelocity", 1)
    .replace("'0.1 m/s', '-1 m/s'", "0, 0")
    + "[bodies.roll]\nkind = 'Tool'\nshape = { kind = 'Sphere', centre = [0.5, -0.3], radius = '0.29 m' }\n"
    + "motion = { kind = 'Turning', point = [0.5, -0.3], rate = '10 rpm' }\n"
    + _touch("plate.bottom", "roll", "friction = { kind = 'Coulomb', mu = 0.2 }\nmethod = 'NodeToSurface'")
    + TIME,
    "fast plate": PLATE
    + _wall("[0, 0]", "[0, 1]")
    + _touch("plate.bottom", "wall")
    + "[solver]\nkind = 'Explicit'\n"
    + TIME,
    "part": BLOCK.replace(
        "'Box', size = ['1 m', '1 m', '1 m'], cells = [2, 1, 2]", "'MeshFile', path = 'v22.msh', unit = 'm'"
    )
    + "[bodies.stamp]\nkind = 'Tool'\nshape = { kind = 'Surface', file = 'ascii.stl' }\n"
    + "motion = { kind = 'Translation', velocity = [0, 0, '0.1 m/s'] }\n"
    + _touch("block.skin", "stamp", "timing = 'Impulse'")
    + "[solver]\nkind = 'Newton'\n"
    + TIME,
    "fit": """[bodies.shaft]
kind = 'Solid'
mesh = { kind = 'Ring', inner = '0.5 m', outer = '1 m', cells = [1, 8] }
material = { kind = 'LinearElastic', E = '100 Pa', nu = 0.3 }
density = 1
[bodies.hub]
kind = 'Solid'
mesh = { kind = 'Ring', inner = '0.99 m', outer = '1.5 m', cells = [1, 8] }
material = { kind = 'LinearElastic', E = '100 Pa', nu = 0.3 }
density = 1
"""
    + _touch("shaft.outer", "hub.inner", "start = 'fit'")
    + TIME,
}  # fmt: skip


def scenes() -> dict[str, dict[str, Any]]:
    """The scenes as tables, by name.

    Examples
    --------
    >>> sorted(scenes()["bar"]["bodies"])
    ['bar', 'wall']
    """
    return {name: tomllib.loads(text) for name, text in SCENES.items()}
