"""JSON schema of a scenario for editors, derived from the same type hints as the reader."""

import re
from collections.abc import Callable
from dataclasses import MISSING, dataclass, field, is_dataclass
from pathlib import Path
from types import NoneType
from typing import Any, Literal, get_args, get_origin

from softway.bodies.conductor import Conductor, Thermal
from softway.bodies.solid import Solid
from softway.errors import InputError
from softway.laws.heat.conduction import Conduction
from softway.laws.law import Material as Law
from softway.laws.materials.material import LawName
from softway.scenario.hints.docstrings import described
from softway.scenario.hints.type_hints import (
    Hint,
    hints,
    inputs,
    is_mapping,
    is_tuple,
    kinds,
    members,
    open_protocols,
    required,
)
from softway.scenario.hints.units_text import expected
from softway.scenario.scenario import Scenario
from softway.scenario.text import copies
from softway.scenario.text.writer import write

DIALECT = "https://json-schema.org/draft/2020-12/schema"
Schema = dict[str, Any]
PLAIN: dict[Any, str] = {int: "integer", bool: "boolean", str: "string", Path: "string"}


def schema() -> Schema:
    """JSON schema that admits every correct scenario and refuses unknown keys; only the reader checks the values.

    Examples
    --------
    >>> sorted(schema()["$defs"]["scenario.scenario.Time"]["properties"])
    ['control', 'end', 'kind', 'step', 'tolerance', 'weight']
    """
    making = _Making()
    whole = making.of(Scenario, None)
    return {"$schema": DIALECT, "title": "softway scenario", **whole, "$defs": making.found}


@dataclass(frozen=True, slots=True)
class _Making:
    """Definitions of the classes found so far, by name."""

    found: dict[str, Schema] = field(default_factory=dict)

    def of(self, hint: Any, outer: str | None) -> Schema:
        """Schema of a type hint; ``outer`` is the unit of numbers without a unit of their own."""
        want = Hint.of(hint, outer)
        options = members(want.type)
        if len(options) > 1 or kinds(options) and not is_dataclass(want.type):
            return self._union(options, want.unit)
        if isinstance(want.type, type) and is_dataclass(want.type):
            return self._reference(want.type, want.unit)
        if is_tuple(want.type):
            return self._list(get_args(want.type), want.unit)
        if is_mapping(want.type):
            return {"type": "object", "additionalProperties": self.of(get_args(want.type)[1], want.unit)}
        return _scalar(want)

    def _union(self, options: tuple[Any, ...], unit: str | None) -> Schema:
        """Schema of a union: kinds as ``oneOf``, names of kinds, tables without a kind, and plain values."""
        known, own = kinds(options), open_protocols(options)
        objects = {name: self._reference(cls, unit) for name, cls in known.items()}
        named = [{"allOf": [of], "required": ["kind"]} for of in objects.values()]
        others: list[Schema] = [{"oneOf": named}] if named else []
        others += [{"enum": list(known)}] if known else []
        others += [] if own else list(objects.values())
        others += [_OWN] if own else []
        others += _LIBRARY if set(options) >= set(members(Law)) else []
        others += _CONDUCTION if Conduction in options else []
        others += [self.of(o, unit) for o in options if o is not NoneType and not _table(o)]
        lone = [(cls, key) for cls in known.values() for key in inputs(cls) if len(inputs(cls)) == 1]
        others += [self.of(hints(cls)[key], unit) for cls, key in lone]
        return {"anyOf": list({repr(other): other for other in others}.values())}

    def _reference(self, cls: type, unit: str | None) -> Schema:
        name = ".".join((*cls.__module__.split(".")[-2:], cls.__name__))
        name += "." + re.sub(r"\W+", "_", unit) if unit else ""
        if name not in self.found:
            self.found[name] = {}
            self.found[name].update(self._object(cls, unit))
        return {"$ref": f"#/$defs/{name}"}

    def _object(self, cls: type, unit: str | None) -> Schema:
        """Schema of a table: every key is a field of the class, or ``kind``."""
        known, types, told = inputs(cls), hints(cls), described(cls)
        needed = [k for k, f in known.items() if required(f) and (cls, k) not in _OF_LIBRARY]
        properties: Schema = {} if "kind" in known else {"kind": {"const": cls.__name__}}
        for key, of in known.items():
            inner = self.of(types[key], unit)
            words = [told.fields.get(key, ""), _described(inner)]
            properties[key] = {
                **inner,
                "description": "; ".join(w for w in words if w),
                **_default(of, types[key], unit),
            }
        if cls is Solid:
            properties["copies"] = _copies(properties)
        return {
            "type": "object",
            "description": told.summary,
            "properties": properties,
            "required": needed,
            "additionalProperties": False,
        }

    def _list(self, args: tuple[Any, ...], unit: str | None) -> Schema:
        """Schema of a list; in a list of numbers a single number stands for a vector with one entry."""
        size = {} if args[-1] is Ellipsis else {"minItems": len(args), "maxItems": len(args)}
        entry = self.of(args[0], unit)
        several = {"type": "array", "items": entry, **size}
        return {"anyOf": [several, entry]} if Hint.of(args[0], None).type is float else several


