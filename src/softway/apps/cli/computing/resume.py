"""Command resume: resume a run that stopped."""

import sys
from functools import partial
from pathlib import Path

from rich.console import Console

from softway.apps.cli.output.log import Verbose, listen
from softway.apps.cli.output.options import AllowPython, Quiet
from softway.apps.cli.output.progress import progress_of, teller, waiting
from softway.apps.cli.output.ranks import among, begun
from softway.apps.cli.output.tables import summary
from softway.ranks.launch import ranks_here, together
from softway.record.run import Run
from softway.record.storage.provenance import DONE
from softway.scenario.checks.check import check
from softway.scenario.run import resume as go_on
from softway.scenario.run import stored
from softway.scenario.run_ranks import assist


def resume(
    folder: Path,
    /,
    *,
    quiet: Quiet = False,
    verbose: Verbose = False,
    allow_python: AllowPython = False,
    ranks: int | None = None,
) -> int:
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
    ranks
        Number of processes that continue a run over ranks, any number; by default one, with the same bits
        (docs/reference/runs/cluster.md).
    """
    code = begun(ranks, sys.argv[1:])
    if code is not None:
        return code
    listen(verbose)
    team = ranks_here(ranks)
    console = Console(quiet=quiet or bool(team and team.rank))
    with among(team):
        stopped = together(team, lambda: Run(folder))
        done = stopped.stop == DONE
        if done if team is None else team.told(done):
            console.print(f"already done: nothing is left to compute in {folder}", markup=False, soft_wrap=True)
            return 0
        read = partial(together, team, lambda: check(stored(folder, allow_python)))
        if team is not None and team.rank:
            return assist(team, read, stopped.provenance)
        with waiting(console, "reading the scenario and building the meshes"):
            checked = read()
    with among(team), progress_of(checked, console) as progress:
        ended = go_on(folder, scenario=checked, progress=progress, tell=teller(console), ranks=team)
    slabs = ended.provenance["resumed"][-1]["slabs"]
    console.print(f"resumed after slab {slabs}" if slabs else "resumed from the start", markup=False, soft_wrap=True)
    summary(ended, console)
    return 0
