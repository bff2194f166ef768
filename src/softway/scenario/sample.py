"""A law made from its name: by given parameters, and for the rest by its defaults and by its own example."""

import ast
import doctest
import inspect
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from softway.errors import InputError
from softway.scenario.kinds import REGISTRIES, inputs, kinds, nearest, required
from softway.scenario.modules import Modules
from softway.scenario.override import overridden
from softway.scenario.quantity import Units
from softway.scenario.reader import Reader


def law_named(name: str, changes: Iterable[str] = (), modules: Modules = Modules()) -> Any:
    """The law of a name.

    Parameters
    ----------
    name
        That of a law of softway, ``friction.NortonHoff`` where two packages have one of that name, or ``module:Class``.
    changes
        ``parameter=value`` each, with units as in a scenario.  Parameters that have no default are taken from the first
        example in the docstring of the class that makes one.
    modules
        Where ``module:Class`` comes from.

    Raises
    ------
    InputError
        Unknown, or with a parameter that is wrong or missing.

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
    """Every law of softway by its name, and by that of its package where another has it already."""
    found: dict[str, type] = {}
    for protocol, package in REGISTRIES.items():
        for name, cls in kinds([protocol]).items():
            taken = found.setdefault(name, cls) is not cls
            if taken:
                found[f"{package.rpartition('.')[2]}.{name}"] = cls
    return found


def sample(cls: type) -> Mapping[str, Any]:
    """Parameters in the first example of a docstring that makes an object of the class; only plain values are taken.

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
    """Keywords of a call whose values are all plain."""
    try:
        return {word.arg: ast.literal_eval(word.value) for word in call.keywords if word.arg is not None}
    except ValueError:
        return None
