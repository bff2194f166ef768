"""Command explain: documentation of a kind, a key or a command."""

import difflib
import inspect
import re
from collections.abc import Callable, Mapping, Set
from dataclasses import MISSING
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.table import Table as Grid

from softway.apps.cli.commands import app
from softway.errors import InputError
from softway.scenario.class_index import classes, keys
from softway.scenario.hints.docstrings import described
from softway.scenario.hints.type_hints import Hint, hints, inputs, required
from softway.scenario.text import copies

FILE_KEYS = {"copies": copies.MEANING}
"""Keys of scenario files that are no arguments in Python."""


def explain(name: str, /) -> None:
    """Explain a kind, a key or a command: meaning, units, defaults, example.

    Parameters
    ----------
    name
        Kind, key or command, such as Coulomb, density or run.
    """
    told(name, {verb: app[verb].default_command for verb in app if not verb.startswith("-")}, Console())


def told(name: str, commands: Mapping[str, Callable[..., Any] | None], console: Console) -> None:
    """Print the documentation of a name: a class, a key or a command.

    Raises
    ------
    InputError
        If the name is unknown; the remedy lists the closest names.
    """
    name = _known(name, {cls.__name__ for cls in classes()} | keys().keys() | commands.keys() | FILE_KEYS.keys())
    kinds = [cls for cls in classes() if cls.__name__ == name]
    owners = keys().get(name, ())
    if name in commands:
        _head(f"softway {name}", "command", console)
        console.print(escape(plain(inspect.getdoc(commands[name]) or "")), highlight=False)
    for cls in kinds:
        _kind(cls, console)
    if name in FILE_KEYS:
        _head(name, "key of bodies in scenario files", console)
        console.print(escape(plain(FILE_KEYS[name])), highlight=False)
    if owners:
        _head(name, "key", console)
        console.print(_grid([(cls, name) for cls in owners], of=True))


def _known(name: str, words: Set[str]) -> str:
    """The word that is meant by a name, of which capital letters do not count where no word has them."""
    lower = {word.lower(): word for word in sorted(words)}
    if name not in words and name.lower() not in lower:
        close = [lower[word] for word in difflib.get_close_matches(name.lower(), lower, n=3, cutoff=0.5)]
        raise InputError("NAME", f"no kind, key or command {name!r}", ", ".join(close) or "Solid, Contact, time, run")
    return name if name in words else lower[name.lower()]


def _kind(cls: type, console: Console) -> None:
    """Print the description, keys and example of a class."""
    said = described(cls)
    _head(cls.__name__, "kind", console)
    console.print(escape(plain(said.summary)), highlight=False)
    if inputs(cls):
        console.print(_grid([(cls, key) for key in inputs(cls)], of=False))
    if said.sections.get("Examples"):
        console.print(escape(f"in Python\n{said.sections['Examples']}"), highlight=False)
    console.print()


def _head(name: str, what: str, console: Console) -> None:
    console.print(f"[bold]{escape(name)}[/]  {what}", highlight=False)


def _grid(entries: list[tuple[type, str]], of: bool) -> Grid:
    """Table of keys with unit, default and meaning; ``of`` shows the class in the first column."""
    grid = Grid(box=None, pad_edge=False, header_style="bold")
    for head in ("of" if of else "key", "unit", "default", "meaning"):
        grid.add_column(head, overflow="fold")
    for cls, key in entries:
        unit = Hint.of(hints(cls)[key], None).unit or ""
        first = cls.__name__ if of else key
        grid.add_row(*map(escape, (first, unit, _default(cls, key), plain(described(cls).fields.get(key, "")))))
    return grid


def plain(text: str) -> str:
    """Documentation text for the terminal, without markup.

    Examples
    --------
    >>> plain("``|t| <= mu p``, see :class:`~softway.laws.Coulomb`")
    '|t| <= mu p, see Coulomb'
    """
    names = re.sub(r":\w+:`~?(?:[\w.]*\.)?(\w+)`", r"\1", text)
    return re.sub(r"``([^`]+)``", r"\1", names)


def _default(cls: type, key: str) -> str:
    """Default of a key, or ``required``."""
    field = inputs(cls)[key]
    if required(field):
        return "required"
    return str(field.default if field.default_factory is MISSING else field.default_factory())
