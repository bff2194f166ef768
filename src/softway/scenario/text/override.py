"""Overrides by path, such as ``bodies.bar.material.E=2 Pa``, applied to the plain TOML data before reading."""

import copy
import re
import tomllib
from collections.abc import Iterable
from typing import Any

from softway.errors import InputError
from softway.scenario.hints.type_hints import nearest

_STEP = re.compile(r"^([A-Za-z0-9_-]+)((?:\[\d+\])*)$")


def overridden(data: dict[str, Any], changes: Iterable[str]) -> dict[str, Any]:
    """Copy of the data with the changes applied.

    Parameters
    ----------
    data
        Content of a scenario file.
    changes
        Changes of the form ``path=value``; the value is TOML, or plain text without quotes.

    Examples
    --------
    >>> overridden({"time": {"end": 1}}, ["time.end=2 ms", "time.step=0.1"])
    {'time': {'end': '2 ms', 'step': 0.1}}
    """
    out = copy.deepcopy(data)
    for change in changes:
        path, sign, text = change.partition("=")
        if not sign or not path.strip():
            raise InputError(change, "is not of the form path=value", 'path=value, such as time.end="2 ms"')
        _set(out, steps(path.strip()), _value(text.strip()), path.strip())
    return out


def steps(path: str) -> tuple[str | int, ...]:
    """Split a path into keys and list positions.

    Examples
    --------
    >>> steps("contacts[0].between")
    ('contacts', 0, 'between')
    """
    out: list[str | int] = []
    for part in path.split("."):
        found = _STEP.match(part)
        if found is None:
            raise InputError(path, f"{part!r} is not valid in a path", "names and positions, as in contacts[0].timing")
        out.append(found[1])
        out.extend(int(n) for n in re.findall(r"\d+", found[2]))
    return tuple(out)


def _set(data: dict[str, Any], way: tuple[str | int, ...], value: Any, path: str) -> None:
    """Set the value at the end of the path; missing tables are created, missing bodies and list entries are not."""
    here: Any = data
    for k, (step, following) in enumerate(zip(way, (*way[1:], None), strict=True)):
        done = _text(way[:k])
        if isinstance(step, int):
            if not isinstance(here, list) or step >= len(here):
                size = len(here) if isinstance(here, list) else 0
                remedy = f"a position below {size}" if size else f"{done} without a position [..]"
                raise InputError(path, f"{done} has {size} entries", remedy)
        elif not isinstance(here, dict):
            raise InputError(path, f"{done} is {here!r}, not a table", f"{done}=... to replace it as a whole")
        elif done == "bodies" and step not in here:
            raise InputError(path, f"no body {step!r} (value {value!r})", nearest(step, here))
        if following is None:
            here[step] = value
            return
        if isinstance(step, str) and isinstance(following, str):
            here[step] = _table(here.get(step, {}))
        elif isinstance(step, str) and step not in here:
            raise InputError(path, f"{_text(way[: k + 1])} has 0 entries", "add the entry in the file")
        here = here[step]


def _table(value: Any) -> Any:
    """Turn a kind that is given only by its name into a table, so that its fields can be set."""
    return {"kind": value} if isinstance(value, str) and value[:1].isalpha() else value


def _text(way: tuple[str | int, ...]) -> str:
    """Path as a text."""
    out = ""
    for step in way:
        out += f"[{step}]" if isinstance(step, int) else f".{step}" if out else step
    return out


def _value(text: str) -> Any:
    """Parse a TOML value; anything else is taken as plain text."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except (ValueError, RecursionError):
        return text
