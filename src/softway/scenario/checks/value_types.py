"""Check that the parts of a scenario built in Python have the types of its type hints."""

import numbers
from collections.abc import Callable, Mapping
from dataclasses import is_dataclass
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

import numpy as np

from softway.bodies.setup.initial_fields import Uniform
from softway.errors import InputError
from softway.scenario.hints.type_hints import REGISTRIES, Hint, hints, inputs, is_mapping, is_tuple, kinds, members
from softway.scenario.hints.units_text import expected
from softway.scenario.text.reader import join

PLAIN = (str, bytes, numbers.Number, type(None), Mapping, type, tuple, list)
"""Types that never satisfy a protocol, such as that of a law or a solver."""
SHOWN = 60
"""Maximum number of characters of a value in an error message."""


def require(value: Any, hint: Any, where: str, outer: str | None = None) -> None:
    """Refuse a value that its type hint does not admit, and check the values inside it.

    Parameters
    ----------
    value
        Value to check.
    hint
        Type hint of the value, with its unit.
    where
        Path in the scenario.
    outer
        Unit of numbers without a unit of their own.

    Raises
    ------
    InputError
        With the path, the value and the expected type.

    Examples
    --------
    >>> from softway.bodies.elements.section import Bar
    >>> require(Bar(area=2.0), Bar, "section")
    >>> require("a bar", Bar, "section")
    Traceback (most recent call last):
    softway.errors.InputError: section: 'a bar' has the wrong type
      try: Bar
    """
    want = Hint.of(hint, outer)
    options = tuple(Hint.of(option, want.unit) for option in members(want.type))
    if any(option.type is Uniform for option in options) and _sampled(value):
        return
    fitting = [option for option in options if suits(value, option.type)]
    if not fitting:
        problem = f"{_short(value)} has the wrong type"
        raise InputError(where, problem, " or ".join(dict.fromkeys(_word(option) for option in options)))
    for found in fitting:
        try:
            _inside(value, found, where)
            break
        except InputError:
            if found is fitting[-1]:
                raise


def _inside(value: Any, found: Hint, where: str) -> None:
    """Check the values inside a value of the right type."""
    if isinstance(value, Mapping):
        for key, item in value.items():
            if not isinstance(key, str):
                raise InputError(where, f"{key!r} is not a name", "a text as a name")
            require(item, get_args(found.type)[1] if is_mapping(found.type) else Any, join(where, str(key)), found.unit)
    elif isinstance(value, tuple | list):
        _entries(value, found, where)
    elif is_dataclass(value) and type(value).__module__.startswith("softway."):
        types = _types(type(value))
        for key in inputs(type(value)):
            require(getattr(value, key), types.get(key, Any), join(where, key), found.unit)


def suits(value: Any, option: Any) -> bool:
    """True if a value has a given type; the values inside it are not checked.

    Examples
    --------
    >>> suits(3, float), suits("3 m", float), suits((1.0, 2.0), tuple[float, ...]), suits(2.5, int)
    (True, False, True, False)
    """
    origin = get_origin(option)
    if origin is Literal:
        return any(type(word) is type(value) and word == value for word in get_args(option))
    if option in (float, int):
        kind = numbers.Real if option is float else numbers.Integral
        return not isinstance(value, bool) and isinstance(value, kind) or _point(value, option)
    if is_tuple(option):
        return isinstance(value, tuple | list | np.ndarray)
    if origin is np.ndarray or option is np.ndarray:
        return isinstance(value, np.ndarray | tuple | list)
    if origin is Callable:
        return callable(value)
    if is_mapping(option):
        return isinstance(value, Mapping)
    if not isinstance(option, type):
        return True
    if getattr(option, "_is_protocol", False):
        return not isinstance(value, PLAIN)
    return isinstance(value, (str, Path) if option in (str, Path) else option)


def _entries(value: tuple[Any, ...] | list[Any], found: Hint, where: str) -> None:
    """Check each entry of a list against the type hint of a tuple."""
    args = get_args(found.type) if is_tuple(found.type) else ()
    if not args:
        return
    if args[-1] is Ellipsis:
        args = (args[0],) * len(value)
    if len(args) != len(value):
        raise InputError(where, f"{_short(value)} has {len(value)} entries", f"a tuple of {len(args)} entries")
    for k, (item, hint) in enumerate(zip(value, args, strict=True)):
        require(item, hint, f"{where}[{k}]", found.unit)


def _sampled(value: Any) -> bool:
    """True if a field is given by nodal values or by a function of the points; both are checked when it is sampled."""
    return isinstance(value, np.ndarray | tuple | list) or callable(value) and not isinstance(value, type)


def _types(cls: type) -> dict[str, Any]:
    """Type hints of a dataclass; empty if they contain names that exist only for type checkers."""
    try:
        return hints(cls)
    except (NameError, TypeError):
        return {}


def _point(value: Any, option: type) -> bool:
    """True if a value is a zero-dimensional array of a suitable number type."""
    return isinstance(value, np.ndarray) and value.ndim == 0 and np.issubdtype(value.dtype, np.dtype(option).type)


def _short(value: Any) -> str:
    """Python notation of a value, cut if it is long."""
    text = " ".join(repr(value).split())
    return text if len(text) <= SHOWN else f"{text[:SHOWN]} ..."


def _word(option: Hint) -> str:
    """Name of a type for a remedy."""
    kind, origin = option.type, get_origin(option.type)
    if kind is float:
        return f"{expected(option.unit or '')} as a number without quotes"
    if origin is Literal:
        return " or ".join(repr(word) for word in get_args(kind))
    if kind in REGISTRIES:
        return f"{', '.join(kinds((kind,)))}, or a law of your own"
    if is_tuple(kind):
        inner = [Hint.of(arg, option.unit) for arg in get_args(kind) if arg is not Ellipsis]
        names = " or ".join(dict.fromkeys(_word(Hint(m, h.unit)) for h in inner for m in members(h.type)))
        return f"a tuple of {names}"
    words: Mapping[Any, str] = {int: "a whole number", bool: "True or False", str: "text", Path: "a path"}
    return words.get(kind) or getattr(kind, "__name__", None) or str(kind)
