"""Damaged inputs by their number: scenarios, mesh files and command lines with bytes, numbers and parts changed."""

import copy
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

Rng = np.random.Generator
ROOT = Path(__file__).parents[3]
ODD: tuple[Any, ...] = (
    0, -1, 1, 2, 3, 10**12, 2**63, -(2**70), 1e308, -1e-308, 1e-30, float("nan"), float("inf"), True, False, "", " ",
    "1", "1 m", "-5 mm", "nan m", "1e400 m", "3 kg", "5 furlong", "210 GPa", "1 m/s", "1 m^0.5", "degC", "1 / 0",
    "auto", "left", "all", "x", "os:system", "os.path:join", "builtins:eval", "../x:y", "a:b.c", "/etc/passwd",
    "/dev/zero", "/proc/self/mem", "\x00", "ä", "kind", "HalfSpace", "Solid", "Tool", "NeoHookean", "Energy", "Fixed",
    "MeshFile", [], {}, [[]], [0], [0, 0], [0, 0, 1], [1, 2, 3, 4], [float("nan")] * 3, ["a"], [{}], {"kind": "Off"},
    {"kind": 3}, {"kind": "Box", "size": [1, 1, 1], "cells": [10**5, 10**5, 10**5]},
    {"kind": "MeshFile", "path": "/dev/zero"}, {"kind": "Surface", "file": "fifo.stl"}, {"a": {"b": {"c": []}}},
    "x" * 5000,
)  # fmt: skip
"""Values to put where others are expected."""
NUMBERS = (
    b"0",
    b"-1",
    b"1e999",
    b"nan",
    b"99999999999",
    b"4294967295",
    b"-9223372036854775808",
    b"x",
    b"",
    b"1.5",
    b"7",
)
VERBS = ("check", "run", "show", "plot", "new", "race", "materials", "check-law")
WORDS = (
    *VERBS,
    "",
    "steel S235",
    "ä=\x7f",
    "fly",
    "--help",
    "--version",
    "--set",
    "--out",
    "--quiet",
    "-q",
    "--overwrite",
    "--allow-python",
    "--list",
    "--slabs",
    "--tolerance",
    "--methods",
    "newton",
    "penalty",
    "a.toml",
    "none.toml",
    "/dev/null",
    "/etc/passwd",
    ".",
    "..",
    "-",
    "--",
    "time.end=1",
    "time.end",
    "=",
    "a=b",
    "bodies.bar.mesh.cells=1000000000000",
    "bodies[0]=1",
    "contacts[99].timing=Paper",
    "time..end=1",
    "[0]=1",
    "bar",
    "0",
    "-1",
    "1e9",
    "nan",
    "os:system",
    "math:pi",
    "NeoHookean",
    "friction.Coulomb",
    "glass",
    "E=1",
    "nu=7",
    "bodies.bar.velocity=nan",
    "solver.tolerance=1e-300",
    "time.step=1e-300",
    "output.fields_every=0",
    "--set=time.end=-1",
)
"""Words of command lines, the verbs first."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Damaged:
    """What a folder holds, file by file, the command over it, and the family that it belongs to."""

    number: int
    family: str
    files: dict[str, bytes]
    command: tuple[str, ...]


def sources() -> dict[str, bytes]:
    """Scenarios and templates to start from, those whose meshes are small."""
    named = [
        *sorted((ROOT / "scenarios").glob("*.toml")),
        *sorted((ROOT / "src").glob("softway/scenario/text/templates/*.toml")),
    ]
    return {
        p.name: p.read_bytes() for p in named if p.name not in ("ball_impact.toml", "bracket_drop.toml", "part.toml")
    }


def meshes() -> dict[str, bytes]:
    """Small mesh files of each format."""
    folder = Path(__file__).parent / "meshes"
    return {p.name: p.read_bytes() for p in sorted(folder.iterdir())}


def damaged(number: int) -> Damaged:
    """The input of a number.

    Examples
    --------
    >>> damaged(7) == damaged(7)
    True
    """
    rng = np.random.default_rng([7, number])
    family = ("structure", "bytes", "mesh", "structure", "command")[number % 5]
    if family == "mesh":
        return _mesh(number, rng)
    names = sources()
    name = sorted(names)[rng.integers(len(names))] if family != "command" else "bar.toml"
    files = {"stamp.stl": (ROOT / "scenarios" / "stamp.stl").read_bytes(), "a.toml": names[name]}
    if family == "command":
        words = [str(w) for w in rng.choice(WORDS, rng.integers(1, 7))]
        first = [str(rng.choice(VERBS))] if rng.random() < 0.8 else []
        return Damaged(number=number, family=family, files=files, command=(*first, *words))
    files["a.toml"] = structure(names[name], rng) if family == "structure" else scrambled(names[name], rng)
    return Damaged(number=number, family=family, files=files, command=("check", "a.toml"))


def _mesh(number: int, rng: Rng) -> Damaged:
    """A mesh file with damage, as a body or as the surface of a tool."""
    known = meshes()
    name = sorted(known)[rng.integers(len(known))]
    body = 'mesh = { kind = "Box", size = [1, 1, 1], cells = [1, 1, 1] }'
    shape = 'shape = { kind = "HalfSpace", point = [0, 0, -9], normal = [0, 0, 1] }'
    if name.endswith((".msh", ".inp")) and rng.random() < 0.7:
        body = f'mesh = {{ kind = "MeshFile", path = "{name}" }}'
    else:
        shape = f'shape = {{ kind = "Surface", file = "{name}", smooth = {str(rng.random() < 0.2).lower()} }}'
    text = f"""[bodies.a]
