"""Random drops: bodies of random shape, cells and law fall on a random obstacle; their scenario, by its number.

Friction acts in half of the drops; two or three bodies are deformable in a third; some are hollow or open rings that
fold.
"""

from dataclasses import dataclass
from math import degrees, log10

import numpy as np

Rng = np.random.Generator


@dataclass(frozen=True, slots=True, kw_only=True)
class Drop:
    """A scenario in TOML, and what was drawn for it.

    Parameters
    ----------
    number
        From which everything is drawn.
    text
        The scenario.
    traits
        What was drawn, by heading: dimension, body, cells, law, obstacle, rule, solver, friction, speed.
    """

    number: int
    text: str
    traits: dict[str, str]


def drop(number: int) -> Drop:
    """The drop of a number.

    Examples
    --------
    >>> drop(1) == drop(1), drop(1) == drop(2)
    (True, False)
    """
    rng = np.random.default_rng([2026, number])
    dim = int(rng.choice([1, 2, 2, 2, 3, 3]))
    part = dim == 3 and rng.random() < 0.03
    rubs = dim > 1 and rng.random() < 0.6
    rule = "Energy" if rubs else str(rng.choice(["Energy", "Energy", "Impulse", "Paper"]))
    solver = "FixedPoint" if part else str(rng.choice(["FixedPoint", "Newton"]))
    bodies = 1 if dim == 1 or part else int(rng.choice([1, 1, 1, 2, 3]))
    size, modulus, density = (
        0.08 if part else 10.0 ** rng.uniform(-3, 0),
        10.0 ** rng.uniform(6, 11),
        10.0 ** rng.uniform(3, 4),
    )
    law, material = _material(rng, dim, modulus, part)
    mach = rng.uniform(0.05, 0.3) if rng.random() < 0.5 else 10.0 ** rng.uniform(-4, log10(0.3))
    speed = mach * float(np.sqrt(modulus / density))
    name, cell, mesh, cells = _mesh(rng, dim, size, part)
    obstacle, other = _obstacle(rng, dim, size, density, material, bodies)
    mass = rng.choice(['{ kind = "Consistent" }', '{ kind = "Lumped" }'])
    force = '\nforce = "EnergyMomentum"' if law in ("NeoHookean", "StVenantKirchhoff") and rng.random() < 0.4 else ""
    gap = size * 10.0 ** rng.uniform(-4, -1.3) + (1.4 * size if obstacle == "STL" else 0.0)
    end = min(gap, 0.05 * size) / speed * (1.0 if bodies < 3 else 4.0) + rng.uniform(1.0, 3.0) * 2.0 * size / float(
        np.sqrt(modulus / density)
    )
    step = f'"{end / (10 if part else max(20, cells * rng.integers(3, 9))):.6g} s"'
    body = f"""[bodies.body]
kind = "Solid"
mesh = {mesh}
material = {material}
density = "{density:.6g} kg/m^3"
mass = {mass}
velocity = {_velocity(rng, dim, speed)}{force}
{_place(rng, dim, gap, size)}"""
    friction = _friction(rng) if rubs else None
    third = bodies == 3
    if third:
        body += f"""
[bodies.third]
kind = "Solid"
mesh = {_mesh(rng, dim, size, part)[2]}
material = {material}
density = "{density:.6g} kg/m^3"
velocity = {_velocity(rng, dim, 3.0 * speed)}
{_place(rng, dim, 2.5 * size + gap, size)}"""
    pairs = [("drop", "body", "other.top" if obstacle == "body" else "other")]
    pairs += [("above", "third", "body"), ("beside", "third", "other")] if third else []
    contact = "\n".join(
        f'[[contacts]]\nname = "{label}"\nbetween = ["{one}", "{two}"]\ntiming = "{rule}"\n'
        + (f"friction = {friction[1]}\n" if friction else "")
        for label, one, two in pairs
    )
    weight = f"acceleration = {_vector(dim, -9.81, 'm/s^2')}"
    gravity = f'[[loads]]\nkind = "Gravity"\n{weight}\n' if rng.random() < 0.5 else ""
    text = f"""title = "Drop {number}"

{body}
[bodies.other]
{other}

{contact}
{gravity}
[time]
end = "{end:.6g} s"
step = {step}

[solver]
kind = "{solver}"
"""
    traits = {
        "space": f"{dim}D", "bodies": str(bodies), "body": name, "cells": cell, "law": law, "obstacle": obstacle,
        "rule": rule,        "solver": solver, "friction": friction[0] if friction else "none", "speed": f"{mach:.2g}",
    }  # fmt: skip
    return Drop(number=number, text=text, traits=traits)


