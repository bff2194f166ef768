"""Command check-law: examination of a law."""

from math import isnan
from pathlib import Path

from rich.console import Console
from rich.markup import escape
from rich.table import Table as Grid

from softway.apps.cli.output.options import Quiet, Set
from softway.errors import InputError
from softway.scenario.example_law import law_named
from softway.scenario.text.user_modules import Modules
from softway.testing.examination import Finding
from softway.testing.laws import examine_law

PASSED, NOT_PASSED = 0, 1


def check_law(
    law: str,
    /,
    *,
    set_: Set = (),
    quiet: Quiet = False,
) -> int:
    """Check a law of softway or your own law: stress, moduli, rotations, accuracy, units, text.

    Parameters
    ----------
    law
        Name of a law of softway, or module:Class with a module in this folder or an installed module.
    set_
        Parameter of the law: name=value; can be repeated. Other parameters use their defaults or the class example.
    quiet
        Print failures only.
    """
    subject = law_named(law, set_, Modules(folder=Path.cwd(), allowed=True))
    console = Console()
    try:
        found = examine_law(subject)
    except AssertionError as error:
        raise InputError("LAW", str(error)) from None
    if not quiet:
        console.print(escape(str(subject)), soft_wrap=True, highlight=False)
    _table(found, console, quiet)
    failed = sum(not finding.passed for finding in found)
    if not quiet:
        told = f"{failed} of {len(found)} examinations failed" if failed else f"passed all {len(found)} examinations"
        console.print(told, highlight=False)
    return NOT_PASSED if failed else PASSED


def _table(found: tuple[Finding, ...], console: Console, quiet: bool) -> None:
    """Print one line per examination, then the messages of the failed ones."""
    grid = Grid(box=None, pad_edge=False, header_style="bold")
    grid.add_column("examination", overflow="fold")
    grid.add_column("result")
    grid.add_column("error", justify="right")
    grid.add_column("allowed", justify="right")
    for finding in found:
        if not quiet or not finding.passed:
            grid.add_row(escape(finding.name), *_cells(finding))
    if grid.row_count:
        console.print(grid)
    for finding in found:
        if not finding.passed:
            told = f"{finding.name}: {finding.complaint}"
            console.print(escape(told), soft_wrap=True, highlight=False, style="red")


def _cells(finding: Finding) -> tuple[str, str, str]:
    """Text of the result, the error and the allowed error."""
    if not finding.passed:
        return "[red]failed[/]", "", f"{finding.allowed:.0e}" if finding.allowed else ""
    if isnan(finding.error):
        return "not applicable", "", ""
    if not finding.allowed:
        return "[green]passed[/]", "", ""
    return "[green]passed[/]", f"{finding.error:.1e}", f"{finding.allowed:.0e}"
