"""Command race: several methods on one scenario."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter
from rich.console import Console
from rich.markup import escape

from softway.apps.cli.output.folders import free
from softway.apps.cli.output.options import AllowPython, Quiet, Set
from softway.apps.cli.output.progress import laps_of
from softway.apps.cli.output.reading import examined, of_solids
from softway.apps.cli.output.tables import ranking, scales
from softway.errors import InputError
from softway.scenario.files import dumps
from softway.studies.race.contest import contest, entrants
from softway.studies.race.report import FILE, record, save


def race(
    file: Path,
    /,
    *,
    methods: Annotated[tuple[str, ...], Parameter(consume_multiple=True, negative=())] = (),
    slabs: int | None = None,
    tolerance: float | None = None,
    out: Path | None = None,
    set_: Set = (),
    quiet: Quiet = False,
    overwrite: Annotated[bool, Parameter(negative=())] = False,
    allow_python: AllowPython = False,
) -> None:
    """Compute a scenario by several methods and compare their iterations, time, energy and penetration.

    Parameters
    ----------
    file
        Scenario in TOML.
    methods
        Methods to compare: plain, accelerated (fixed point), modified, newton, penalty; by default all.
    slabs
        Number of slabs (time steps) to compute; by default all.
    tolerance
        Relative change of velocity below which an iterate is accepted; by default the tolerance of the scenario.
    out
        Folder for race.json and race.png; by default races/ and the name of the file, numbered if that exists.
    set_
        Change a value of the scenario: path=value; can be repeated.
    quiet
        Print errors only.
    overwrite
        Replace an earlier race in the same folder.
    allow_python
        Allow module:name in the scenario to run code of installed modules, not only of modules next to the file.
    """
    folder, console = out or free(Path("races") / file.stem), Console(quiet=quiet)
    checked = of_solids(file, examined(file, set_, console, allow_python=allow_python))
    scenario = checked.scenario
    if (folder / FILE).exists() and not overwrite:
        raise InputError("--out", f"'{folder}' already holds a race", "another folder, or --overwrite")
    if slabs is not None and slabs < 1:
        raise InputError("--slabs", f"{slabs}", "1 or more")
    time, precision = scenario.time, scenario.solver.tolerance if tolerance is None else tolerance
    end = min(time.end, (slabs or checked.slabs) * checked.step)
    names = methods or tuple(entrants(precision))
    scales(checked, console, slabs)
    with laps_of(names, end, console) as watch:
        results = contest(
            checked.model,
            until=end,
            step=checked.step,
            methods=names,
            tolerance=precision,
            weight=time.weight,
            control=time.control,
            watch=watch,
        )
    found = record(results, scenario.title, dumps(scenario))
    ranking(found, console)
    for made in save(found, folder):
        console.print(escape(str(made)), soft_wrap=True, highlight=False)
