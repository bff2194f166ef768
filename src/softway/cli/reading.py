"""A scenario file read and examined, while who waits for it is told."""

from collections.abc import Iterable
from pathlib import Path

from rich.console import Console

from softway.cli.progress import waiting
from softway.errors import InputError
from softway.scenario.check import Checked, check
from softway.scenario.codec import load


def examined(file: Path, changes: Iterable[str], console: Console, *, allow_python: bool) -> Checked:
    """The scenario of a file with its meshes and scales.

    Raises
    ------
    InputError
        With the path in the scenario, the value, and a remedy.
    """
    with waiting(console, "reading the scenario, building its meshes"):
        scenario = load(file, changes, allow_python=allow_python)
        try:
            return check(scenario)
        except MemoryError as error:
            problem = f"too large for the memory of this machine: {error or 'nothing is left'}"
            raise InputError("bodies", problem, "fewer cells: bodies.NAME.mesh.cells") from None
