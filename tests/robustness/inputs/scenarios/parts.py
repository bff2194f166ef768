"""Valid parts of scenarios drawn from the type hints of the reader: any kind, with plausible numbers and names."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, is_dataclass
from pathlib import Path
from types import NoneType
from typing import Any, Literal, Self, get_args, get_origin

import numpy as np

from softway.meshes.cells import CELLS
from softway.scenario.hints.type_hints import (
    Hint,
    hints,
    inputs,
    is_mapping,
    is_tuple,
    kinds,
    members,
    required,
)

Rng = np.random.Generator
NUMBERS: Mapping[str, tuple[float, ...]] = {
    "m": (0.1, 0.5, 1.0, 1.0, 2.0, 0.05, -0.5),
    "Pa": (1.0, 10.0, 100.0, 100.0, 50.0),
    "s": (0.1, 0.5, 1.0, 0.01, 0.02),
    "kg/m^3": (1.0, 1.0, 2.0, 0.5),
    "m/s": (0.1, 1.0, -1.0, 0.0),
    "m/s^2": (0.1, -1.0, 1.0),
    "1/s": (0.1, 1.0, -0.1),
    "rad": (0.1, 1.0, 3.141592653589793, -0.5),
    "rad/s": (0.1, -1.0),
    "": (0.3, 0.3, 0.1, 0.2, 0.4, 1.0, 0.5),
}
"""Plausible numbers by unit, in scenes of the size 1, the stiffness 100 and the density 1."""
OTHER_UNITS = {"m": "mm", "Pa": "kPa", "s": "ms", "kg/m^3": "g/cm^3", "m/s": "km/h", "rad": "deg", "rad/s": "rpm"}
TAGS = ("bottom", "top", "left", "right", "all", "surface", "skin", "inner", "outer", "front")
OF_MESH = {
    "Interval": ("left", "right"),
    "Rectangle": ("bottom", "top", "left", "right"),
    "Box": ("bottom", "top", "left", "right", "front", "back"),
    "Ring": ("inner", "outer"),
    "Grid": ("bottom", "top", "left", "right"),
    "MeshFile": ("skin",),
}
"""Tags of the kinds of meshes."""
WORDS: Mapping[str, tuple[str, ...]] = {
    "components": ("x", "y", "xy", "all", "all", "yx", "z", "xx"),
    "axis": ("x", "y", "z"),
    "cell": tuple(CELLS),
    "path": ("v22.msh", "v41.msh", "binary.msh", "a.inp"),
    "file": ("ascii.stl", "binary.stl", "a.ply", "a.obj", "v22.msh", "a.vtu"),
    "unit": ("m", "mm"),
    "title": ("a title", "ä", "x" * 3000),
}
"""Texts by the key that they belong to."""
CELL = {
    1: ("bar2", "bar3"),
    2: ("tri3", "quad4", "tri6", "quad8", "quad9"),
    3: ("tet4", "hex8", "tet10", "hex20", "hex27"),
}
"""Cells that fill a space."""
MESHES = {
    1: ("Interval",),
    2: ("Rectangle", "Disc", "Ring", "GradedDisc", "Grid"),
    3: ("Box", "Cylinder", "Ball", "MeshFile"),
}
SHAPES = {1: ("HalfSpace",), 2: ("HalfSpace", "Sphere", "Block", "Cavity")}
"""Kinds of meshes and of tools that fit a dimension."""


@dataclass(frozen=True, slots=True)
class Names:
    """Names of the bodies of a scenario, and the tags of its solids.

    Parameters
    ----------
    bodies
        Names of all bodies.
    solids
        Tags of each solid.
    """

    bodies: tuple[str, ...]
    solids: Mapping[str, tuple[str, ...]]

    @classmethod
    def of(cls, data: Mapping[str, Any]) -> Self:
        """Names of a scenario."""
        bodies = data.get("bodies", {})
        bodies = bodies if isinstance(bodies, Mapping) else {}
        meshes = {n: b["mesh"] for n, b in bodies.items() if isinstance(b, Mapping) and "mesh" in b}
        kind = {n: m.get("kind", "") if isinstance(m, Mapping) else "" for n, m in meshes.items()}
        tags = {n: (*OF_MESH.get(str(k), ()), "all", "surface") for n, k in kind.items()}
        return cls(tuple(bodies) or ("none",), tags or {"none": ("all",)})

    def tag(self, rng: Rng) -> str:
        """A tag of a solid, or any."""
        return _one(rng, TAGS) if rng.random() < 0.1 else _one(rng, self.solids[_one(rng, list(self.solids))])

    def place(self, rng: Rng) -> str:
        """A solid with a tag of its own or another one, or a body alone."""
        if rng.random() < 0.25:
            return _one(rng, self.bodies)
        solid = _one(rng, list(self.solids))
        return f"{solid}.{_one(rng, self.solids[solid] if rng.random() < 0.9 else TAGS)}"


def drawn(key: str, hint: Any, unit: str | None, names: Names, rng: Rng, dim: int) -> Any:
    """A value in the notation of a scenario for a key with a type hint, in a scene of dimension ``dim``."""
    want = Hint.of(hint, unit)
    options = [o for o in members(want.type) if o is not NoneType]
    known = kinds(options)
    if known and not (len(options) == 1 and is_dataclass(options[0])):
        plain = [o for o in options if not kinds([o])]
        if plain and rng.random() < 0.3:
            return drawn(key, plain[rng.integers(len(plain))], want.unit, names, rng, dim)
        return table(known[_kind(key, list(known), rng, dim)], want.unit, names, rng, dim, kind=True)
    if len(options) > 1:
        return drawn(key, options[rng.integers(len(options))], want.unit, names, rng, dim)
    if not options:
        return None
    return _plain(key, Hint.of(options[0], want.unit), names, rng, dim)


def _kind(key: str, known: Sequence[str], rng: Rng, dim: int) -> str:
    """A kind, mostly one that fits the dimension."""
    fitting = {"mesh": MESHES, "shape": SHAPES}.get(key, {}).get(dim, known)
    return str(_one(rng, fitting if rng.random() < 0.9 else known))


def _plain(key: str, want: Hint, names: Names, rng: Rng, dim: int) -> Any:
    """A value for a hint that is no union."""
    if isinstance(want.type, type) and is_dataclass(want.type):
        return table(want.type, want.unit, names, rng, dim)
    if is_tuple(want.type):
        args = get_args(want.type)
        if args[-1] is not Ellipsis:
            return [drawn(key, a, want.unit, names, rng, dim) for a in args]
        inner = Hint.of(args[0], want.unit).type
        count = dim if inner is float or is_tuple(inner) else int(rng.integers(1, 3))
        made = [drawn(key, args[0], want.unit, names, rng, dim) for _ in range(count)]
        if key in ("times", "at", "x", "y", "z") and inner is float and rng.random() < 0.95:
            start = [0.0] if key != "at" or rng.random() < 0.5 else []
            return start + sorted({_size(entry) for entry in made} - {0.0})
        return made
    if is_mapping(want.type):
        return {_one(rng, TAGS): drawn(key, get_args(want.type)[1], want.unit, names, rng, dim)}
    return _scalar(key, want, names, rng, dim)


def _scalar(key: str, want: Hint, names: Names, rng: Rng, dim: int) -> Any:
    """A number, text, truth value or word."""
    if get_origin(want.type) is Literal:
        return _one(rng, list(get_args(want.type)))
    if want.type is float:
        return number(want.unit or "", rng)
    if want.type is int:
        return int(rng.choice([1, 2, 2, 4, 4, 6, 3, 8]))
    if want.type is bool:
        return bool(rng.random() < 0.5)
    if get_origin(want.type) is Callable:
        return "module:name"
    if want.type in (str, Path):
        return _text(key, names, rng, dim)
    return "?"


def _text(key: str, names: Names, rng: Rng, dim: int) -> str:
    if key in ("tag", "on", "only"):
        return names.tag(rng)
    if key == "of":
        return _one(rng, list(names.solids) if rng.random() < 0.9 else names.bodies)
    if key == "cell" and rng.random() < 0.9:
        return _one(rng, CELL[dim])
    if key == "between":
        return names.place(rng)
    if key == "cells":
        return _one(rng, WORDS["cell"])
    return _one(rng, WORDS.get(key, ("a", "b", "name with blanks", "ä")))


def number(unit: str, rng: Rng) -> float | str:
    """A plausible number with its unit, with another unit of its kind, or without any."""
    value = float(rng.choice(NUMBERS.get(unit, (0.1, 1.0))))
    if not unit or rng.random() < 0.4:
        return value
    other = OTHER_UNITS.get(unit)
    return f"{value} {other}" if other and rng.random() < 0.1 else f"{value} {unit}"


def table(cls: type, unit: str | None, names: Names, rng: Rng, dim: int, *, kind: bool = False) -> dict[str, Any]:
    """A table for a class: its required keys, and some of the others."""
    made: dict[str, Any] = {"kind": cls.__name__} if kind else {}
    types = hints(cls)
    for key, field in inputs(cls).items():
        if required(field) or rng.random() < 0.25:
            made[key] = drawn(key, types[key], unit, names, rng, dim)
    if "on" in made and cls.__name__ == "Traction":
        made["on"] = names.place(rng)
    return _fitted({key: value for key, value in made.items() if value is not None}, rng)


def _fitted(made: dict[str, Any], rng: Rng) -> dict[str, Any]:
    """The table with lists of one length where they belong together, mostly."""
    for key, other in (("times", "factors"), ("times", "shares"), ("times", "displacements"), ("at", "values")):
        if isinstance(made.get(key), list) and isinstance(made.get(other), list) and rng.random() < 0.95:
            count = len(made[key])
            made[other] = [made[other][k % len(made[other])] for k in range(count)]
    if isinstance(made.get("velocity"), list) and "on" in made and rng.random() < 0.95:
        made["velocity"] = (made["velocity"] * 9)[: len(made.get("times", [0]))]
    return made


def tables(value: Any, hint: Any, unit: str | None = None) -> list[tuple[dict[str, Any], type, str | None]]:
    """Every table of a scenario with its class and the unit of its numbers."""
    want = Hint.of(hint, unit)
    options = [o for o in members(want.type) if o is not NoneType]
    if isinstance(value, list):
        inner = [get_args(o)[0] for o in options if is_tuple(o) and get_args(o)]
        return [t for entry in value for h in inner[:1] for t in tables(entry, h, want.unit)]
    if not isinstance(value, dict):
        return []
    cls = _class(value, options)
    found: list[tuple[dict[str, Any], type, str | None]] = []
    if cls is not None:
        found.append((value, cls, want.unit))
        types = hints(cls)
        for key in [k for k in value if k in types]:
            found += tables(value[key], types[key], want.unit)
    for option in options:
        if is_mapping(option):
            for entry in value.values():
                found += tables(entry, get_args(option)[1], want.unit)
    return found


def _class(value: Mapping[str, Any], options: Sequence[Any]) -> type | None:
    """Class that a table describes."""
    known = kinds(options)
    if str(value.get("kind")) in known:
        return known[str(value["kind"])]
    if len(options) == 1 and is_dataclass(options[0]):
        return options[0] if isinstance(options[0], type) else None
    return next(iter(known.values())) if len(known) == 1 else None


def _one(rng: Rng, words: Sequence[Any]) -> Any:
    return words[int(rng.integers(len(words)))]


def _size(value: Any) -> float:
    return float(str(value).partition(" ")[0])
