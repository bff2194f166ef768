"""Scenario files: reading with units, kinds and errors that name the place, and writing with all defaults."""

import difflib
import re
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import tomli_w

from softway.errors import InputError
from softway.scenario.hints.units_text import Units
from softway.scenario.scenario import Scenario
from softway.scenario.text.copies import with_copies
from softway.scenario.text.material_names import with_materials
from softway.scenario.text.override import overridden
from softway.scenario.text.reader import Reader
from softway.scenario.text.user_modules import READING, Modules
from softway.scenario.text.writer import write

LONGEST = 20_000_000
"""Maximum number of characters in a scenario."""
NESTED = 50
"""Maximum number of nested levels of tables and lists in a scenario."""


def load(
    path: str | Path, changes: Iterable[str] = (), units: Units | None = None, *, allow_python: bool = False
) -> Scenario:
    """Load a scenario from a TOML file.

    Parameters
    ----------
    path
        Scenario file; relative paths of mesh files start from its folder.
    changes
        Changes of the form ``path=value``, applied before reading.
    units
        Converter of units; by default the standard one.
    allow_python
        True if ``module:name`` may also name an installed module; a module next to the file is always admitted.

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
        raise InputError(str(file), f"is longer than {LONGEST} characters", "put large data into mesh files")
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
    """Load a scenario from a TOML text.

    Parameters
    ----------
    text
        Scenario as TOML.
    folder
        Folder for relative paths of mesh files; by default the folder of the modules.
    changes, units
        As for :func:`load`.
    name
        Name of the text in syntax errors.
    modules
        Source of user-defined objects ``module:name``; by default such names are refused.

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
        whole = with_materials(with_copies(overridden(data, changes), reader.units))
        scenario: Scenario = reader.read(whole, Scenario, "")
    return scenario


def parsed(text: str, name: str) -> dict[str, Any]:
    """Parse a TOML text; ``name`` is its name in error messages.

    Raises
    ------
    InputError
        If the text is not TOML, or if tables and lists are nested too deeply.
    """
    try:
        data = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        problem = "tables or lists are nested too deeply" if isinstance(error, RecursionError) else str(error)
        problem += _line(problem, text)
        raise InputError(name, f"is not valid TOML: {problem}", "keys as name = value, texts in quotes") from None
    level: list[Any] = [data]
    for _ in range(NESTED):
        level = [v for d in level for v in (d.values() if isinstance(d, dict) else d) if isinstance(v, dict | list)]
        if not level:
            return data
    raise InputError(name, f"tables or lists are nested in more than {NESTED} levels", "only the tables of a scenario")


def _line(problem: str, text: str) -> str:
    """Line of the text that a syntax error names, to be appended to the message."""
    found = re.search(r"at line (\d+)", problem)
    lines = text.splitlines()
    number = int(found[1]) if found else 0
    return f": {lines[number - 1].strip():.80}" if 0 < number <= len(lines) else ""


def _others(file: Path) -> str:
    """Remedy for a missing file: scenario files with a similar name, or a new template."""
    there = [p.name for p in file.parent.glob("*.toml")] if file.parent.is_dir() else []
    close = difflib.get_close_matches(file.name, there, n=3, cutoff=0.5)
    return f"{' or '.join(close)}, which exists" if close else "softway new bar, which writes the template bar.toml"


def dumps(scenario: Scenario) -> str:
    """Convert a scenario to a TOML text with all defaults written out; :func:`loads` is the inverse.

    Raises
    ------
    InputError
        If a part was built in Python and has no text form, such as a mesh, an array or a function.
    """
    return tomli_w.dumps(write(scenario, Scenario, ""))


def dump(scenario: Scenario, path: str | Path) -> None:
    """Write :func:`dumps` to a file."""
    Path(path).write_text(dumps(scenario), encoding="utf-8")
