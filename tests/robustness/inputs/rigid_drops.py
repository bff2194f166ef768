"""Random scenes with rigid bodies: they fall on solids, hang on joints, carry solids, and hit stops.

A third of the scenes are mechanisms without solids: chains that fall on stops with friction.
"""

from math import pi

import numpy as np

from inputs.drops import Drop, Rng


def rigid_drop(number: int) -> Drop:
    """The scene of a number.

    Examples
    --------
    >>> rigid_drop(1) == rigid_drop(1), rigid_drop(1) == rigid_drop(2)
    (True, False)
    """
    rng = np.random.default_rng([2027, number])
    family = str(rng.choice(["chain", "falls", "hangs", "carries", "falls"]))
    text, traits = {"chain": _chain, "falls": _falls, "hangs": _hangs, "carries": _carries}[family](rng)
    return Drop(number=number, text=f'title = "Rigid drop {number}"\n\n{text}', traits={"family": family, **traits})


def _solid(rng: Rng, name: str, size: tuple[float, float], origin: tuple[float, float], more: str = "") -> str:
    """Block of random cells and law in the plane, of a modulus of 1e6 Pa and a wave speed of about 30 m/s."""
    law = str(rng.choice(["LinearElastic", "NeoHookean", "NeoHookean", "StVenantKirchhoff", "J2"]))
    extra = (
        ', yield_stress = "5e4 Pa", hardening = { kind = "LinearHardening", modulus = "1e5 Pa" }' if law == "J2" else ""
    )
    cell = str(rng.choice(["quad4", "tri3", "quad9", "tri6"]))
    many = int(rng.integers(4, 11)), int(rng.integers(2, 5))
    return f"""[bodies.{name}]
kind = "Solid"
mesh = {{ kind = "Rectangle", size = {list(size)}, cells = {list(many)}, origin = {list(origin)}, cell = "{cell}" }}
material = {{ kind = "{law}", E = "1e6 Pa", nu = {rng.choice([0.0, 0.3, 0.45])}{extra} }}
density = "1000 kg/m^3"
{more}
"""


def _round(rng: Rng, name: str, place: tuple[float, float], speed: float, mass: float, shape: bool = True) -> str:
    """Disc or square of a mass, with a velocity mostly downwards and a spin."""
    r = 0.1
    square = rng.random() < 0.4
    x, y = place
    what = f'{{ kind = "Block", low = [{x - r}, {y - r}], high = [{x + r}, {y + r}] }}'
    disc = f'{{ kind = "Sphere", centre = [{x}, {y}], radius = {r} }}'
    inertia = mass * r * r * (2.0 / 3.0 if square else 0.5)
    return f"""[bodies.{name}]
kind = "Rigid"
mass = {mass}
centre = [{x}, {y}]
inertia = {inertia:.6g}
velocity = [{rng.normal(0.0, 0.4 * speed):.6g}, {-speed:.6g}]
spin = {rng.normal(0.0, speed / r):.6g}
{f"shape = {what if square else disc}" if shape else ""}
"""


def _contact(rng: Rng, one: str, two: str) -> tuple[str, str]:
    """Contact of a solid with a rigid body, and its friction."""
    mu = float(np.round(rng.uniform(0.05, 0.8), 2))
    law = str(rng.choice(["none", "Coulomb", "StaticKinetic"]))
    friction = {
        "none": "",
        "Coulomb": f'\nfriction = {{ kind = "Coulomb", mu = {mu} }}',
        "StaticKinetic": f'\nfriction = {{ kind = "StaticKinetic", mu_s = {mu}, mu_k = {round(0.6 * mu, 3)} }}',
    }[law]
    return f'[[contacts]]\nbetween = ["{one}", "{two}"]{friction}\n', law


def _time(rng: Rng, end: float, step: float) -> str:
    gravity = '[[loads]]\nkind = "Gravity"\nacceleration = [0, -9.81]\n' if rng.random() < 0.6 else ""
    solver = str(rng.choice(["FixedPoint", "FixedPoint", "Newton"]))
    return f'{gravity}\n[time]\nend = {end:.6g}\nstep = {step:.6g}\n\n[solver]\nkind = "{solver}"\n'


def _falls(rng: Rng) -> tuple[str, dict[str, str]]:
    """A rigid body falls on a solid, alone, with a second one on a rod, or below a stop."""
    speed, mass = float(10.0 ** rng.uniform(-1.5, 0.7)), float(10.0 ** rng.uniform(-1.0, 2.5))
    held = '\nsupports = [{ on = "bottom" }]' if rng.random() < 0.6 else ""
    gap = float(10.0 ** rng.uniform(-4, -1))
    place = float(rng.uniform(-0.3, 0.3)), 0.1 + gap
    text = _solid(rng, "block", (1.0, 0.4), (-0.5, -0.4), held) + _round(rng, "ball", place, speed, mass)
    joint, stop = rng.random() < 0.4, rng.random() < 0.4
    if joint:
        other = place[0] + 0.3, place[1] + 0.3
        text += _round(rng, "bob", other, speed, 0.5 * mass, shape=False)
        kind = str(rng.choice(["Rod", "Hinge"]))
        where = f"ends = [{list(place)}, {list(other)}]" if kind == "Rod" else f"at = {list(place)}"
        text += f'[joints.link]\nkind = "{kind}"\nbetween = ["ball", "bob"]\n{where}\n'
    if stop:
        text += f"""[stops.lid]
kind = "PlaneStop"
between = ["ground", "ball"]
point = {list(place)}
plane = [0, {place[1] + 0.11}]
normal = [0, -1]
radius = 0.1
restitution = {rng.choice([0.0, 0.5, 1.0])}
friction = {rng.choice([0.0, 0.3])}
"""
    contact, law = _contact(rng, "block.top", "ball")
    end = gap / speed + 0.15
    text += contact + _time(rng, end, end / float(rng.integers(40, 120)))
    return text, {"joint": str(joint), "stop": str(stop), "friction": law, "speed": f"{speed:.2g}"}


