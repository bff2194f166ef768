"""Scenarios mutated by meaning, by their number, and the judgement of what ``check`` and ``run`` make of them."""

import copy
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import tomli_w

from inputs.scenarios.parts import TAGS, Names, drawn, number, table, tables
from inputs.scenarios.scenes import scenes
from softway.scenario.class_index import classes
from softway.scenario.hints.type_hints import Hint, hints, inputs, kinds, members
from softway.scenario.scenario import Scenario

Rng = np.random.Generator
NAMES = (
    "x" * 1000, "a.b", "ä ö", "", " ", "1", "-", "all", "kind", "wall.top", "[bold]", "a/b", "../up", "a\nb", 'a"b',
    "a,b", "bar.left", "tool", "con", "mesh", "\x7f", "%s", "{x}", "\\", "#",
)  # fmt: skip
NUMBERS: tuple[Any, ...] = (
    0,
    -1,
    1e-12,
    1e12,
    1e-300,
    1e300,
    10**20,
    float("nan"),
    float("inf"),
    True,
    "",
    "1 furlong",
)


@dataclass(slots=True)
class Mutant:
    """A scenario as a table, the name of the scene it comes from, and what was done to it."""

    data: dict[str, Any]
    scene: str
    done: list[str] = field(default_factory=list)

    @property
    def names(self) -> Names:
        """Names of its bodies and places."""
        return Names.of(self.data)

    @property
    def dim(self) -> int:
        """Dimension of the scene."""
        return 1 if "bar" in self.scene else 3 if "block" in self.scene or self.scene == "part" else 2

    @property
    def text(self) -> bytes:
        """The scenario in TOML."""
        return tomli_w.dumps(self.data).encode(errors="surrogatepass")


def mutant(count: int) -> Mutant:
    """The mutated scenario of a number.

    Examples
    --------
    >>> mutant(7) == mutant(7)
    True
    """
    rng = np.random.default_rng([13, count])
    known = scenes()
    scene = sorted(known)[rng.integers(len(known))]
    made = Mutant(known[scene], scene)
    for _ in range(int(rng.choice([1, 1, 1, 2, 2, 3]))):
        mutation = MUTATIONS[rng.integers(len(MUTATIONS))]
        mutation(made, rng)
        made.done.append(mutation.__name__.strip("_"))
    return made


def _one(rng: Rng, entries: Any) -> Any:
    return entries[int(rng.integers(len(entries)))]


def _spot(made: Mutant, rng: Rng, fitting: Callable[[Any], bool] = lambda hint: True) -> Any:
    """Table, key, hint and unit of a key that is given, whose hint fits; None without any."""
    found = [
        (entry, key, hints(cls)[key], unit)
        for entry, cls, unit in tables(made.data, Scenario)
        for key in entry
        if key in inputs(cls) and fitting(hints(cls)[key])
    ]
    return _one(rng, found) if found else None


def _has_kinds(hint: Any) -> bool:
    return len(kinds(members(Hint.of(hint, None).type))) > 1


def _is_list(hint: Any) -> bool:
    return "tuple[" in str(hint)


def _is_table_list(hint: Any) -> bool:
    return "tuple[" in str(hint) and "softway." in str(hint)


def _is_number(hint: Any) -> bool:
    return "float" in str(hint) or hint is int


def _other_kind(made: Mutant, rng: Rng) -> None:
    """Another kind in the place of one: another law, mesh, tool, rule, motion, solver."""
    holder, key, hint, unit = _spot(made, rng, _has_kinds)
    holder[key] = drawn(key, hint, unit, made.names, rng, made.dim)


def _kept_keys(made: Mutant, rng: Rng) -> None:
    """Another kind with the keys of the former one."""
    found = _spot(made, rng, _has_kinds)
    if found and isinstance(found[0][found[1]], dict):
        holder, key, hint, _ = found
        holder[key]["kind"] = _one(rng, list(kinds(members(Hint.of(hint, None).type))))


def _added(made: Mutant, rng: Rng) -> None:
    """A key that was left at its default."""
    found = [(e, k, hints(c)[k], u) for e, c, u in tables(made.data, Scenario) for k in inputs(c) if k not in e]
    holder, key, hint, unit = _one(rng, found)
    value = drawn(key, hint, unit, made.names, rng, made.dim)
    if value is not None:
        holder[key] = value


