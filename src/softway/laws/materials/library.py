"""Material library of softway, read from files of constants with their sources."""

import difflib
import tomllib
from collections.abc import Iterator, Mapping
from importlib import resources
from typing import Any

from softway.errors import InputError
from softway.laws.materials.material import Isotropic, Material, Orthotropic, Rubber, Strength, ThermalConstants

_FILES = ("metals", "others")


def names() -> tuple[str, ...]:
    """Names of all materials.

    Examples
    --------
    >>> "steel S235" in names()
    True
    """
    return tuple(m.name for m in everything())


def find(name: str) -> Material:
    """Material with a given name or alias; upper and lower case are equivalent.

    Raises
    ------
    InputError
        If no material has this name.

    Examples
    --------
    >>> find("Steel s235").density
    7850.0
    """
    wanted, known = name.strip().casefold(), tuple(everything())
    for material in known:
        if wanted in [word.casefold() for word in (material.name, *material.aliases)]:
            return material
    words = {word.casefold(): m.name for m in known for word in (m.name, *m.aliases)}
    near = difflib.get_close_matches(wanted, words, n=1, cutoff=0.5)
    guess = f"did you mean {words[near[0]]!r}? " if near else ""
    raise InputError("material", f"{name!r} is not a material of the library", f"{guess}known: {', '.join(names())}")


def everything() -> Iterator[Material]:
    """All materials in the order of their files."""
    for file in _FILES:
        text = (resources.files("softway.laws.materials") / "data" / f"{file}.toml").read_text(encoding="utf-8")
        for name, data in tomllib.loads(text).items():
            yield _material(name, data)


def _material(name: str, data: Mapping[str, Any]) -> Material:
    """Make a material from its table; every key belongs to one of the dataclasses."""
    rest = dict(data)
    moduli = {key: rest.pop(key) for key in ("E", "nu", "G", "c10", "c01", "bulk") if key in rest}
    plain: dict[str, Any] = {key: tuple(v) if isinstance(v, list) else v for key, v in moduli.items()}
    kind = Rubber if "c10" in plain else Orthotropic if "G" in plain else Isotropic
    parts: dict[str, Any] = {"moduli": kind(**plain)}
    if "strength" in rest:
        parts["strength"] = Strength(**rest.pop("strength"))
    if "thermal" in rest:
        parts["thermal"] = ThermalConstants(**rest.pop("thermal"))
    return Material(name=name, aliases=tuple(rest.pop("aliases", ())), **parts, **rest)
