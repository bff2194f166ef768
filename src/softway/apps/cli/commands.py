"""The application ``softway``: its commands, each loaded when it is called, and its exit codes.

Exit codes: 0 done, 1 a law failed a check or a case missed its reference, 2 wrong input, 3 numerics or storage failed,
4 findings of the audit under --strict, 130 interrupted.
"""

import ast
import sys
from ast import FunctionDef
from collections.abc import Sequence
from importlib import resources
from importlib.metadata import PackageNotFoundError, version

from cyclopts import App, CycloptsError
from rich.console import Console

from softway.apps.cli.output.failures import failed, unusable
from softway.apps.cli.output.log import heard
from softway.errors import InputError, NumericsError, StorageError
from softway.interrupts import raised_again

DONE, WRONG_INPUT, FAILED, INTERRUPTED = 0, 2, 3, 130
COMMANDS = {
    "new": "reference.new:new",
    "check": "computing.check:check",
    "run": "computing.run:run",
    "resume": "computing.resume:resume",
    "sweep": "computing.sweep:sweep",
    "race": "computing.race:race",
    "verify": "computing.verify:verify",
    "show": "results.show:show",
    "export": "results.show:export",
    "audit": "results.show:audit",
    "plot": "results.plot:plot",
    "view": "results.view:view",
    "explain": "reference.explain:explain",
    "check-law": "reference.law:check_law",
    "materials": "reference.materials:materials",
    "schema": "reference.schema:schema",
}
"""Module, from this folder, and function of each command."""


def _version() -> str:
    try:
        return version("softway")
    except PackageNotFoundError:
        return "not installed"


def _description(module: str, function: str) -> str:
    """Description of a command from its docstring, which is read without loading what the command needs."""
    source = resources.files("softway.apps.cli").joinpath(f"{module.replace('.', '/')}.py").read_text(encoding="utf-8")
    (found,) = (node for node in ast.parse(source).body if isinstance(node, FunctionDef) and node.name == function)
    return (ast.get_docstring(found) or "").partition("\n\nParameters\n")[0]


def application(described: bool) -> App:
    """The application; its own help shows what each command does, which needs the sources of all commands."""
    made = App(
        name="softway",
        help="Dynamic contact of solids, computed from a scenario file.",
        version=_version,
        suppress_keyboard_interrupt=False,
    )
    for name, place in COMMANDS.items():
        about = {"help": _description(*place.split(":"))} if described else {}
        made.command(f"softway.apps.cli.{place}", name=name, **about)
    made.register_install_completion_command(help="Install shell completion of commands and options.")
    return made


app = application(described=False)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit code."""
    errors, given = Console(stderr=True), list(sys.argv[1:] if arguments is None else arguments)
    try:
        with raised_again(), heard(errors):
            code = (app if given and given[0] in COMMANDS else application(described=True))(
                given,
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
