"""Conversion of plain TOML data to dataclasses, guided by their type hints."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, is_dataclass
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

from softway.errors import InputError
from softway.meshes.generators.recipes import MeshFile
from softway.scenario.hints.type_hints import (
    Hint,
    hints,
    holder,
    inputs,
    is_mapping,
    is_tuple,
    kinds,
    members,
    nearest,
    open_protocols,
    required,
)
from softway.scenario.hints.units_text import Units, example, is_quantity
from softway.scenario.text.misplaced import right_place
from softway.scenario.text.user_modules import Modules


@dataclass(frozen=True, slots=True)
class Reader:
    """Builder of the object of a type hint from a TOML value.

    Parameters
    ----------
    units
        Converter of quantities.
    folder
        Folder of files with a relative path.
    modules
        Source of user-defined classes.

    Examples
    --------
    >>> from softway.bodies.elements.section import Bar
    >>> Reader(Units.standard(), Path()).read({"area": "314 mm^2"}, Bar, "section")
    Bar(area=0.000314)
    """

    units: Units
    folder: Path
    modules: Modules = Modules()

    def read(self, value: Any, hint: Any, where: str, outer: str | None = None) -> Any:
        """Build the object; ``where`` is its path, ``outer`` the unit of numbers without a unit of their own."""
        want = Hint.of(hint, outer)
        options = members(want.type)
        if len(options) > 1 or kinds(options) and not is_dataclass(want.type):
            return self._union(value, options, where, want.unit)
        if isinstance(want.type, type) and is_dataclass(want.type):
            return self._object(value, want.type, where, want.unit)
        if is_tuple(want.type):
            return self._tuple(value, want.type, where, want.unit)
        if is_mapping(want.type):
            return self._mapping(value, want.type, where, want.unit)
        return self._scalar(value, want, where)

    def _scalar(self, value: Any, want: Hint, where: str) -> Any:
        """Read a number, text, truth value or word of a fixed list."""
        if want.type is float:
            return self.units.number(value, want.unit or "", where)
        if get_origin(want.type) is Literal:
            words = [str(w) for w in get_args(want.type)]
            if value not in get_args(want.type):
                raise InputError(where, f"{value!r} is unknown", nearest(str(value), words))
            return value
        names = {int: "a whole number", bool: "true or false", str: "text in quotes", Path: "a path in quotes"}
        if want.type not in names:
            raise InputError(where, f"{value!r} cannot be read from text", "set it from Python")
        source = str if want.type is Path else want.type
        if not isinstance(value, source) or (source is int and isinstance(value, bool)):
            raise InputError(where, f"{value!r} is not {names[want.type]}", names[want.type])
        return self.folder / value if want.type is Path else want.type(value)

    def _tuple(self, value: Any, hint: Any, where: str, unit: str | None) -> tuple[Any, ...]:
        """Read a list; a single number stands for a vector with one entry."""
        args = get_args(hint)
        if isinstance(value, int | float | str) and Hint.of(args[0], None).type is float:
            value = [value]
        if not isinstance(value, list | tuple):
            raise InputError(where, f"{value!r} is not a list", "a list in square brackets; [[...]] for tables")
        if args[-1] is Ellipsis:
            args = (args[0],) * len(value)
        if len(args) != len(value):
            raise InputError(where, f"{value!r} has {len(value)} entries", f"a list of {len(args)} entries")
        return tuple(self.read(v, a, f"{where}[{k}]", unit) for k, (v, a) in enumerate(zip(value, args, strict=True)))

    def _mapping(self, value: Any, hint: Any, where: str, unit: str | None) -> dict[str, Any]:
        """Read a table whose keys are names chosen by the user."""
        if not isinstance(value, Mapping):
            raise InputError(where, f"{value!r} is not a table", f"tables such as [{where}.NAME]")
        for key in value:
            if not key.isprintable():
                raise InputError(where, f"the name {key!r:.60} holds signs that no line can show", "letters and digits")
        return {k: self.read(v, get_args(hint)[1], f"{where}.{k}", unit) for k, v in value.items()}

    def _union(self, value: Any, options: tuple[Any, ...], where: str, unit: str | None) -> Any:
        """Select the alternative from the kind or the form of the value, and read it."""
        known = kinds(options)
        tables = [o for o in options if is_mapping(o)]
        named = isinstance(value, Mapping) and _by_names(value) and not any(_takes(c, value) for c in known.values())
        if tables and known and named:
            return self._mapping(value, tables[0], where, unit)
        if isinstance(value, Mapping) and known:
            return self._kind(value, options, known, where, unit)
        if isinstance(value, str):
            if any(get_origin(o) is Literal and value in get_args(o) for o in options):
                return value
            number = any(Hint.of(o, unit).type is float for o in options) and is_quantity(value)
            if any(get_origin(o) is Callable for o in options) and not number:
                self.modules.found(value, where)
            if value in known:
                return self._object({}, known[value], where, unit)
        fitting = [o for o in options if fits(value, o)]
        if fitting:
            return self._fitting(value, fitting[0], options, where, unit)
        short = [(c, k) for c in known.values() for k in inputs(c) if len(inputs(c)) == 1 and fits(value, hints(c)[k])]
        if len(short) == 1:
            return self._object({short[0][1]: value}, short[0][0], where, unit)
        problem = f"{value!r} is not a known kind" if known else f"{value!r} does not fit"
        raise InputError(where, problem, _remedy(value, options, known, unit))

    def _fitting(self, value: Any, choice: Any, options: tuple[Any, ...], where: str, unit: str | None) -> Any:
        """Read one alternative; an error also lists the admitted words."""
        words = [repr(w) for o in options if get_origin(o) is Literal for w in get_args(o)]
        try:
            return self.read(value, choice, where, unit)
        except InputError as error:
            if words and error.where == where:
                raise InputError(where, error.problem, f"{error.remedy}, or {', '.join(words)}") from None
            raise

    def _kind(
        self, value: Mapping[str, Any], options: tuple[Any, ...], known: dict[str, type], where: str, unit: str | None
    ) -> Any:
        """Read the alternative named by ``kind``; without ``kind`` the only one, or the only one with these keys."""
        name = value.get("kind")
        protocols = open_protocols(options)
        if name is None and not protocols:
            likely = [c for c in known.values() if len(known) == 1 or _takes(c, value)]
            likely = likely or [c for c in known.values() if _enough(c, value)]
            if len(likely) == 1:
                return self._object(value, likely[0], where, unit)
        if name is None:
            raise InputError(f"{where}.kind", "missing", f"one of: {', '.join(known)}")
        if isinstance(name, str) and ":" in name and protocols:
            return self._own(value, self.modules.law(name, protocols, f"{where}.kind"), where, unit)
        if not isinstance(name, str) or name not in known:
            remedy = holder(str(name), known) or nearest(str(name), known)
            raise InputError(f"{where}.kind", f"{name!r} is unknown", remedy)
        return self._object(value, known[name], where, unit)

    def _own(self, value: Mapping[str, Any], cls: type, where: str, unit: str | None) -> Any:
        """Build an object of a user-defined class, whose constructor may raise any exception."""
        try:
            return self._object(value, cls, where, unit)
        except InputError:
            raise
        except Exception as error:
            problem = f"{cls.__name__} cannot be constructed: {type(error).__name__}: {error}"
            raise InputError(where, problem, f"see {cls.__module__}.{cls.__name__}") from error

    def _object(self, value: Any, cls: type, where: str, unit: str | None) -> Any:
        """Build a dataclass from a table; every key must be one of its fields."""
        if not isinstance(value, Mapping):
            keys = ", ".join(inputs(cls))
            raise InputError(where, f"{value!r} is not a table", f"{cls.__name__} as a table with: {keys}")
        known, types = inputs(cls), hints(cls)
        _check_keys(value, cls, where, unit)
        made = {k: self.read(v, types[k], join(where, k), unit) for k, v in value.items() if k in known}
        if cls is MeshFile:
            made["path"] = str(self.folder / made["path"])
        try:
            return cls(**made)
        except InputError as error:
            raise InputError(join(where, error.where), error.problem, error.remedy) from None


def join(where: str, key: str) -> str:
    """Join the path ``where`` and a key.

    Examples
    --------
    >>> join("bodies.bar", "density"), join("", "time"), join("at", "[0]")
    ('bodies.bar.density', 'time', 'at[0]')
    """
    if not where or not key:
        return where or key
    return f"{where}{key}" if key.startswith("[") else f"{where}.{key}"


def _by_names(value: Mapping[str, Any]) -> bool:
    """True if a table has tables only, by names of the user, and no ``kind``."""
    return bool(value) and "kind" not in value and all(isinstance(item, Mapping) for item in value.values())


def _takes(cls: type, value: Mapping[str, Any]) -> bool:
    """True if a table has all required keys of a class, and no unknown key."""
    return value.keys() <= inputs(cls).keys() and _enough(cls, value)


def _enough(cls: type, value: Mapping[str, Any]) -> bool:
    """True if a table has all required keys of a class."""
    return all(k in value for k, f in inputs(cls).items() if required(f))


def _check_keys(value: Mapping[str, Any], cls: type, where: str, unit: str | None) -> None:
    """Refuse unknown keys and missing required keys."""
    known = inputs(cls)
    for key, given in value.items():
        if key not in known and key != "kind":
            place = right_place(key, cls.__name__, top=not where)
            remedy = f"{place}; known: {', '.join(known)}" if place else nearest(key, known)
            raise InputError(join(where, key), f"unknown key (value {given!r}); {cls.__name__}", remedy)
    kind = str(value.get("kind", cls.__name__))
    if "kind" not in known and kind.rpartition(":")[2] != cls.__name__:
        raise InputError(join(where, "kind"), f"{kind!r} is unknown", nearest(kind, [cls.__name__]))
    for key, field in known.items():
        if required(field) and key not in value:
            want = Hint.of(hints(cls)[key], unit)
            remedy = f"{key} = {example(want.unit or '')}" if want.type is float else f"add {key}"
            raise InputError(join(where, key), "missing", remedy)


def fits(value: Any, hint: Any) -> bool:
    """True if a value has the form of a type; units are not checked.

    Examples
    --------
    >>> fits([1, "2 m"], tuple[float, ...]), fits([[1, 0]], tuple[float, ...]), fits("1 m", float)
    (True, False, True)
    """
    return any(_fits(value, Hint.of(option, None).type) for option in members(Hint.of(hint, None).type))


def _fits(value: Any, kind: Any) -> bool:
    """True if a value has the form of one alternative."""
    if isinstance(value, Mapping):
        return is_mapping(kind) or bool(kinds([kind]))
    if isinstance(value, bool):
        return kind is bool
    if isinstance(value, list | tuple):
        return is_tuple(kind) and (not value or fits(value[0], get_args(kind)[0]))
    if isinstance(value, str):
        return kind in (float, str, Path)
    return kind is float or (kind is int and isinstance(value, int))


def _remedy(value: Any, options: tuple[Any, ...], known: dict[str, type], unit: str | None) -> str:
    """Remedy that lists the alternatives of a union."""
    numbers = [Hint.of(o, unit) for o in options if Hint.of(o, unit).type is float]
    words = [repr(w) for o in options if get_origin(o) is Literal for w in get_args(o)]
    parts = [example(n.unit or "") for n in numbers] + words
    if known and isinstance(value, str) and not parts:
        parts.append(nearest(value, known))
    elif known:
        parts.append(f"a table with kind = one of: {', '.join(known)}")
    other = [o.__name__ for o in options if o in (int, bool, str)] if not parts else []
    names = {"int": "a whole number", "bool": "true or false", "str": "text in quotes"}
    lists = ["a list of numbers"] if not parts and any(is_tuple(o) for o in options) else []
    lists += ["a list of text" for o in options if is_tuple(o) and get_args(o)[0] is str]
    return ", or ".join(parts + [names[o] for o in other] + lists)