def _hangs(rng: Rng) -> tuple[str, dict[str, str]]:
    """A hinged or guided hammer hits a solid, driven by a spring or a torque."""
    speed, mass = float(10.0 ** rng.uniform(-1, 0.7)), float(10.0 ** rng.uniform(-0.5, 2))
    gap = float(10.0 ** rng.uniform(-3, -1.3))
    place = float(rng.uniform(-0.3, 0.3)), 0.1 + gap
    text = _solid(rng, "block", (1.0, 0.3), (-0.5, -0.3), '\nsupports = [{ on = "left" }]')
    text += _round(rng, "head", place, speed, mass)
    kind = str(rng.choice(["Hinge", "Slider"]))
    where = f"at = {[place[0] + 0.6, place[1] + 0.2]}" if kind == "Hinge" else f"at = {list(place)}\naxis = [0, 1]"
    text += f'[joints.guide]\nkind = "{kind}"\nbetween = ["ground", "head"]\n{where}\n'
    if rng.random() < 0.5:
        ends = f"ends = [[{place[0]}, {place[1] + 0.5}], {list(place)}]"
        text += (
            f'[[springs]]\nbetween = ["ground", "head"]\n{ends}\nstiffness = {100.0 * mass:.6g}\ndamping = {mass:.6g}\n'
        )
    contact, law = _contact(rng, "block.top", "head")
    end = gap / speed + 0.15
    text += contact + _time(rng, end, end / float(rng.integers(40, 120)))
    return text, {"joint": kind, "stop": "False", "friction": law, "speed": f"{speed:.2g}"}


def _carries(rng: Rng) -> tuple[str, dict[str, str]]:
    """A rigid hub carries a solid, free, hinged, or driven by a motor."""
    mass, rate = float(10.0 ** rng.uniform(-1, 2)), float(rng.uniform(0.5, 6.0))
    field = f'velocity = {{ kind = "Affine", gradient = [[0, {-rate}], [{rate}, 0]] }}'
    carried = f'\nsupports = [{{ kind = "Carried", on = "left", by = "hub" }}]\n{field}'
    text = _solid(rng, "beam", (1.0, 0.15), (0.1, -0.075), carried)
    text += (
        f'[bodies.hub]\nkind = "Rigid"\nmass = {mass}\ncentre = [0, 0]\ninertia = {0.01 * mass:.6g}\nspin = {rate}\n'
    )
    held = str(rng.choice(["free", "hinge", "motor"]))
    if held != "free":
        text += '[joints.pin]\nkind = "Hinge"\nbetween = ["ground", "hub"]\nat = [0, 0]\n'
    if held == "motor":
        text += f'[motors.drive]\njoint = "pin"\nmotion = {{ kind = "Steady", rate = {rate} }}\n'
    end = 0.2
    text += _time(rng, end, end / float(rng.integers(30, 80)))
    return text, {"joint": held, "stop": "False", "friction": "none", "speed": f"{rate:.2g}"}


def _chain(rng: Rng) -> tuple[str, dict[str, str]]:
    """Bars on hinges, hung up or free, that fall on a floor with friction."""
    count, length = int(rng.integers(1, 6)), 0.3
    angle = rng.uniform(0, pi)
    direction = np.array([np.cos(angle), np.sin(angle)])
    start = np.array([0.0, 0.4 + rng.uniform(0.0, 0.3)])
    hung, mu = rng.random() < 0.5, float(np.round(rng.uniform(0.0, 0.8), 2))
    restitution = float(rng.choice([0.0, 0.3, 0.8]))
    text = ""
    for k in range(count):
        ends = [start + (k + j) * length * direction for j in (0, 1)]
        centre, mass = 0.5 * (ends[0] + ends[1]), float(10.0 ** rng.uniform(-1, 1))
        text += f'[bodies.bar{k}]\nkind = "Rigid"\nmass = {mass:.6g}\ncentre = {centre.tolist()}\n'
        text += f"inertia = {mass * length**2 / 12.0:.6g}\n\n"
        if k or hung:
            pair = ["ground" if k == 0 else f"bar{k - 1}", f"bar{k}"]
            text += (
                f'[joints.pin{k}]\nkind = "Hinge"\nbetween = ["{pair[0]}", "{pair[1]}"]\nat = {ends[0].tolist()}\n\n'
            )
        for j in (0, 1):
            text += f"""[stops.floor{k}{j}]
kind = "PlaneStop"
between = ["ground", "bar{k}"]
point = {ends[j].tolist()}
plane = [0, -0.2]
normal = [0, 1]
restitution = {restitution}
friction = {mu}

"""
    text += '[[loads]]\nkind = "Gravity"\nacceleration = [0, -9.81]\n\n[time]\nend = 0.6\nstep = 0.002\n'
    return text, {"joint": f"{count}", "stop": "True", "friction": f"{mu}", "speed": f"e = {restitution}"}
