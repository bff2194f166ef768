"""Command new: a template scenario to start from."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter
from rich.console import Console
from rich.markup import escape

from softway.errors import InputError
from softway.scenario.text.templates import headline, templates


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
