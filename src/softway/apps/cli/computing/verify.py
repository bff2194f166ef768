"""Command verify: the verification suite."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter
from typing import Annotated

from cyclopts import Parameter
from rich.console import Console
from rich.markup import escape
from rich.table import Table as Grid

from softway.apps.cli.output.jobs import counted, processes
from softway.apps.cli.output.options import Quiet
from softway.apps.verify.case import Beside, Case
from softway.apps.verify.catalogue import QUICK, chosen
from softway.apps.verify.page import page
from softway.apps.verify.report import causes, counts, in_json, rows, verdict, writable, write
from softway.apps.verify.result import Result
from softway.apps.verify.suite import Watch, verified

PASSED, NOT_PASSED = 0, 1


def verify(
    ids: tuple[str, ...] = (),
    /,
    *,
    quick: Annotated[bool, Parameter(negative=())] = False,
    list_: Annotated[bool, Parameter(name="--list", negative=())] = False,
    json: Path | None = None,
    out: Path = Path("verification.html"),
    jobs: int | None = None,
    quiet: Quiet = False,
) -> int:
    """Compute cases with a known solution on this machine and compare: a table, and a page with curves.

    The exit code is 1 if a quantity is outside its tolerance and the cause is not known.

    Parameters
    ----------
    ids
        Cases such as A02, or groups such as B; by default all.
    quick
        Compute only cases that take a few seconds each, in less than two minutes together.
    list_
        List the cases and their computing time, without computing them.
    json
        File for the table: a list of case, quantity, reference, value, error, tolerance, pass.
    out
        File for the page, one self-contained HTML file.
    jobs
        Number of parallel processes; by default one per processor.
    quiet
        Print failures only.
    """
    cases, console = chosen(ids, quick=quick), Console()
    if list_:
        _listing(cases, console)
        return PASSED
    number = processes(jobs)
    files = {"--out": writable("--out", out)} | ({"--json": writable("--json", json)} if json else {})
    with _progress(cases, number, Console(quiet=quiet)) as watch:
        results = verified(cases, jobs=number, watch=watch)
    texts = {"--out": page, "--json": in_json}
    for option, file in files.items():
        write(option, file, texts[option](results))
    _show(results, console, quiet)
    if not quiet:
        for file in files.values():
            console.print(escape(str(file)), soft_wrap=True, highlight=False)
    count = counts(results)
    return PASSED if count["passed"] + count["known"] == count["quantities"] else NOT_PASSED


def _listing(cases: Sequence[Case], console: Console) -> None:
    grid = Grid(box=None, pad_edge=False, header_style="bold")
    for head in ("case", "title", "seconds", "quick"):
        grid.add_column(head, justify="right" if head == "seconds" else "left", overflow="fold")
    for case in cases:
        grid.add_row(case.id, escape(case.title), f"{case.seconds:.0f}", "yes" if case.seconds <= QUICK else "")
    console.print(grid)


def _show(results: Sequence[Result], console: Console, quiet: bool) -> None:
    """Print the results, the results of other codes, the failures with their causes, and the number of passed ones."""
    grid = Grid(box=None, pad_edge=False, header_style="bold")
    for head in ("case", "quantity", "reference", "ours", "error", "tolerance", "pass"):
        grid.add_column(head, justify="left" if head in ("case", "quantity") else "right", overflow="fold")
    for row in rows(results):
        if not quiet or not row.passed:
            word = "[green]yes[/]" if row.passed else "[red]NO[/]"
            numbers = (row.reference, row.ours, row.error, row.tolerance)
            grid.add_row(row.case, escape(row.quantity), *numbers, word)
    if grid.row_count:
        console.print(grid)
    if not quiet:
        for beside in (table for result in results for table in result.tables):
            _beside(beside, console)
    for sentence in causes(results):
        console.print(escape(sentence), soft_wrap=True, highlight=False, style="red")
    if not quiet:
        console.print(verdict(results), highlight=False)


def _beside(beside: Beside, console: Console) -> None:
    grid = Grid(box=None, pad_edge=False, header_style="bold", title=escape(beside.title), title_justify="left")
    for k, head in enumerate(beside.heads):
        grid.add_column(escape(head), justify="right" if k else "left", overflow="fold")
    for cells in beside.rows:
        grid.add_row(*map(escape, cells), style="bold" if cells is beside.rows[-1] else "")
    console.print(grid)
    console.print(escape(beside.note), style="dim", highlight=False)


@contextmanager
def _progress(cases: Sequence[Case], jobs: int, console: Console) -> Iterator[Watch | None]:
    """Function to call after each case; ``None`` without an interactive terminal."""
    left = {case.id: case.seconds for case in cases}
    whole, begun = sum(left.values()), perf_counter()
    with counted(len(cases), "cases", f"ETA {whole / jobs:.0f} s", console) as show:
        if show is None:
            yield None
            return

        def watch(result: Result) -> None:
            left.pop(result.case.id)
            rest, gone = sum(left.values()), perf_counter() - begun
            ahead = gone * rest / max(whole - rest, 1e-9)
            show(
                len(cases) - len(left), f"{result.case.id} {'passed' if result.passed else 'FAILED'}, ETA {ahead:.0f} s"
            )

        yield watch
