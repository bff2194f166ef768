"""Check of stored values against the type hints of the class that they are to become."""

from collections.abc import Mapping
from dataclasses import fields
from math import isnan
from types import NoneType, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

import numpy as np


def require_fields(kind: type, values: Mapping[str, Any], kinds: Mapping[str, type]) -> None:
    """Refuse values that do not fit the fields of a data class.

    Parameters
    ----------
    kind
        The data class.
    values
        Values by field.
    kinds
        Classes that a field with a protocol may hold.

    Raises
    ------
    ValueError
        With the class and the field.

    Examples
    --------
    >>> from softway.model.time_weight import EndPeaks
    >>> require_fields(EndPeaks, {"theta": "0.5"}, {})
    Traceback (most recent call last):
    ValueError: EndPeaks.theta: a str
    """
    names = {f.name for f in fields(kind)}
    if values.keys() != names:
        raise ValueError(f"{kind.__name__} has not the fields {', '.join(sorted(values.keys() ^ names))}")
    hints = get_type_hints(kind)
    for name, value in values.items():
        if not fits(value, hints[name], kinds):
            raise ValueError(f"{kind.__name__}.{name}: a {type(value).__name__}")


def fits(value: Any, hint: Any, kinds: Mapping[str, type]) -> bool:
    """True if a stored value has a type; the fields of classes were checked when they were made.

    Examples
    --------
    >>> fits(1, float, {}), fits(True, int, {}), fits((1, 2.5), tuple[int, ...], {}), fits(float("nan"), float, {})
    (True, False, False, False)
    """
    origin, args = get_origin(hint), get_args(hint)
    if origin in (Union, UnionType):
        return any(fits(value, option, kinds) for option in args)
    if origin is Literal:
        return isinstance(value, str) and value in args
    if origin is tuple:
        count = len(value) if args[-1:] == (...,) and isinstance(value, tuple) else len(args)
        return isinstance(value, tuple) and len(value) == count and all(fits(item, args[0], kinds) for item in value)
    if origin is not None and issubclass(origin, Mapping):
        return isinstance(value, Mapping) and all(fits(item, args[1], kinds) for item in value.values())
    if origin is np.ndarray:
        return isinstance(value, np.ndarray) and value.dtype == np.dtype(get_args(args[1])[0])
    if hint in (float, int):
        number = isinstance(value, (int, float) if hint is float else int) and not isinstance(value, bool)
        return number and not isnan(value)
    if getattr(hint, "_is_protocol", False):
        return type(value).__name__ in kinds
    return isinstance(value, NoneType if hint is None else hint)