kind = "Solid"
{body}
material = {{ kind = "NeoHookean", E = 1, nu = 0.3 }}
density = 1
place = {{ bottom = "40 m" }}
[bodies.b]
kind = "Tool"
{shape}
[[contacts]]
between = ["a", "b"]
timing = "Impulse"
[time]
end = 1
"""
    files = {name: scrambled(known[name], rng), "a.toml": text.encode()}
    return Damaged(number=number, family="mesh", files=files, command=("check", "a.toml"))


def structure(text: bytes, rng: Rng) -> bytes:
    """The scenario with some of its values, keys and entries changed."""
    data = copy.deepcopy(tomllib.loads(text.decode()))
    for _ in range(rng.integers(1, 4)):
        places = list(_places(data))
        holder, key = places[rng.integers(len(places))]
        match rng.integers(6):
            case 0 if isinstance(holder, dict):
                holder[str(rng.choice(["kind", "x", "bar", "mesh", "ä", "E", "on"]))] = holder.pop(key)
            case 1:
                del holder[key]
            case 2:
                other, found = places[rng.integers(len(places))]
                holder[key] = copy.deepcopy(other[found])
            case 3 if isinstance(holder[key], list):
                holder[key] = holder[key] * int(rng.choice([0, 2, 50]))
            case _:
                holder[key] = copy.deepcopy(ODD[rng.integers(len(ODD))])
    return tomli_w.dumps(data).encode(errors="surrogatepass")


def _places(data: Any) -> Any:
    """Every table or list with a key or position in it."""
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in list(items):
        yield data, key
        yield from _places(value)


def scrambled(text: bytes, rng: Rng) -> bytes:
    """The bytes with some of them changed, lost, doubled, numbers replaced, or the end cut off."""
    out = bytearray(text)
    for _ in range(rng.integers(1, 6)):
        if not out:
            break
        a = int(rng.integers(len(out)))
        b = min(len(out), a + int(rng.integers(1, 40)))
        match rng.integers(6):
            case 0:
                out[a] = int(rng.integers(256))
            case 1:
                del out[a:b]
            case 2:
                out[a:a] = out[a:b] * int(rng.integers(1, 5))
            case 3:
                del out[a:]
            case _:
                found = list(re.finditer(rb"-?\d+\.?\d*(?:[eE][-+]?\d+)?", bytes(out)))
                if found:
                    one = found[rng.integers(len(found))]
                    out[one.start() : one.end()] = NUMBERS[rng.integers(len(NUMBERS))]
    return bytes(out)