def _strange_key(made: Mutant, rng: Rng) -> None:
    """A key that is valid elsewhere, or misspelt."""
    holder = _one(rng, tables(made.data, Scenario))[0]
    cls = _one(rng, [c for c in classes() if inputs(c)])
    key = _one(rng, list(inputs(cls)))
    value = drawn(key, hints(cls)[key], None, made.names, rng, made.dim)
    holder.setdefault(key if rng.random() < 0.7 else key.upper(), 1 if value is None else value)


def _dropped(made: Mutant, rng: Rng) -> None:
    """A key less."""
    holder, key, _, _ = _spot(made, rng)
    del holder[key]


def _renumbered(made: Mutant, rng: Rng) -> None:
    """Another number: a plausible one, one of another unit, or an odd one."""
    found = _spot(made, rng, _is_number)
    if not found:
        return
    holder, key, hint, unit = found
    mine = Hint.of(members(hint)[0], unit).unit or ""
    value: Any = number(mine, rng)
    if rng.random() < 0.4:
        value = _one(rng, NUMBERS) if rng.random() < 0.5 else number(_one(rng, ["m", "s", "Pa", "rad", "kg/m^3"]), rng)
    if isinstance(holder[key], list) and holder[key] and not isinstance(holder[key][0], list | dict):
        holder[key][int(rng.integers(len(holder[key])))] = value
    elif not isinstance(holder[key], dict | list):
        holder[key] = value


def _resized(made: Mutant, rng: Rng) -> None:
    """A list longer, shorter, empty, or doubled."""
    found = _spot(made, rng, _is_list)
    if found and isinstance(found[0][found[1]], list):
        old = found[0][found[1]]
        found[0][found[1]] = _one(rng, [old[:-1], old + old[:1], [], old + old, old[::-1]])


def _emptied(made: Mutant, rng: Rng) -> None:
    """A table or a list without entries."""
    holder, key, _, _ = _spot(made, rng)
    holder[key] = _one(rng, [{}, [], ""])


def _renamed(made: Mutant, rng: Rng) -> None:
    """Another name of a body, everywhere or at one place only."""
    bodies = made.data.get("bodies")
    if not isinstance(bodies, dict) or not bodies:
        return
    old, new = _one(rng, list(bodies)), _one(rng, NAMES)
    text = tomli_w.dumps(made.data)
    bodies[new] = bodies.pop(old)
    if rng.random() < 0.7 and old in text:
        for holder, _, _ in tables(made.data, Scenario):
            for key in ("between", "on", "of"):
                if key in holder:
                    holder[key] = _replaced(holder[key], old, new)


def _replaced(value: Any, old: str, new: str) -> Any:
    if isinstance(value, list):
        return [_replaced(v, old, new) for v in value]
    if isinstance(value, str) and (value == old or value.startswith(f"{old}.")):
        return new + value[len(old) :]
    return value


def _deeply(value: Any, old: str, new: str) -> Any:
    """The value with other names of bodies in it."""
    if isinstance(value, dict):
        return {key: _deeply(entry, old, new) for key, entry in value.items()}
    if isinstance(value, list):
        return [_deeply(entry, old, new) for entry in value]
    return _replaced(value, old, new)


def _labelled(made: Mutant, rng: Rng) -> None:
    """Names of contacts and probes, and titles."""
    for holder in [t for t, c, _ in tables(made.data, Scenario) if "name" in inputs(c) or c is Scenario]:
        holder["title" if "bodies" in holder else "name"] = _one(rng, NAMES)


def _crossed(made: Mutant, rng: Rng) -> None:
    """Places of other bodies: a contact with itself, a tool as a body, a tag of another body."""
    names = made.names
    for holder, _, _ in tables(made.data, Scenario):
        if "between" in holder and rng.random() < 0.7:
            holder["between"] = [names.place(rng), names.place(rng)]
        if "on" in holder and rng.random() < 0.5:
            holder["on"] = names.place(rng) if "." in str(holder["on"]) else names.tag(rng)
        if "of" in holder and rng.random() < 0.5:
            holder["of"] = _one(rng, names.bodies)