def _vector(dim: int, last: float, unit: str) -> str:
    """A vector along the last axis."""
    return "[" + ", ".join([f'"0 {unit}"'] * (dim - 1) + [f'"{last:.6g} {unit}"']) + "]"


def _material(rng: Rng, dim: int, E: float, part: bool) -> tuple[str, str]:
    """Name and text of a law."""
    laws = ["LinearElastic", "NeoHookean", "NeoHookean", "StVenantKirchhoff", "MooneyRivlin"]
    laws += ["Hypoelastic", "J2", "J2", "Kelvin", "Maxwell"] if dim > 1 else []
    laws = ["LinearElastic", "NeoHookean"] if part else laws  # the part has two thousand cells
    law, nu = str(rng.choice(laws)), 0.0 if dim == 1 else float(rng.choice([0.0, 0.3, 0.45]))
    base = f'E = "{E:.6g} Pa", nu = {nu}'
    match law:
        case "MooneyRivlin":
            return law, f'{{ kind = "{law}", c10 = "{E / 8:.6g} Pa", c01 = "{E / 24:.6g} Pa", bulk = "{E:.6g} Pa" }}'
        case "J2":
            base += f', yield_stress = "{E * 10.0 ** rng.uniform(-3, -1):.6g} Pa"'
            base += f', hardening = {{ kind = "LinearHardening", modulus = "{E * rng.choice([0, 0.05]):.6g} Pa" }}'
        case "Kelvin":
            base += f', shear_viscosity = "{E * 1e-7 * 10.0 ** rng.uniform(-1, 2):.6g} Pa s"'
        case "Maxwell":
            base += ', shares = [0.3, 0.2], times = ["1 us", "1 ms"]'
    return law, f'{{ kind = "{law}", {base} }}'


def _mesh(rng: Rng, dim: int, size: float, part: bool) -> tuple[str, str, str, int]:
    """Name, cell and text of a mesh, and cells along its height."""
    few = int(rng.integers(2, 4))
    if dim == 1:
        cell, cells = str(rng.choice(["bar2", "bar3"])), int(rng.integers(2, 12))
        return "bar", cell, f'{{ kind = "Interval", length = "{size:.6g} m", cells = {cells}, cell = "{cell}" }}', cells
    if dim == 2:
        cell = str(rng.choice(["tri3", "quad4", "tri6", "quad9"]))
        name = str(rng.choice(["Rectangle", "Disc", "Ring", "Hollow", "Open"]))
        wide = size * rng.uniform(0.2, 2.0)
        what = {
            "Rectangle": f'size = ["{wide:.6g} m", "{size:.6g} m"], cells = [{few + 1}, {few + 1}], '
            f'origin = ["{-0.5 * wide:.6g} m", 0]',
            "Disc": f'radius = "{size / 2:.6g} m", cells = {2 * few}',
            "Ring": f'inner = "{0.3 * size:.6g} m", outer = "{0.5 * size:.6g} m", cells = [{few}, {8 * few}]',
            "Hollow": f'inner = "{0.43 * size:.6g} m", outer = "{0.5 * size:.6g} m", cells = [2, 24]',
            "Open": f'inner = "{0.4 * size:.6g} m", outer = "{0.5 * size:.6g} m", cells = [2, 20], angle = "330 deg", '
            f'start = "{rng.uniform(0.0, 360.0):.4g} deg"',
        }[name]
        kind = "Ring" if name in ("Hollow", "Open") else name
        return name, cell, f'{{ kind = "{kind}", {what}, cell = "{cell}" }}', 2 * few
    cell = str(rng.choice(["tet4", "hex8", "hex8", "tet10", "hex27"]))
    high = cell in ("tet10", "hex27")
    name = "Bracket" if part else str(rng.choice(["Box", "Ball", "Cylinder"]))
    few = 1 if high else 2
    across = 4
    what = {
        "Box": f'size = ["{size:.6g} m", "{0.5 * size:.6g} m", "{size:.6g} m"], cells = [{few + 1}, 2, {few + 1}], '
        f'origin = ["{-0.5 * size:.6g} m", "{-0.25 * size:.6g} m", 0]',
        "Ball": f'radius = "{size / 2:.6g} m", cells = {across}',
        "Cylinder": f'radius = "{size / 2:.6g} m", height = "{size:.6g} m", cells = [{across}, {few}]',
        "Bracket": 'path = "scenarios/bracket.msh", unit = "mm"',
    }[name]
    if name == "Bracket":
        return name, "of the file", f'{{ kind = "MeshFile", {what} }}', 4
    return name, cell, f'{{ kind = "{name}", {what}, cell = "{cell}" }}', 2 * few


