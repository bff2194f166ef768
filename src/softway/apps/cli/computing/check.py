"""Command check: a scenario without computing it."""

from pathlib import Path

from rich.console import Console

from softway.apps.cli.output.options import AllowPython, Quiet, Set, Strict
from softway.apps.cli.output.reading import examined
from softway.apps.cli.output.tables import scales


def check(
    file: Path, /, *, set_: Set = (), quiet: Quiet = False, strict: Strict = False, allow_python: AllowPython = False
) -> None:
    """Check a scenario without computing it, and show its scales.

    Parameters
    ----------
    file
        Scenario in TOML.
    set_
        Change a value of the scenario: path=value; can be repeated.
    quiet
        Print errors only.
    strict
        Refuse a mesh file with cards that are not honoured, such as materials and loads of an input deck.
    allow_python
        Allow module:name in the scenario to run code of installed modules, not only of modules next to the file.
    """
    console = Console(quiet=quiet)
    scales(examined(file, set_, console, allow_python=allow_python, strict=strict), console)