def _doubled(made: Mutant, rng: Rng) -> None:
    """An entry of a list of tables once more: contacts, supports, loads, probes."""
    found = _spot(made, rng, _is_table_list)
    if found and isinstance(found[0][found[1]], list) and found[0][found[1]]:
        entry = copy.deepcopy(_one(rng, found[0][found[1]]))
        if isinstance(entry, dict) and "name" in entry and rng.random() < 0.7:
            entry["name"] = "second"
        found[0][found[1]].append(entry)


def _second_body(made: Mutant, rng: Rng) -> None:
    """A body once more in the same place or beside, in contact or not."""
    bodies = made.data.get("bodies")
    if not isinstance(bodies, dict) or not bodies:
        return
    old = _one(rng, list(bodies))
    bodies["twin"] = copy.deepcopy(bodies[old])
    if rng.random() < 0.5 and isinstance(bodies["twin"], dict):
        bodies["twin"]["place"] = table(_place(), None, made.names, rng, made.dim)
    if rng.random() < 0.5:
        between = [f"{old}.{_one(rng, TAGS)}", f"twin.{_one(rng, TAGS)}"]
        made.data["contacts"] = [*made.data.get("contacts", []), {"name": "twins", "between": between}]


def _place() -> type:
    return next(c for c in classes() if c.__name__ == "Placement")


def _grafted(made: Mutant, rng: Rng) -> None:
    """A part of another scene under the same key."""
    other = scenes()[_one(rng, sorted(scenes()))]
    given = [(e, k) for e, c, _ in tables(other, Scenario) for k in e if k in inputs(c) and k != "bodies"]
    holder, key = _one(rng, given)
    value, names = copy.deepcopy(holder[key]), made.names
    for old in other["bodies"]:
        value = _deeply(value, old, _one(rng, list(names.solids if old in Names.of(other).solids else names.bodies)))
    targets = [e for e, c, _ in tables(made.data, Scenario) if key in inputs(c)]
    if targets:
        _one(rng, targets)[key] = value


def _one_cell(made: Mutant, rng: Rng) -> None:
    """Bodies one cell thick, with friction or without."""
    for holder, cls, _ in tables(made.data, Scenario):
        if "cells" in holder and cls.__name__ != "MeshFile":
            holder["cells"] = [1] * len(holder["cells"]) if isinstance(holder["cells"], list) else 1
        if "between" in holder and "friction" in hints(cls) and made.dim > 1 and rng.random() < 0.5:
            holder["friction"] = drawn("friction", hints(cls)["friction"], None, made.names, rng, made.dim)


def _supported(made: Mutant, rng: Rng) -> None:
    """Supports of one or more bodies: on all, twice, or driven."""
    cls = next(c for c in classes() if c.__name__ == "Solid")
    for holder in [t for t, c, _ in tables(made.data, Scenario) if c is cls]:
        holder["supports"] = drawn("supports", hints(cls)["supports"], None, made.names, rng, made.dim)
        if rng.random() < 0.4:
            holder["supports"] = [{"on": "all"}]


def _ruled(made: Mutant, rng: Rng) -> None:
    """Another rule, method, friction and solver together."""
    for holder, cls, _ in tables(made.data, Scenario):
        keys = {
            "Contact": ("timing", "method", "friction"),
            "Scenario": ("solver", "inertia"),
            "Solid": ("force", "mass"),
        }
        for key in keys.get(cls.__name__, ()):
            if rng.random() < 0.6:
                value = drawn(key, hints(cls)[key], None, made.names, rng, made.dim)
                holder.update({} if value is None else {key: value})


def _loaded(made: Mutant, rng: Rng) -> None:
    """Loads, a start in equilibrium, and probes."""
    for key in ("loads", "start", "output"):
        if rng.random() < 0.6:
            made.data[key] = drawn(key, hints(Scenario)[key], None, made.names, rng, made.dim)


MUTATIONS = (
    _other_kind, _other_kind, _other_kind, _kept_keys, _added, _added, _added, _strange_key, _dropped, _renumbered,
    _renumbered, _resized, _emptied, _renamed, _labelled, _crossed, _doubled, _second_body, _grafted, _grafted,
    _one_cell, _supported, _ruled, _ruled, _loaded,
)  # fmt: skip
