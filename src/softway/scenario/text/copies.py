"""Copies of a solid: one table of a scenario stands for several bodies at different places."""

import copy
import itertools
from collections.abc import Mapping, Sequence
from typing import Any

from softway.errors import InputError
from softway.scenario.hints.units_text import Units

MOST = 10_000
"""Maximum number of copies of a body."""
MEANING = """Places of copies of a solid: a list of vectors, or of tables with ``at`` and keys of the body that differ;
or a lattice with ``count`` and ``spacing``. The copies of ``ball`` are the bodies ``ball1``, ``ball2``, and so on."""
_ENTRY = 'vectors or tables, such as copies = [["0 m", "0 m"], { at = ["1 m", "0 m"], velocity = ["2 m/s", "0 m/s"] }]'
_LATTICE = 'such as { count = [5, 3], spacing = ["20 mm", "20 mm"] }'


def with_copies(data: Mapping[str, Any], units: Units) -> dict[str, Any]:
    """Copy of the data of a scenario in which each body with the key ``copies`` is replaced by bodies.

    The key is a list: a vector moves the copy, and a table with ``at`` also replaces keys of the body.  A table with
    ``count`` and ``spacing`` is a lattice.  The copies of ``ball`` are named ``ball1``, ``ball2``, and so on.  In lists
    of contacts ``ball`` stands for all of them; a contact of ``ball`` with another body, and a load on it, are
    repeated for each.

    Parameters
    ----------
    data
        Content of a scenario file.
    units
        Converter of lengths.

    Raises
    ------
    InputError
        If the copies are not of these forms, or if the name of a copy exists already.

    Examples
    --------
    >>> data = {"bodies": {"ball": {"copies": [[0.0], ["2 mm"]]}}, "contacts": [{"between": ["ball", "wall"]}]}
    >>> made = with_copies(data, Units.standard())
    >>> made["bodies"]["ball2"], made["contacts"][1]["between"]
    ({'group': [{'translation': [0.002]}]}, ['ball2', 'wall'])
    """
    bodies = data.get("bodies")
    if not isinstance(bodies, Mapping):
        return dict(data)
    names: dict[str, list[str]] = {}
    made: dict[str, Any] = {}
    for name, body in bodies.items():
        if not isinstance(body, Mapping) or "copies" not in body:
            made[name] = body
            continue
        copies = _copies(body, f"bodies.{name}", units)
        names[name] = [f"{name}{k + 1}" for k in range(len(copies))]
        for other in names[name]:
            if other in bodies or other in made:
                raise InputError(f"bodies.{name}.copies", f"there is a body {other!r} already", "another name")
        made.update(zip(names[name], copies, strict=True))
    if not names:
        return dict(data)
    return {**data, "bodies": made, **_repeated(data, names)}


def _copies(body: Mapping[str, Any], where: str, units: Units) -> list[dict[str, Any]]:
    """Tables of the copies of one body."""
    if body.get("kind", "Solid") != "Solid":
        raise InputError(f"{where}.copies", f"the body is of kind {body['kind']!r}", "copies of a Solid only")
    given = body["copies"]
    if isinstance(given, Mapping):
        entries: list[Any] = _lattice(given, f"{where}.copies", units)
    else:
        entries = list(given) if isinstance(given, list) else []
    if not entries:
        raise InputError(f"{where}.copies", f"{given!r:.60} is no list of places", _ENTRY)
    if len(entries) > MOST:
        raise InputError(f"{where}.copies", f"{len(entries)} copies", f"at most {MOST}")
    return [_one(body, entry, f"{where}.copies[{k}]", units) for k, entry in enumerate(entries)]


def _one(body: Mapping[str, Any], entry: Any, where: str, units: Units) -> dict[str, Any]:
    """Table of one copy: the body with the keys of the entry, moved to its place."""
    changes = dict(entry) if isinstance(entry, Mapping) else {"at": entry}
    if "at" not in changes or not isinstance(changes["at"], list):
        raise InputError(where, f"{entry!r:.60} has no place", _ENTRY)
    move = [units.number(x, "m", f"{where}.at[{k}]") for k, x in enumerate(changes.pop("at"))]
    made = copy.deepcopy({**{key: value for key, value in body.items() if key != "copies"}, **changes})
    group = made.get("group", [])
    if not isinstance(group, list):
        raise InputError(where, f"the group of the body is {group!r:.60}", "a list of placements")
    return {**made, "group": [*group, {"translation": move}]}


def _lattice(given: Mapping[str, Any], where: str, units: Units) -> list[list[float]]:
    """Places of a lattice; the first coordinate runs fastest."""
    count, spacing = given.get("count"), given.get("spacing")
    for key in given:
        if key not in ("count", "spacing"):
            raise InputError(f"{where}.{key}", f"unknown key (value {given[key]!r:.60})", _LATTICE)
    if not isinstance(count, list) or not all(type(n) is int and n > 0 for n in count):
        raise InputError(f"{where}.count", f"{count!r:.60} is no list of positive whole numbers", _LATTICE)
    if not isinstance(spacing, list) or len(spacing) != len(count):
        raise InputError(f"{where}.spacing", f"{spacing!r:.60} is no list of {len(count)} lengths", _LATTICE)
    steps = [units.number(x, "m", f"{where}.spacing[{k}]") for k, x in enumerate(spacing)]
    axes = [[k * step for k in range(n)] for n, step in zip(reversed(count), reversed(steps), strict=True)]
    return [list(reversed(place)) for place in itertools.product(*axes)]


def _repeated(data: Mapping[str, Any], names: Mapping[str, list[str]]) -> dict[str, Any]:
    """Contacts and loads for the copies."""
    out: dict[str, Any] = {}
    for key, one in (("contacts", _contacts), ("loads", _loads)):
        given = data.get(key)
        if isinstance(given, list):
            out[key] = [made for entry in given for made in (one(entry, names) if isinstance(entry, dict) else [entry])]
    return out


def _contacts(contact: dict[str, Any], names: Mapping[str, list[str]]) -> Sequence[dict[str, Any]]:
    """One contact of a list; of two bodies one contact for each copy."""
    between = contact.get("between")
    if not isinstance(between, list):
        return [contact]
    members = [_members(entry, names) for entry in between]
    if all(len(found) == 1 for found in members) and [found[0] for found in members] == between:
        return [contact]
    pair = len(between) == 2 and _body(between[0]) != _body(between[1])
    if not pair:
        return [{**contact, "between": list(itertools.chain(*members))}]
    pairs = [list(found) for found in itertools.product(*members)]
    named = [{"name": f"{contact['name']}{k + 1}"} if "name" in contact else {} for k in range(len(pairs))]
    return [{**contact, "between": found, **name} for found, name in zip(pairs, named, strict=True)]


def _loads(load: dict[str, Any], names: Mapping[str, list[str]]) -> Sequence[dict[str, Any]]:
    """The load for each copy of its body."""
    return [{**load, "on": on} for on in _members(load["on"], names)] if "on" in load else [load]


def _body(entry: Any) -> Any:
    """Name of the body of ``body`` or ``body.tag``."""
    return entry.partition(".")[0] if isinstance(entry, str) else entry


def _members(entry: Any, names: Mapping[str, list[str]]) -> list[Any]:
    """Names of the copies, with the tag of the entry; the entry itself if its body has none."""
    if not isinstance(entry, str) or _body(entry) not in names:
        return [entry]
    name, dot, tag = entry.partition(".")
    return [f"{one}{dot}{tag}" for one in names[name]]