def _copies(solid: Schema) -> Schema:
    """Schema of the copies of a solid with these properties."""
    place = {
        "type": "object",
        "properties": {**solid, "at": _LENGTHS},
        "required": ["at"],
        "additionalProperties": False,
    }
    lattice = {
        "type": "object",
        "properties": {"count": {"type": "array", "items": {"type": "integer"}}, "spacing": _LENGTHS},
        "required": ["count", "spacing"],
        "additionalProperties": False,
    }
    places = {"type": "array", "items": {"anyOf": [_LENGTHS, place]}}
    return {"description": copies.MEANING, "anyOf": [places, lattice]}


def _described(inner: Schema) -> str:
    """Description of a value; of its number where a table of numbers may stand instead."""
    options = inner.get("anyOf", [])
    lone = options[0] if len(options) == 2 and options[1].get("additionalProperties") == options[0] else inner
    return str(lone.get("description", ""))


def _scalar(want: Hint) -> Schema:
    """Schema of a number, text, truth value or word of a fixed list; values that only Python can give are refused."""
    if want.type is float:
        return {"type": ["number", "string"], "description": expected(want.unit or "") if want.unit else "a number"}
    if get_origin(want.type) is Literal:
        return {"enum": list(get_args(want.type))}
    if get_origin(want.type) is Callable:
        return {"type": "string", "pattern": ":", "description": "module:name"}
    return {"type": PLAIN[want.type]} if want.type in PLAIN else {"not": {}, "description": "only from Python"}


def _table(option: Any) -> bool:
    """True if an alternative is a kind, or a class that no text can describe."""
    kind = Hint.of(option, None).type
    return bool(kinds([option])) or (isinstance(kind, type) and is_dataclass(kind))


def _default(of: Any, hint: Any, unit: str | None) -> Schema:
    """Default of a field in the notation of a scenario file."""
    value = of.default_factory() if of.default_factory is not MISSING else of.default
    if value is MISSING or value is None:
        return {}
    try:
        return {"default": write(value, hint, "", unit)}
    except InputError:
        return {}


_OWN: Schema = {
    "type": "object",
    "description": "a user-defined class: kind = module:Class",
    "properties": {"kind": {"type": "string", "pattern": ":"}},
    "required": ["kind"],
}
_OF_LIBRARY = ((Solid, "density"), (Conductor, "density"), (Thermal, "law"))
"""Keys that a library material gives."""
_LENGTHS: Schema = {"type": "array", "items": {"type": ["number", "string"], "description": expected("m")}}
_LIBRARY: list[Schema] = [
    {"type": "string", "description": "a library material, see softway materials"},
    {
        "type": "object",
        "description": "a law of a library material",
        "properties": {"library": {"type": "string"}, "law": {"enum": list(get_args(LawName))}},
        "required": ["library"],
    },
]
_CONDUCTION: list[Schema] = [
    {"type": "string", "description": "a library material, see softway materials"},
    {
        "type": "object",
        "description": "conduction of a library material",
        "properties": {"library": {"type": "string"}, "latent": {"type": ["boolean", "object"]}},
        "required": ["library"],
    },
]
