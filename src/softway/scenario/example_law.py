"""Construction of a law from its name, with given parameters and, for the others, defaults or example values."""

import ast
import doctest
import inspect
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from softway.errors import InputError
from softway.scenario.hints.type_hints import REGISTRIES, inputs, kinds, nearest, required
from softway.scenario.hints.units_text import Units
from softway.scenario.text.override import overridden
from softway.scenario.text.reader import Reader
from softway.scenario.text.user_modules import Modules


def law_named(name: str, changes: Iterable[str] = (), modules: Modules = Modules()) -> Any:
    """Construct the law with a given name.

    Parameters
    ----------
    name
        Name of a law of softway, with its package if two packages have a law of that name (``friction.NortonHoff``); or
        ``module:Class``.
    changes
        Parameters of the form ``parameter=value``, with units as in a scenario.  Other parameters without default are
        taken from the first example in the docstring of the class that constructs the law.
    modules
        Source of user-defined classes ``module:Class``.

    Raises
    ------
    InputError
        If the law is unknown, or if a parameter is wrong or missing.

    Examples
    --------
    >>> law_named("NeoHookean", ["nu=0.2"])
    NeoHookean(E=1.0, nu=0.2)
    """
    known = _laws()
    if ":" in name:
        cls = modules.law(name, tuple(REGISTRIES), "LAW")
    elif name in known:
        cls = known[name]
    else:
        raise InputError("LAW", f"{name!r} is unknown", f"{nearest(name, known)}, or module:Class")
    given = overridden({}, changes)
    missing = [key for key, field in inputs(cls).items() if required(field) and key not in given]
    data = {**sample(cls), **given} if missing else given
    return Reader(Units.standard(), Path(), modules).read(data, cls, "")


def _laws() -> dict[str, type]:
    """All laws of softway by name; a name that another package has already taken is preceded by the package."""
    found: dict[str, type] = {}
    for protocol, package in REGISTRIES.items():
        for name, cls in kinds([protocol]).items():
            taken = found.setdefault(name, cls) is not cls
            if taken:
                found[f"{package.rpartition('.')[2]}.{name}"] = cls
    return found


def sample(cls: type) -> Mapping[str, Any]:
    """Parameters in the first docstring example that constructs an object of the class from plain values only.

    Examples
    --------
    >>> from softway.laws.bulk import LinearElastic
    >>> sample(LinearElastic)
    {'E': 2.0}
    """
    try:
        examples = doctest.DocTestParser().get_examples(inspect.getdoc(cls) or "")
    except ValueError:
        return {}
    for example in examples:
        for node in ast.walk(_parsed(example.source)):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == cls.__name__:
                found = _literals(node)
                if found is not None:
                    return found
    return {}


def _parsed(source: str) -> ast.AST:
    try:
        return ast.parse(source)
    except SyntaxError:
        return ast.Module(body=[], type_ignores=[])


def _literals(call: ast.Call) -> dict[str, Any] | None:
    """Keyword arguments of a call; None if a value is not a literal."""
    try:
        return {word.arg: ast.literal_eval(word.value) for word in call.keywords if word.arg is not None}
    except ValueError:
        return None
