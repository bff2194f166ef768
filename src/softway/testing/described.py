"""Checks of the description of a law: units of its parameters, and its text in a scenario."""

from collections.abc import Mapping
from dataclasses import is_dataclass
from math import nan
from pathlib import Path
from typing import Any, get_args

from softway.errors import InputError
from softway.scenario.hints.type_hints import Hint, hints, inputs, is_mapping, is_tuple, members
from softway.scenario.hints.units_text import Units
from softway.scenario.text.reader import Reader, join
from softway.scenario.text.writer import write
from softway.testing.examination import Examination
from softway.testing.verdict import require


def _units(law: Any) -> float:
    if not is_dataclass(law):
        return nan
    units = Units.standard()
    for where, hint in _numbers(law, ""):
        require(hint.unit is not None, law, f"{where} is a number without unit: write {where}: Pascal, or Pure")
        try:
            units.number(f"1 {hint.unit}" if hint.unit else 1.0, hint.unit or "", where)
        except InputError as error:
            raise AssertionError(f"{law}: {error}") from None
    return 0.0


def _numbers(value: Any, where: str) -> list[tuple[str, Hint]]:
    """All numeric fields of a law and of its nested parts."""
    kind, found = type(value), []
    for name in inputs(kind):
        place, item = join(where, name), getattr(value, name)
        if is_dataclass(item):
            found.extend(_numbers(item, place))
        else:
            found.extend((place, h) for h in _floats(Hint.of(hints(kind)[name], None)))
    return found


def _floats(hint: Hint) -> list[Hint]:
    """Hints of the numbers inside a type hint."""
    if hint.type is float:
        return [hint]
    parts = members(hint.type)
    if len(parts) == 1:
        inside = get_args(hint.type) if is_tuple(hint.type) or is_mapping(hint.type) else ()
        parts = tuple(p for p in inside if p is not Ellipsis)
    return [h for part in parts for h in _floats(Hint.of(part, hint.unit))]


def _round_trip(law: Any) -> float:
    if not is_dataclass(law):
        return nan
    kind = type(law)
    try:
        text = write(law, kind, "")
    except InputError as error:
        if "Python" in error.remedy:
            return nan
        raise AssertionError(f"{law}: {error}") from None
    require(isinstance(text, Mapping), law, "it is not written as a table")
    again = Reader(Units.standard(), Path()).read(text, kind, "")
    require(again == law, law, f"its text is read back as {again}")
    return 0.0


DESCRIBED = (
    Examination(name="every parameter has a unit", look=_units),
    Examination(name="scenario text reproduces the law", look=_round_trip),
)
