"""Analysis of type hints for scenarios: kinds of a union, unit of a number."""

import collections.abc
import difflib
import importlib
import types
from collections.abc import Iterable, Mapping
from dataclasses import MISSING, Field, dataclass, fields, is_dataclass
from typing import Annotated, Any, Union, get_args, get_origin, get_type_hints

import numpy as np

from softway.contact.impact_rule import ImpactRule
from softway.laws.friction_law import FrictionLaw
from softway.laws.law import RateLaw, StoredEnergy

REGISTRIES: Mapping[type, str] = {
    StoredEnergy: "softway.laws.bulk",
    RateLaw: "softway.laws.bulk",
    FrictionLaw: "softway.laws.friction",
    ImpactRule: "softway.contact.impact_rule",
}
USUAL: Mapping[str, tuple[str, ...]] = {
    "end": ("until", "duration", "stop", "t_end", "tend", "tmax", "total"),
    "step": ("dt", "timestep", "time_step", "increment"),
    "E": ("young", "youngs_modulus", "young_modulus", "elastic_modulus", "modulus"),
    "nu": ("poisson", "poisson_ratio", "poissons_ratio"),
    "density": ("rho",),
}
"""Keys, and words for the same in other programs."""


@dataclass(frozen=True, slots=True)
class Hint:
    """Type hint without its unit, and the unit of bare numbers in it.

    Examples
    --------
    >>> Hint.of(Annotated[float, "m"], None)
    Hint(type=<class 'float'>, unit='m')
    """

    type: Any
    unit: str | None

    @classmethod
    def of(cls, hint: Any, outer: str | None) -> "Hint":
        """Separate the unit from a hint; ``outer`` is the unit if the hint has none, and replaces ``*`` in its unit."""
        if get_origin(hint) is not Annotated:
            return cls(hint, outer)
        kind, unit = get_args(hint)[:2]
        return cls(kind, combined(unit, outer) if isinstance(unit, str) else outer)


def combined(unit: str, outer: str | None) -> str:
    """Replace ``*`` in a unit by the unit of the surrounding quantity.

    Examples
    --------
    >>> combined("*/m", "m/s"), combined("*/m", "m"), combined("*/s", None), combined("Pa", "m")
    ('1/s', '', '', 'Pa')
    """
    if "*" not in unit:
        return unit
    if outer is None:
        return ""
    return {"m": {"*/m": ""}, "m/s": {"*/m": "1/s"}}.get(outer, {}).get(unit, unit.replace("*", outer))


def members(hint: Any) -> tuple[Any, ...]:
    """Alternatives of a union as a flat tuple; for other hints the hint itself.

    Examples
    --------
    >>> members(int | str)
    (<class 'int'>, <class 'str'>)
    """
    if get_origin(hint) in (Union, types.UnionType):
        return tuple(m for part in get_args(hint) for m in members(part))
    return (hint,)


def hints(cls: type) -> dict[str, Any]:
    """Type hints of a dataclass with units."""
    return get_type_hints(cls, include_extras=True)


def inputs(cls: type) -> dict[str, Field[Any]]:
    """Fields that the constructor of a dataclass takes, by name."""
    return {f.name: f for f in fields(cls) if f.init}


def required(field: Field[Any]) -> bool:
    """True if a field has no default."""
    return field.default is MISSING and field.default_factory is MISSING


def kinds(options: Iterable[Any]) -> dict[str, type]:
    """Dataclasses among the alternatives that a text can describe, by name.

    A protocol stands for all dataclasses that its package exports.
    """
    found: dict[str, type] = {}
    for option in options:
        option = Hint.of(option, None).type
        if option in REGISTRIES:
            found.update(_exported(REGISTRIES[option]))
        elif isinstance(option, type) and is_dataclass(option) and not _holds_arrays(option):
            found[option.__name__] = option
    return found


def open_protocols(options: Iterable[Any]) -> tuple[type, ...]:
    """Protocols among the alternatives; a user-defined class with the members of one of them is admitted, too."""
    return tuple(o for o in (Hint.of(option, None).type for option in options) if o in REGISTRIES)


def nearest(word: str, known: Iterable[str]) -> str:
    """Remedy for an unknown word: a known word for the same, or the closest one, then all known words.

    Examples
    --------
    >>> nearest("nuu", ["E", "nu"])
    "did you mean 'nu'? known: E, nu"
    >>> nearest("until", ["control", "end"])
    "did you mean 'end'? known: control, end"
    """
    words = list(known)
    same = [w for w in words if word.lower() in USUAL.get(w, ())]
    near = difflib.get_close_matches(word, words, n=1, cutoff=0.5)
    close = same or near or [w for w in words if w.lower() == word.lower()]
    guess = f"did you mean {close[0]!r}? " if close else ""
    return f"{guess}known: {', '.join(words) or 'none'}"


def holder(word: str, known: Mapping[str, type]) -> str:
    """Remedy for a kind that belongs into a field of a ``known`` one: which; empty if there is none.

    Examples
    --------
    >>> from softway.bodies.solid import Tool
    >>> holder("HalfSpace", {"Tool": Tool}), holder("Ball", {"Tool": Tool})
    ('kind = "Tool" with shape = { kind = "HalfSpace", ... }', '')
    """
    for name, cls in known.items():
        for key in inputs(cls):
            if word in kinds(members(Hint.of(hints(cls)[key], None).type)):
                return f'kind = "{name}" with {key} = {{ kind = "{word}", ... }}'
    return ""


def is_tuple(hint: Any) -> bool:
    """True if the hint is a tuple."""
    return get_origin(hint) is tuple or hint is tuple


def is_mapping(hint: Any) -> bool:
    """True if the hint is a mapping."""
    return get_origin(hint) in (dict, Mapping, collections.abc.Mapping)


def _exported(package: str) -> dict[str, type]:
    """Dataclasses that a package exports."""
    module = importlib.import_module(package)
    names = getattr(module, "__all__", None) or [n for n in vars(module) if not n.startswith("_")]
    found = {n: getattr(module, n) for n in names}
    return {n: c for n, c in found.items() if isinstance(c, type) and is_dataclass(c)}


def _holds_arrays(cls: type) -> bool:
    """True if a field without default is an array; then no text can describe the class."""
    known = hints(cls)
    needed = [Hint.of(known[n], None).type for n, f in inputs(cls).items() if required(f)]
    inner = [get_args(h)[1] if is_mapping(h) else h for h in needed]
    return any(get_origin(h) is np.ndarray for h in inner)
