"""Reading and checking of a scenario file, with a display of the progress."""

from collections.abc import Iterable
from pathlib import Path

from rich.console import Console

from softway.apps.cli.output.progress import waiting
from softway.errors import InputError
from softway.ranks.interface import Ranks
from softway.ranks.launch import agreed
from softway.scenario.checks.check import Checked, check
from softway.scenario.checks.heat import CheckedHeat
from softway.scenario.checks.pile import CheckedPile
from softway.scenario.files import load
from softway.scenario.run_ranks import require_ranks
from softway.scenario.run_rigid import CheckedRigid


def examined(
    file: Path,
    changes: Iterable[str],
    console: Console,
    *,
    allow_python: bool,
    strict: bool = False,
    ranks: Ranks | None = None,
) -> Checked | CheckedRigid:
    """Read and check a scenario file; return it with its meshes and scales.

    Raises
    ------
    InputError
        With the path in the scenario, the value, and a remedy; if ``strict`` also for cards of a mesh file that the
        mesh does not hold; with ``ranks`` for what does not run over ranks, and on all of them if one fails.
    """
    if ranks is not None:
        found = agreed(ranks, lambda: examined(file, changes, console, allow_python=allow_python, strict=strict))
        require_ranks(found, ranks.size)
        return found
    with waiting(console, "reading the scenario and building the meshes"):
        scenario = load(file, changes, allow_python=allow_python)
        try:
            checked = check(scenario)
        except MemoryError as error:
            problem = f"too large for the memory of this machine: {error or 'out of memory'}"
            raise InputError("bodies", problem, "fewer cells: bodies.NAME.mesh.cells") from None
    if strict and isinstance(checked, Checked):
        _require_all(checked)
    return checked


def _require_all(checked: Checked) -> None:
    """Refuse a deck with cards that matter and that the mesh does not hold."""
    for name, cards in checked.left_out.items():
        lost = [str(card) for card in cards if card.matters]
        if lost:
            problem = "the mesh file has cards that are not honoured:\n    " + "\n    ".join(lost)
            raise InputError(f"bodies.{name}.mesh", problem, "remove these cards from the file, or omit --strict")


def of_solids(file: Path, checked: Checked | CheckedRigid) -> Checked:
    """Refuse a scenario of rigid bodies, balls or conductors."""
    if not isinstance(checked, Checked):
        words = {CheckedPile: "balls", CheckedHeat: "conductors"}
        what = words.get(type(checked), "rigid bodies")
        raise InputError(str(file), f"is a scenario of {what}: there are no methods to compare", "softway run")
    return checked