def _obstacle(rng: Rng, dim: int, size: float, density: float, material: str, bodies: int) -> tuple[str, str]:
    """Name and text of what the body falls on; its highest place is about zero, under the body.

    It is a tool if only one body is deformable, and a body if two are.
    """
    r = size * rng.uniform(0.3, 3.0)
    low = f'"{-r:.6g} m"'
    if dim == 1:
        return "half space", 'kind = "Tool"\nshape = { kind = "HalfSpace", point = 0, normal = 1 }'
    deep = f'["0 m", {low}]' if dim == 2 else f'["0 m", "0 m", {low}]'
    wide = ", ".join([f'"{-2 * size:.6g} m"'] * (dim - 1))
    plus = ", ".join([f'"{2 * size:.6g} m"'] * (dim - 1))
    kinds = ["half space", "ball", "block"] + (["roller", "torus", "STL"] if dim == 3 else [])
    name = "body" if bodies == 2 else str(rng.choice(kinds))
    if name == "body":
        support = rng.choice(["", '\nsupports = [{ on = "bottom" }]'])
        few = int(rng.integers(1, 4))
        start = ", ".join([f'"{-0.7 * size:.6g} m"'] * (dim - 1) + [f'"{-size:.6g} m"'])
        span = ", ".join([f'"{1.4 * size:.6g} m"'] * (dim - 1) + [f'"{size:.6g} m"'])
        kind, count = ("Rectangle", f"{few + 1}, {few + 1}") if dim == 2 else ("Box", "2, 2, 2")
        mesh = f'{{ kind = "{kind}", size = [{span}], cells = [{count}], origin = [{start}] }}'
        where = f'mesh = {mesh}\nmaterial = {material}\ndensity = "{density:.6g} kg/m^3"{support}'
        return name, f'kind = "Solid"\n{where}'
    shape = {
        "half space": f'kind = "HalfSpace", point = {[0] * dim}, normal = {[0.0] * (dim - 1) + [1.0]}',
        "ball": f'kind = "Sphere", centre = {deep}, radius = "{r:.6g} m"',
        "block": f'kind = "Block", low = [{wide}, {low}], high = [{plus}, "0 m"]',
        "roller": f'kind = "Roller", point = {deep}, axis = [{rng.normal():.3f}, 1, 0], radius = "{r:.6g} m"',
        "torus": f'kind = "Torus", centre = [0, 0, "{-0.3 * r:.6g} m"], axis = [0, 0, 1], radius = "{r:.6g} m", '
        f'tube = "{0.3 * r:.6g} m"',
        "STL": f'kind = "Surface", file = "scenarios/stamp.stl", scale = "{size / 10:.6g} m"',
    }[name]
    motion = 'motion = { kind = "Still" }'
    return name, f'kind = "Tool"\nshape = {{ {shape} }}\n{motion}'


def _velocity(rng: Rng, dim: int, speed: float) -> str:
    """Mostly downwards."""
    side = rng.normal(0.0, 0.4, dim - 1)
    return "[" + ", ".join([f'"{v:.6g} m/s"' for v in [*(speed * side), -speed]]) + "]"


def _place(rng: Rng, dim: int, gap: float, size: float) -> str:
    """Tilt and height."""
    if dim == 1:
        return f'place = {{ bottom = "{gap:.6g} m" }}'
    shift = ", ".join(f'"{v:.6g} m"' for v in [*rng.normal(0.0, 0.1 * size, dim - 1), 0.0])
    if rng.random() < 0.3:
        return f'place = {{ translation = [{shift}], bottom = "{gap:.6g} m" }}'
    axis = rng.normal(size=3).round(3).tolist() if dim == 3 else [0, 0, 1]
    angle = degrees(rng.uniform(0, np.pi)) if rng.random() < 0.7 else float(rng.choice([30, 45, 90]))
    turned = f'rotations = [{{ axis = {axis}, angle = "{angle:.6g} deg" }}]'
    return f'place = {{ {turned}, translation = [{shift}], bottom = "{gap:.6g} m" }}'


def _friction(rng: Rng) -> tuple[str, str]:
    """Name and text of a law of friction."""
    mu = float(np.round(rng.uniform(0.05, 0.8), 2))
    name = str(rng.choice(["Coulomb", "Coulomb", "StaticKinetic"]))
    if name == "Coulomb":
        return name, f'{{ kind = "Coulomb", mu = {mu} }}'
    return name, f'{{ kind = "StaticKinetic", mu_s = {mu}, mu_k = {round(0.6 * mu, 3)} }}'
