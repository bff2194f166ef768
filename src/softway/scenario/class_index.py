"""Index of all classes that a scenario may contain, found from the type hints."""

from collections.abc import Mapping
from dataclasses import is_dataclass
from typing import Any, get_args

from softway.scenario.hints.type_hints import Hint, hints, inputs, kinds, members
from softway.scenario.scenario import Scenario


def classes() -> tuple[type, ...]:
    """All classes of a scenario, starting with the outermost.

    Examples
    --------
    >>> [cls.__name__ for cls in classes()][0], "Coulomb" in [cls.__name__ for cls in classes()]
    ('Scenario', True)
    """
    found: list[type] = [Scenario]
    for cls in found:  # the list grows during the loop
        for hint in (hints(cls)[key] for key in inputs(cls)):
            found += [other for other in dict.fromkeys(_inside(hint)) if other not in found]
    return tuple(found)


def keys() -> Mapping[str, tuple[type, ...]]:
    """Classes that have a key, for each key."""
    found: dict[str, tuple[type, ...]] = {}
    for cls in classes():
        for key in inputs(cls):
            found[key] = (*found.get(key, ()), cls)
    return found


def _inside(hint: Any) -> list[type]:
    """Classes that a hint names, including those in its lists and tables."""
    options = members(Hint.of(hint, None).type)
    known = list(kinds(options).values())
    for option in options:
        inner = Hint.of(option, None).type
        if not (isinstance(inner, type) and is_dataclass(inner)):
            known += [
                cls
                for arg in get_args(inner)
                if arg is not Ellipsis and not isinstance(arg, str | int | list)
                for cls in _inside(arg)
            ]
    return known
