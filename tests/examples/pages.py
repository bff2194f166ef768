"""The commands and the Python of a page, in their order.

A block ``sh`` holds commands, one on a line; a comment ``# exit 2`` says how one ends if not with 0, and one with the
words *half a minute* or *minutes* that it takes too long for a test. A block ``python`` is run in the names of those
before it, and a block after ``<!-- file: NAME -->`` is saved under that name.
"""

import re
import shlex
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

BLOCK = re.compile(r"^(?:<!-- file: (\S+) -->\n)?```(sh|console|python|toml)\n(.*?)^```", re.MULTILINE | re.DOTALL)
EXIT = re.compile(r"#\s*exit (\d+)\s*$")
LONG = re.compile(r"#.*\b(half a minute|minutes)\b")


@dataclass(frozen=True)
class Command:
    """A line of a shell: its words, how it ends, whether it takes too long."""

    words: tuple[str, ...]
    exit: int
    long: bool


@dataclass(frozen=True)
class Python:
    """A block of Python."""

    text: str


@dataclass(frozen=True)
class File:
    """A block that is saved under a name."""

    name: str
    text: str


def steps(page: Path) -> Iterator[Command | Python | File]:
    """What a reader of the page would do."""
    for name, kind, text in BLOCK.findall(page.read_text(encoding="utf-8")):
        if name:
            yield File(name, text)
        elif kind == "python":
            yield Python(text)
        elif kind != "toml":
            yield from (_command(line) for line in text.splitlines() if line.strip())


def _command(line: str) -> Command:
    words = shlex.split(line.removeprefix("$ "), comments=True)
    found = EXIT.search(line)
    return Command(
        words=tuple(word for word in words if word != "&"),
        exit=int(found[1]) if found else 0,
        long=LONG.search(line) is not None,
    )
