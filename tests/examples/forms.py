"""Whether a command of a page could be given: its verb, its options, the files and targets that it names.

A word in capitals stands for what a reader puts there.
"""

import re
import shlex
import tomllib
from collections.abc import Iterator
from pathlib import Path

from cyclopts import CycloptsError

from pages import Command, steps
from softway.apps.cli.commands import app

ROOT = Path(__file__).parents[2]
BEGINS = ("softway", "make", "python", "pytest", "pip", ".ci/run")
SPAN = re.compile(rf"`((?:{'|'.join(map(re.escape, BEGINS))})(?: [^`]*)?)`")
MADE = ("runs/", "sweeps/", "demo/", "docs/_build/")
"""What commands before it write."""


def commands(page: Path) -> Iterator[tuple[str, ...]]:
    """The words of every command in blocks and sentences of a page."""
    yield from (step.words for step in steps(page) if isinstance(step, Command))
    for span in SPAN.findall(re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)):
        first, *others = span.split(" | ")
        program = first.partition(" ")[0]
        yield from (
            tuple(shlex.split(f"{program} {other}" if k else other)) for k, other in enumerate([first, *others])
        )


def complaint(words: tuple[str, ...]) -> str:
    """What is wrong with a command; nothing if it could be given."""
    first, others = words[0], list(words[1:])
    if not others or others[0].isupper():
        return ""
    if first == "softway":
        return _of_softway(others)
    if first == "make":
        targets = (ROOT / "Makefile").read_text(encoding="utf-8")
        return "" if re.search(rf"^{others[0]}:", targets, re.MULTILINE) else "no such target"
    if first in ("python", "pytest"):
        return _of_a_script(others)
    if first == "pip":
        known = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
        return "" if set(re.findall(r"\[([\w,]+)\]", others[-1])) <= known.keys() else "no such extra"
    return ""


def _of_softway(words: list[str]) -> str:
    """The command line parses it, where more than a verb is said."""
    if words[0].startswith("--"):
        return "" if words[0] in ("--help", "--version", "--install-completion") else "no such option"
    if words[0] not in app:
        return "no such verb"
    lost = [word for word in words[1:] if word.startswith("scenarios/") and not (ROOT / word).is_file()]
    if lost or len(words) == 1 or "--help" in words:
        return f"no file {lost}" if lost else ""
    if len(words) == 2 and words[1].startswith("-"):  # an option that is spoken of, without what the verb needs
        return (
            "" if any(words[1] in argument.names for argument in app[words[0]].assemble_argument_collection()) else "?"
        )
    try:
        app.parse_args(words, print_error=False, exit_on_error=False)
    except CycloptsError as error:
        return str(error)
    return ""


def _of_a_script(words: list[str]) -> str:
    """The file is there, and its text knows the options."""
    if words[0].startswith("-"):
        return ""
    file = ROOT / words[0]
    if not file.exists():
        return "no such file"
    text = file.read_text(encoding="utf-8") if file.is_file() else ""
    options = [word for word in words[1:] if word.startswith("--")]
    return " ".join(f"no option {option}" for option in options if text and f'"{option}"' not in text)
