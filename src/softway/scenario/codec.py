"""Scenario files: read, with units, kinds and errors that name the place; and written back complete."""

import tomllib
from collections.abc import Iterable
from pathlib import Path

import tomli_w

from softway.errors import InputError
from softway.scenario.library import furnished
from softway.scenario.modules import Modules
from softway.scenario.override import overridden
from softway.scenario.quantity import Units
from softway.scenario.reader import Reader
from softway.scenario.scenario import Scenario
from softway.scenario.writer import write


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
        text = file.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise InputError(str(file), "no such scenario file", "softway new FILE makes one") from None
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(str(file), f"cannot be read: {error}", "a TOML file in UTF-8") from None
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
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(name, f"is not TOML: {error}", "keys as name = value, texts in quotes") from None
    reader = Reader(units or Units.standard(), folder or modules.folder or Path(), modules)
    scenario: Scenario = reader.read(furnished(overridden(data, changes)), Scenario, "")
    return scenario


def resolved(scenario: Scenario) -> str:
    """The TOML text of a scenario with every default written out; :func:`loads` gives the same scenario back.

    Raises
    ------
    InputError
        If a part of it was built in Python and has no text form: a mesh, an array, a function.
    """
    return tomli_w.dumps(write(scenario, Scenario, ""))


def dump(scenario: Scenario, path: str | Path) -> None:
    """Write :func:`resolved` to a file."""
    Path(path).write_text(resolved(scenario), encoding="utf-8")
