"""The verb over the verification suite."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter
from typing import Annotated

from cyclopts import Parameter
from rich.console import Console
from rich.markup import escape
from rich.table import Table as Grid

from softway.cli.jobs import counted, processes
from softway.verify.case import Beside, Case
from softway.verify.catalogue import QUICK, chosen
from softway.verify.page import page
from softway.verify.report import causes, counts, in_json, rows, verdict, writable, write
from softway.verify.result import Result
from softway.verify.suite import Watch, verified

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
    quiet: Annotated[bool, Parameter(name=["--quiet", "-q"], negative=())] = False,
) -> int:
    """Compute cases whose solution is known, on this machine, and compare: a table, and a page with curves.

    The exit code is 1 if a quantity is outside its tolerance for no cause that is known.

    Parameters
    ----------
    ids
        Cases, as A02, or groups, as B; by default all.
    quick
        Only cases of a few seconds: the suite in less than two minutes.
    list_
        List the cases and how long each takes, and compute nothing.
    json
        File for the table: a list of case, quantity, reference, value, error, tolerance, pass.
    out
        File for the page, one HTML file that needs no other.
    jobs
        Processes beside each other; by default one for each processor.
    quiet
        Print only what failed.
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
    """The table, the figures of others, what failed and why, and how many passed."""
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
    """What to call with each result; ``None`` where nobody watches."""
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
