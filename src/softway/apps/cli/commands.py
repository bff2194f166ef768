"""Commands new, check, run, explain and race; the other commands are in the neighbouring modules.

Exit codes: 0 done, 1 a law failed a check or a case missed its reference, 2 wrong input, 3 numerics or storage failed,
4 findings of the audit under --strict, 130 interrupted.
"""

import sys
from collections.abc import Sequence
from functools import partial
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Annotated

from cyclopts import App, CycloptsError, Parameter
from rich.console import Console
from rich.markup import escape

from softway.apps.cli.explain import told
from softway.apps.cli.law import check_law
from softway.apps.cli.materials import materials
from softway.apps.cli.output.failures import failed, unusable
from softway.apps.cli.output.folders import free
from softway.apps.cli.output.log import Verbose, heard, listen
from softway.apps.cli.output.progress import laps_of, progress_of, teller
from softway.apps.cli.output.ranks import among, begun
from softway.apps.cli.output.reading import examined, of_solids
from softway.apps.cli.output.tables import ranking, scales, summary
from softway.apps.cli.plot import plot
from softway.apps.cli.resume import resume
from softway.apps.cli.schema import schema
from softway.apps.cli.show import audit, audited, export, show
from softway.apps.cli.sweep import sweep
from softway.apps.cli.verify import verify
from softway.apps.cli.view import view
from softway.errors import InputError, NumericsError, StorageError
from softway.ranks.launch import ranks_here
from softway.scenario.files import dumps
from softway.scenario.run import run as execute
from softway.scenario.run_ranks import assist
from softway.scenario.text.templates import headline, templates
from softway.studies.processes import raised_again
from softway.studies.race.contest import contest, entrants
from softway.studies.race.report import FILE as RACE
from softway.studies.race.report import record
from softway.studies.race.report import save as save_race

DONE, WRONG_INPUT, FAILED, INTERRUPTED = 0, 2, 3, 130


def _version() -> str:
    try:
        return version("softway")
    except PackageNotFoundError:
        return "not installed"


app = App(
    name="softway",
    help="Dynamic contact of solids, computed from a scenario file.",
    version=_version,
    suppress_keyboard_interrupt=False,
)
app.command(audit)
app.command(show)
app.command(export)
app.command(check_law)
app.command(materials)
app.command(verify)
app.command(plot)
app.command(view)
app.command(resume)
app.command(schema)
app.register_install_completion_command(help="Install shell completion of commands and options.")
app.command(sweep)
Set = Annotated[tuple[str, ...], Parameter(name="--set", negative=())]
Quiet = Annotated[bool, Parameter(name=["--quiet", "-q"], negative=())]
AllowPython = Annotated[bool, Parameter(negative=())]
Strict = Annotated[bool, Parameter(negative=())]


@app.command
def new(
    name: str | None = None,
    *,
    out: Path | None = None,
    list_: Annotated[bool, Parameter(name="--list", negative=())] = False,
) -> None:
    """Write a template scenario to start from.

    Parameters
    ----------
    name
        Name of the template; without a name all templates are listed.
    out
        File to write; by default NAME.toml in this folder.
    list_
        List the templates.
    """
    console, known = Console(), templates()
    if list_ or name is None:
        for key, text in known.items():
            console.print(f"[bold]{escape(key)}[/]  {escape(headline(text))}")
        return
    if name not in known:
        raise InputError("NAME", f"no template '{name}'", f"one of {', '.join(known)}")
    file = out or Path(f"{name}.toml")
    if file.exists():
        raise InputError("--out", f"'{file}' exists", "another name: --out FILE")
    try:
        file.write_text(known[name], encoding="utf-8")
    except OSError as error:
        raise InputError("--out", f"cannot write '{file}': {error.strerror}", "a folder that exists") from None
    console.print(f"{escape(str(file))} written; next: softway run {escape(str(file))} --out runs/{escape(name)}")


@app.command
def check(
    file: Path, /, *, set_: Set = (), quiet: Quiet = False, strict: Strict = False, allow_python: AllowPython = False
) -> None:
    """Check a scenario without computing it, and show its scales.

    Parameters
    ----------
    file
        Scenario in TOML.
    set_
        Change a value of the scenario: path=value; can be repeated.
    quiet
        Print errors only.
    strict
        Refuse a mesh file with cards that are not honoured, such as materials and loads of an input deck.
    allow_python
        Allow module:name in the scenario to run code of installed modules, not only of modules next to the file.
    """
    console = Console(quiet=quiet)
    scales(examined(file, set_, console, allow_python=allow_python, strict=strict), console)


@app.command
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


@app.command
def explain(name: str, /) -> None:
    """Explain a kind, a key or a command: meaning, units, defaults, example.

    Parameters
    ----------
    name
        Kind, key or command, such as Coulomb, density or run.
    """
    told(name, {verb: app[verb].default_command for verb in app if not verb.startswith("-")}, Console())


@app.command
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
    if (folder / RACE).exists() and not overwrite:
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
    for made in save_race(found, folder):
        console.print(escape(str(made)), soft_wrap=True, highlight=False)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit code."""
    errors = Console(stderr=True)
    try:
        with raised_again(), heard(errors):
            code = app(
                sys.argv[1:] if arguments is None else arguments,
                exit_on_error=False,
                print_error=False,
                result_action="return_value",
            )
    except (CycloptsError, InputError) as error:
        return failed(errors, error, WRONG_INPUT)
    except (NumericsError, StorageError) as error:
        return failed(errors, error, FAILED)
    except OSError as error:
        return failed(errors, unusable(error), WRONG_INPUT)
    except MemoryError as error:
        return failed(errors, MemoryError(f"out of memory: {error}\n  try: fewer cells"), FAILED)
    except KeyboardInterrupt:
        errors.print("interrupted")
        return INTERRUPTED
    return code if isinstance(code, int) else DONE
