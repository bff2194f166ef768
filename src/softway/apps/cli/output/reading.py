"""Reading and checking of a scenario file, with a display of the progress."""

from collections.abc import Iterable
from pathlib import Path

from rich.console import Console

from softway.apps.cli.output.progress import waiting
from softway.errors import InputError
from softway.scenario.checks.check import Checked, check
from softway.scenario.files import load


def examined(file: Path, changes: Iterable[str], console: Console, *, allow_python: bool) -> Checked:
    """Read and check a scenario file; return it with its meshes and scales.

    Raises
    ------
    InputError
        With the path in the scenario, the value, and a remedy.
    """
    with waiting(console, "reading the scenario and building the meshes"):
        scenario = load(file, changes, allow_python=allow_python)
        try:
            return check(scenario)
        except MemoryError as error:
            problem = f"too large for the memory of this machine: {error or 'out of memory'}"
            raise InputError("bodies", problem, "fewer cells: bodies.NAME.mesh.cells") from None
