"""Verbs over a scenario: new, check, run, show, race; the others come from the files beside this one.

Exit codes: 0 done, 1 a law failed its examination or a case missed its reference, 2 input wrong, 3 numerics or
storage failed, 130 interrupted.
"""

import sys
from collections.abc import Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Annotated

from cyclopts import App, CycloptsError, Parameter
from rich.console import Console
from rich.markup import escape

from softway.cli.explain import told
from softway.cli.folders import free
from softway.cli.law import check_law
from softway.cli.log import Verbose, heard, listen
from softway.cli.materials import materials
from softway.cli.plot import plot
from softway.cli.progress import laps_of, progress_of
from softway.cli.reading import examined
from softway.cli.resume import resume
from softway.cli.schema import schema
from softway.cli.sweep import sweep
from softway.cli.tables import ranking, scales, summary
from softway.cli.verify import verify
from softway.cli.view import view
from softway.errors import InputError, NumericsError, StorageError
from softway.execute import run as execute
from softway.race.contest import contest, entrants
from softway.race.report import FILE as RACE
from softway.race.report import record
from softway.race.report import save as save_race
from softway.record.run import Run
from softway.scenario.codec import resolved
from softway.scenario.templates import templates

DONE, WRONG_INPUT, FAILED, INTERRUPTED = 0, 2, 3, 130


def _version() -> str:
    try:
        return version("softway")
    except PackageNotFoundError:
        return "not installed"


app = App(
    name="softway",
    help="Transient contact of solids, from a scenario file.",
    version=_version,
    suppress_keyboard_interrupt=False,
)
app.command(check_law)
app.command(materials)
app.command(verify)
app.command(plot)
app.command(view)
app.command(resume)
app.command(schema)
app.register_install_completion_command(help="Let this shell complete verbs and options.")
app.command(sweep)
Set = Annotated[tuple[str, ...], Parameter(name="--set", negative=())]
Quiet = Annotated[bool, Parameter(name=["--quiet", "-q"], negative=())]
AllowPython = Annotated[bool, Parameter(negative=())]


@app.command
def new(
    name: str | None = None,
    *,
    out: Path | None = None,
    list_: Annotated[bool, Parameter(name="--list", negative=())] = False,
) -> None:
    """Write a scenario to start from.

    Parameters
    ----------
    name
        Which one; without a name they are listed.
    out
        File to write, by default NAME.toml here.
    list_
        List what there is.
    """
    console, known = Console(), templates()
    if list_ or name is None:
        for key, text in known.items():
            console.print(f"[bold]{escape(key)}[/]  {escape(_headline(text))}")
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
def check(file: Path, /, *, set_: Set = (), quiet: Quiet = False, allow_python: AllowPython = False) -> None:
    """Look for every mistake in a scenario without computing, and show its scales.

    Parameters
    ----------
    file
        Scenario in TOML.
    set_
        Change before reading: path=value, any number of times.
    quiet
        Print nothing when all is right.
    allow_python
        Let module:name in the scenario run code of installed modules, not only of those beside the file.
    """
    console = Console(quiet=quiet)
    scales(examined(file, set_, console, allow_python=allow_python), console)


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
    allow_python: AllowPython = False,
) -> None:
    """Compute a scenario.

    Parameters
    ----------
    file
        Scenario in TOML.
    out
        Folder to make for the records; by default runs/ and the name of the file, numbered when that exists.
    set_
        Change before reading: path=value, any number of times.
    quiet
        Print errors only.
    verbose
        Tell what is chosen and which slabs are rejected.
    overwrite
        Replace an earlier run of the same name.
    allow_python
        Let module:name in the scenario run code of installed modules, not only of those beside the file.
    """
    listen(verbose)
    folder, console = out or free(Path("runs") / file.stem), Console(quiet=quiet)
    checked = examined(file, set_, console, allow_python=allow_python)
    scales(checked, console)
    try:
        with progress_of(checked, console) as progress:
            done = execute(checked, folder, progress=progress, overwrite=overwrite)
    except (NumericsError, KeyboardInterrupt):
        if folder.is_dir():
            name = escape(str(folder))
            Console(stderr=True).print(f"what was computed until then: {name}", soft_wrap=True)
            Console(stderr=True).print(f"go on with: softway resume {name}", soft_wrap=True)
        raise
    summary(done, console)


@app.command
def show(folder: Path, /) -> None:
    """Show the summary of a run, also of one that goes on or was interrupted.

    Parameters
    ----------
    folder
        Run folder.
    """
    summary(Run(folder), Console())


@app.command
def explain(name: str, /) -> None:
    """Tell what a kind, a key or a command is: meaning, units, defaults, example.

    Parameters
    ----------
    name
        Such as Coulomb, density or run.
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
        Some of plain, accelerated (fixed point), modified, newton, penalty; by default all.
    slabs
        Only so many of the first slabs.
    tolerance
        Relative change of velocity at which iterates are accepted; by default that of the scenario's solver.
    out
        Folder for race.json and race.png; by default races/ and the name of the file, numbered when that exists.
    set_
        Change before reading: path=value, any number of times.
    quiet
        Print errors only.
    overwrite
        Replace an earlier race of the same name.
    allow_python
        Let module:name in the scenario run code of installed modules, not only of those beside the file.
    """
    folder, console = out or free(Path("races") / file.stem), Console(quiet=quiet)
    checked = examined(file, set_, console, allow_python=allow_python)
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
    found = record(results, scenario.title, resolved(scenario))
    ranking(found, console)
    for made in save_race(found, folder):
        console.print(escape(str(made)), soft_wrap=True, highlight=False)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    errors = Console(stderr=True)
    try:
        with heard(errors):
            code = app(
                sys.argv[1:] if arguments is None else arguments,
                exit_on_error=False,
                print_error=False,
                result_action="return_value",
            )
    except (CycloptsError, InputError) as error:
        return _failed(errors, error, WRONG_INPUT)
    except (NumericsError, StorageError) as error:
        return _failed(errors, error, FAILED)
    except MemoryError as error:
        return _failed(errors, MemoryError(f"no memory is left: {error}\n  try: fewer cells"), FAILED)
    except KeyboardInterrupt:
        errors.print("interrupted")
        return INTERRUPTED
    return code if isinstance(code, int) else DONE


def _failed(console: Console, error: Exception, code: int) -> int:
    told = str(error)
    if isinstance(error, CycloptsError):
        told += f"\n  try: {' '.join(('softway', *(error.command_chain or ()), '--help'))}"
    console.print(f"[bold red]error[/] {escape(told)}", soft_wrap=True, highlight=False)
    return code


def _headline(text: str) -> str:
    """First comment of a template, or its title."""
    first = next((line for line in text.splitlines() if line.startswith(("#", "title"))), "")
    return first.lstrip("# ").removeprefix("title").strip(' ="')
