"""Command resume: resume a run that stopped."""

from pathlib import Path

from rich.console import Console

from softway.apps.cli.output.log import Verbose, listen
from softway.apps.cli.output.options import AllowPython, Quiet
from softway.apps.cli.output.progress import progress_of, teller, waiting
from softway.apps.cli.output.tables import summary
from softway.record.run import Run
from softway.record.storage.provenance import DONE
from softway.scenario.checks.check import check
from softway.scenario.run import resume as go_on
from softway.scenario.run import stored


def resume(
    folder: Path,
    /,
    *,
    quiet: Quiet = False,
    verbose: Verbose = False,
    allow_python: AllowPython = False,
) -> None:
    """Resume a run that was killed, interrupted or failed. The results are identical to those of an uninterrupted run.

    Parameters
    ----------
    folder
        Run folder.
    quiet
        Print errors only.
    verbose
        Report automatic choices and rejected slabs (time steps).
    allow_python
        Allow module:name in the scenario to run code of installed modules, not only of modules next to the file.
    """
    listen(verbose)
    stopped, console = Run(folder), Console(quiet=quiet)
    if stopped.stop == DONE:
        console.print(f"already done: nothing is left to compute in {folder}", markup=False, soft_wrap=True)
        return
    with waiting(console, "reading the scenario and building the meshes"):
        checked = check(stored(folder, allow_python))
    with progress_of(checked, console) as progress:
        done = go_on(folder, scenario=checked, progress=progress, tell=teller(console))
    slabs = done.provenance["resumed"][-1]["slabs"]
    console.print(f"resumed after slab {slabs}" if slabs else "resumed from the start", markup=False, soft_wrap=True)
    summary(done, console)
