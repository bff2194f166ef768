"""Conversion of dataclasses to plain TOML data, with all defaults written out and numbers with their units."""

import math
from collections.abc import Mapping
from dataclasses import is_dataclass
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

import numpy as np

from softway.errors import InputError
from softway.scenario.hints.type_hints import Hint, hints, inputs, is_mapping, is_tuple, kinds, members, open_protocols
from softway.scenario.text.reader import join


def write(value: Any, hint: Any, where: str, outer: str | None = None) -> Any:
    """TOML value from which :class:`~softway.scenario.text.reader.Reader` can rebuild ``value``.

    Parameters
    ----------
    value
        Value to write.
    hint
        Type hint of the value, with its unit.
    where
        Path in the scenario for error messages.
    outer
        Unit of numbers without a unit of their own.

    Examples
    --------
    >>> from softway.bodies.elements.section import Bar
    >>> write(Bar(area=2.0), Bar, "section")
    {'area': '2.0 m^2'}
    """
    want = Hint.of(hint, outer)
    options = members(want.type)
    if is_dataclass(value) and not isinstance(value, type):
        return _object(value, options, where, want.unit)
    if isinstance(value, Mapping):
        inner = next((get_args(o)[1] for o in options if is_mapping(o)), Any)
        return {k: write(v, inner, join(where, str(k)), want.unit) for k, v in value.items()}
    if isinstance(value, tuple | list):
        return _entries(value, options, where, want.unit)
    return _scalar(value, options, where, want.unit)


def _object(value: Any, options: tuple[Any, ...], where: str, unit: str | None) -> dict[str, Any]:
    """Write a table; its kind is included if more than one is admitted."""
    cls = type(value)
    known = kinds(options)
    out: dict[str, Any] = {}
    if cls.__name__ in known and known[cls.__name__] is cls:
        if len(options) > 1 or open_protocols(options):
            out["kind"] = cls.__name__
    elif open_protocols(options):
        out["kind"] = f"{cls.__module__}:{cls.__name__}"
    else:
        remedy = f"one of: {', '.join(known)}" if known else "use this scenario from Python only"
        raise InputError(where, f"a {cls.__name__} built in Python has no text form", remedy)
    types = hints(cls)
    for key in inputs(cls):
        item = getattr(value, key)
        if item is not None:
            out[key] = write(item, types[key], join(where, key), unit)
    return out


def _entries(value: tuple[Any, ...] | list[Any], options: tuple[Any, ...], where: str, unit: str | None) -> list[Any]:
    """Write a list; each entry has its own hint if the tuple has one for each."""
    fitting = [get_args(h.type) for h in (Hint.of(o, unit) for o in options) if is_tuple(h.type)]
    args = next((a for a in fitting if a[-1] is Ellipsis or len(a) == len(value)), (Any, ...))
    each = (args[0],) * len(value) if args[-1] is Ellipsis else args
    return [write(v, a, f"{where}[{k}]", unit) for k, (v, a) in enumerate(zip(value, each, strict=True))]


def _scalar(value: Any, options: tuple[Any, ...], where: str, unit: str | None) -> Any:
    """Write a number with its unit, or a word."""
    if isinstance(value, bool | np.bool_):
        return bool(value)
    if isinstance(value, str | Path):
        return str(value)
    inner = [Hint.of(o, unit) for o in options]
    if isinstance(value, int | np.integer) and any(h.type is int for h in inner):
        return int(value)
    if isinstance(value, int | np.integer) and any(get_origin(h.type) is Literal for h in inner):
        return int(value)
    if not isinstance(value, int | float | np.number):
        problem = f"a {type(value).__name__} given in Python has no text form"
        raise InputError(where, problem, "use this scenario from Python only")
    number = float(value)
    if not math.isfinite(number):
        raise InputError(where, f"{number!r} is not finite", "a finite number")
    found = next((h.unit for h in inner if h.type is float), unit)
    return f"{number!r} {found}" if found else number
