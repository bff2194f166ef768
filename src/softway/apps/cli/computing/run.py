"""Command run: compute a scenario."""

import sys
from functools import partial
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter
from rich.console import Console
from rich.markup import escape

from softway.apps.cli.output.folders import free
from softway.apps.cli.output.log import Verbose, listen
from softway.apps.cli.output.options import AllowPython, Quiet, Set, Strict
from softway.apps.cli.output.progress import progress_of, teller
from softway.apps.cli.output.ranks import among, begun
from softway.apps.cli.output.reading import examined
from softway.apps.cli.output.tables import scales, summary
from softway.apps.cli.results.show import audited
from softway.errors import NumericsError
from softway.ranks.launch import ranks_here
from softway.scenario.run import run as execute
from softway.scenario.run_ranks import assist


def run(
    file: Path,
    /,
    *,
    out: Path | None = None,
    set_: Set = (),
    quiet: Quiet = False,
    verbose: Verbose = False,
    overwrite: Annotated[bool, Parameter(negative=())] = False,
    strict: Strict = False,
    allow_python: AllowPython = False,
    ranks: int | None = None,
) -> int:
    """Compute a scenario.

    Parameters
    ----------
    file
        Scenario in TOML.
    out
        Folder to create for the records; by default runs/ and the name of the file, numbered if that exists.
    set_
        Change a value of the scenario: path=value; can be repeated.
    quiet
        Print errors only.
    verbose
        Report automatic choices and rejected slabs (time steps).
    overwrite
        Replace an earlier run in the same folder.
    strict
        Refuse a mesh file with cards that are not honoured, such as materials and loads of an input deck, and exit with
        code 4 if the audit of the run found overlaps, inverted cells or balances that miss.
    allow_python
        Allow module:name in the scenario to run code of installed modules, not only of modules next to the file.
    ranks
        Number of processes that compute it together; by default that of mpirun (docs/reference/runs/cluster.md).
    """
    if (code := begun(ranks, sys.argv[1:])) is not None:
        return code
    listen(verbose)
    folder, team = out or free(Path("runs") / file.stem), ranks_here(ranks)
    console = Console(quiet=quiet or bool(team and team.rank))
    read = partial(examined, file, set_, console, allow_python=allow_python, strict=strict, ranks=team)
    with among(team):
        if team is not None and team.rank:
            return assist(team, read)
        scales(checked := read(), console)
    try:
        with among(team), progress_of(checked, console) as progress:
            tell = teller(console)
            done = execute(checked, folder, progress=progress, tell=tell, overwrite=overwrite, ranks=team)
    except (NumericsError, KeyboardInterrupt):
        if folder.is_dir():
            name = escape(str(folder))
            Console(stderr=True).print(f"results until then: {name}", soft_wrap=True)
            Console(stderr=True).print(f"resume with: softway resume {name}", soft_wrap=True)
        raise
    summary(done, console)
    return audited(done, strict=strict, quiet=quiet)
