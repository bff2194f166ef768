"""Changes by path, ``bodies.bar.material.E=2 Pa``, on the plain TOML data before it is read."""

import copy
import re
import tomllib
from collections.abc import Iterable
from typing import Any

from softway.errors import InputError
from softway.scenario.kinds import nearest

_STEP = re.compile(r"^([A-Za-z0-9_-]+)((?:\[\d+\])*)$")


def overridden(data: dict[str, Any], changes: Iterable[str]) -> dict[str, Any]:
    """A copy of the data with the changes made.

    Parameters
    ----------
    data
        Content of a scenario file.
    changes
        ``path=value`` each; the value is TOML, or plain text without quotes.

    Examples
    --------
    >>> overridden({"time": {"end": 1}}, ["time.end=2 ms", "time.step=0.1"])
    {'time': {'end': '2 ms', 'step': 0.1}}
    """
    out = copy.deepcopy(data)
    for change in changes:
        path, sign, text = change.partition("=")
        if not sign or not path.strip():
            raise InputError(change, "is no change", 'path=value, such as time.end="2 ms"')
        _set(out, steps(path.strip()), _value(text.strip()), path.strip())
    return out


def steps(path: str) -> tuple[str | int, ...]:
    """Keys and list positions of a path.

    Examples
    --------
    >>> steps("contacts[0].between")
    ('contacts', 0, 'between')
    """
    out: list[str | int] = []
    for part in path.split("."):
        found = _STEP.match(part)
        if found is None:
            raise InputError(path, f"{part!r} is no step of a path", "names and positions: contacts[0].timing")
        out.append(found[1])
        out.extend(int(n) for n in re.findall(r"\d+", found[2]))
    return tuple(out)


def _set(data: dict[str, Any], way: tuple[str | int, ...], value: Any, path: str) -> None:
    """Put the value at the end of the way; tables in between are made, bodies and list entries are not."""
    here: Any = data
    for k, (step, following) in enumerate(zip(way, (*way[1:], None), strict=True)):
        done = _text(way[:k])
        if isinstance(step, int):
            if not isinstance(here, list) or step >= len(here):
                size = len(here) if isinstance(here, list) else 0
                raise InputError(path, f"{done} has {size} entries", f"a position below {size}" if size else "no [..]")
        elif not isinstance(here, dict):
            raise InputError(path, f"{done} is {here!r}, not a table", f"{done}=... as a whole")
        elif done == "bodies" and step not in here:
            raise InputError(path, f"no body {step!r} (value {value!r})", nearest(step, here))
        if following is None:
            here[step] = value
            return
        if isinstance(step, str) and isinstance(following, str):
            here[step] = _table(here.get(step, {}))
        elif isinstance(step, str) and step not in here:
            raise InputError(path, f"{_text(way[: k + 1])} has 0 entries", "add it in the file")
        here = here[step]


def _table(value: Any) -> Any:
    """A kind given by its name alone becomes a table, so that its fields can be set."""
    return {"kind": value} if isinstance(value, str) and value[:1].isalpha() else value


def _text(way: tuple[str | int, ...]) -> str:
    """The way as a path."""
    out = ""
    for step in way:
        out += f"[{step}]" if isinstance(step, int) else f".{step}" if out else step
    return out


def _value(text: str) -> Any:
    """A TOML value; what is none is taken as text."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except (ValueError, RecursionError):
        return text
