"""Command schema: JSON schema of a scenario file, for editors."""

import json
from pathlib import Path

from rich.console import Console
from rich.markup import escape

from softway.errors import InputError
from softway.scenario.json_schema import schema as derived


def schema(*, out: Path | None = None) -> None:
    """Write the JSON schema of a scenario file, with which editors complete and check keys.

    Parameters
    ----------
    out
        File to write; by default the schema is printed.
    """
    text = json.dumps(derived(), indent=2) + "\n"
    if out is None:
        Console().out(text, end="", highlight=False)
        return
    try:
        out.write_text(text, encoding="utf-8")
    except OSError as error:
        raise InputError("--out", f"cannot write '{out}': {error.strerror}", "a folder that exists") from None
    Console().print(
        f"{escape(str(out))} written; first line of a scenario: #:schema {escape(str(out))}", soft_wrap=True
    )
