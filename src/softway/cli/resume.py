"""softway resume: go on with a run that stopped."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter
from rich.console import Console

from softway.cli.log import Verbose, listen
from softway.cli.progress import progress_of, waiting
from softway.cli.tables import summary
from softway.execute import resume as go_on
from softway.execute import stored
from softway.record.checkpoint import listed
from softway.record.provenance import DONE
from softway.record.run import Run
from softway.scenario.check import check


def resume(
    folder: Path,
    /,
    *,
    quiet: Annotated[bool, Parameter(name=["--quiet", "-q"], negative=())] = False,
    verbose: Verbose = False,
    allow_python: Annotated[bool, Parameter(negative=())] = False,
) -> None:
    """Go on with a run that was killed, interrupted or failed; it ends with the same digits as one that never stopped.

    Parameters
    ----------
    folder
        Run folder.
    quiet
        Print errors only.
    verbose
        Tell what is chosen and which slabs are rejected.
    allow_python
        Let module:name in the scenario run code of installed modules, not only of those beside the file.
    """
    listen(verbose)
    stopped, console = Run(folder), Console(quiet=quiet)
    if stopped.stop == DONE:
        console.print(f"done already: nothing is left to compute in {folder}", markup=False, soft_wrap=True)
        return
    with waiting(console, "reading the scenario, building its meshes"):
        checked, known = check(stored(folder, allow_python)), listed(folder)
    console.print(f"goes on from {known[0] if known else 'the start'}", markup=False, soft_wrap=True)
    with progress_of(checked, console) as progress:
        done = go_on(folder, scenario=checked, progress=progress)
    summary(done, console)
