"""A reader of a page, who does in a folder what it says."""

import os
import shutil
import signal
import subprocess
import sys
import urllib.request
from dataclasses import dataclass, field
from pathlib import Path

from forms import BEGINS, complaint
from pages import Command, File, Python, steps
from softway.apps.cli import main

ROOT = Path(__file__).parents[2]
ELSEWHERE = {"own_law.md"}
"""Pages that a test of their own runs: tests/examples/test_own_law.py."""
GALLERY = ROOT / "docs" / "tutorials" / "gallery.md"
PAGES = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    ROOT / "scenarios" / "README.md",
    *sorted(page for page in ROOT.glob("docs/**/*.md") if "_build" not in page.parts and page != GALLERY),
]
SHELL = (".", "cd", "python3")


@dataclass(frozen=True)
class Reader:
    """Who does nothing twice, and gives commands that take minutes if ``patient``."""

    folder: Path
    patient: bool = False
    done: set[Command] = field(default_factory=set)

    def settle(self) -> "Reader":
        """The reader with the scenarios and examples in the folder."""
        for name in ("scenarios", "examples"):
            (self.folder / name).symlink_to(ROOT / name)
        return self

    def read(self, page: Path) -> None:
        """Do what a page says, in the present folder, which is the reader's."""
        names: dict[str, object] = {}
        for step in steps(page):
            if isinstance(step, Python) and page.stem != "README":  # that of the README: tests/house/test_readme.py
                exec(compile(step.text, page.name, "exec"), names)
            elif isinstance(step, File):
                Path(step.name).write_text(step.text)
            elif isinstance(step, Command) and step not in self.done:
                self.obey(step)
                self.done.add(step)

    def obey(self, command: Command) -> None:
        """Give a command; of those that take long or make an environment look at what they name."""
        first, *others = command.words
        if first == "softway" and (self.patient or not command.long):
            look(others) if others[0] == "view" else self.give(command)
        elif first == "cp":
            shutil.copy(*others)
        else:
            assert first in (*SHELL, *BEGINS) and not complaint(command.words), command

    @staticmethod
    def give(command: Command) -> None:
        """Give a command of softway in this process."""
        assert main(list(command.words[1:])) == command.exit, command


def look(words: list[str]) -> None:
    """Give a command that serves a page until Ctrl-C, or writes one: open the address that it prints, and stop it."""
    environment = {**os.environ, "BROWSER": "true"}
    given = [sys.executable, "-m", "softway", *words]
    with subprocess.Popen(given, stdout=subprocess.PIPE, text=True, env=environment) as served:
        assert served.stdout is not None
        address = served.stdout.readline().split()[0]
        with urllib.request.urlopen(address, timeout=60) as answer:
            assert answer.status in (200, None) and b"<html" in answer.read().lower()
        if not address.startswith("file:"):
            served.send_signal(signal.SIGINT)
        assert served.wait(timeout=60) == 0
