"""Scenario files: read, with units, kinds and errors that name the place; and written back complete."""

import difflib
import re
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import tomli_w

from softway.errors import InputError
from softway.scenario.library import furnished
from softway.scenario.modules import READING, Modules
from softway.scenario.override import overridden
from softway.scenario.quantity import Units
from softway.scenario.reader import Reader
from softway.scenario.scenario import Scenario
from softway.scenario.writer import write

LONGEST = 20_000_000
"""Characters of the longest scenario."""
NESTED = 50
"""Levels of tables and lists in the deepest scenario."""


def load(
    path: str | Path, changes: Iterable[str] = (), units: Units | None = None, *, allow_python: bool = False
) -> Scenario:
    """The scenario of a TOML file.

    Parameters
    ----------
    path
        The file; relative mesh files are looked for beside it.
    changes
        ``path=value`` each, made before reading.
    units
        Table of units; by default the standard one.
    allow_python
        Whether ``module:name`` may also name an installed module; one beside the file is admitted always.

    Raises
    ------
    InputError
        With the path in the scenario, the value, and a remedy.
    """
    file = Path(path)
    try:
        if file.exists() and not file.is_file():
            raise InputError(str(file), "cannot be read: a folder or a device", "a TOML file in UTF-8")
        with file.open(encoding="utf-8-sig") as opened:
            text = opened.read(LONGEST + 1)
    except FileNotFoundError:
        raise InputError(str(file), "no such scenario file", _others(file)) from None
    except (OSError, ValueError) as error:
        raise InputError(str(file), f"cannot be read: {error}", "a TOML file in UTF-8") from None
    if len(text) > LONGEST:
        raise InputError(str(file), f"is longer than {LONGEST} characters", "large data in mesh files")
    modules = Modules(folder=file.resolve().parent, allowed=allow_python)
    return loads(text, changes=changes, units=units, name=str(file), modules=modules)


def loads(
    text: str,
    *,
    folder: Path | None = None,
    changes: Iterable[str] = (),
    units: Units | None = None,
    name: str = "text",
    modules: Modules = Modules(),
) -> Scenario:
    """The scenario of a TOML text.

    Parameters
    ----------
    text
        TOML.
    folder
        Relative mesh files are looked for here; by default the folder of the modules.
    changes, units
        As for :func:`load`.
    name
        What the text is called in an error of syntax.
    modules
        Where ``module:name`` may come from; by default such names are refused.

    Examples
    --------
    >>> loads('''
    ... [bodies.wall]
    ... kind = "Tool"
    ... shape = { kind = "HalfSpace", point = "1.3 m", normal = -1 }
    ... [time]
    ... end = "4 s"
    ... ''').time.end
    4.0
    """
    data = parsed(text, name)
    reader = Reader(units or Units.standard(), folder or modules.folder or Path(), modules)
    with READING:
        scenario: Scenario = reader.read(furnished(overridden(data, changes)), Scenario, "")
    return scenario


def parsed(text: str, name: str) -> dict[str, Any]:
    """The data of a TOML text called ``name``.

    Raises
    ------
    InputError
        It is no TOML, or tables and lists are nested deeper than any scenario has them.
    """
    try:
        data = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        problem = "tables or lists nested without end" if isinstance(error, RecursionError) else str(error)
        problem += _line(problem, text)
        raise InputError(name, f"is not TOML: {problem}", "keys as name = value, texts in quotes") from None
    level: list[Any] = [data]
    for _ in range(NESTED):
        level = [v for d in level for v in (d.values() if isinstance(d, dict) else d) if isinstance(v, dict | list)]
        if not level:
            return data
    raise InputError(name, f"tables or lists nested deeper than {NESTED}", "the tables of a scenario")


def _line(problem: str, text: str) -> str:
    """The line that an error of syntax names, to be put behind it."""
    found = re.search(r"at line (\d+)", problem)
    lines = text.splitlines()
    number = int(found[1]) if found else 0
    return f": {lines[number - 1].strip():.80}" if 0 < number <= len(lines) else ""


def _others(file: Path) -> str:
    """What may have been meant by the name of a file that is not there."""
    there = [p.name for p in file.parent.glob("*.toml")] if file.parent.is_dir() else []
    close = difflib.get_close_matches(file.name, there, n=3, cutoff=0.5)
    return f"{' or '.join(close)}, which is there" if close else "softway new bar, which writes bar.toml to start from"


def resolved(scenario: Scenario) -> str:
    """The TOML text of a scenario with every default written out; ``loads`` beside it gives the same back.

    Raises
    ------
    InputError
        If a part of it was built in Python and has no text form: a mesh, an array, a function.
    """
    return tomli_w.dumps(write(scenario, Scenario, ""))


def dump(scenario: Scenario, path: str | Path) -> None:
    """Write :func:`resolved` to a file."""
    Path(path).write_text(resolved(scenario), encoding="utf-8")
