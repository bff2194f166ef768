"""Every command and every block of Python in the README, the tutorials and the how-to pages does what it says."""

import re
import shutil
import tomllib
from pathlib import Path

import pytest

from pages import Command, File, Python, steps
from softway.cli import main
from softway.cli.commands import app

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
ELSEWHERE = {"own_law.md"}
"""Pages that a test of their own runs: tests/unit/test_own_law.py."""
PAGES = [ROOT / "README.md", *sorted(ROOT.glob("docs/tutorials/*.md")), *sorted(ROOT.glob("docs/how-to/*.md"))]
NAMED_ONLY = {"view", "sweep"}
"""Verbs that serve until Ctrl-C or start processes of their own: tests of theirs run them."""
SHELL = {".", "cd", "python3"}


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder from which the scenarios of the checkout are seen, and the commands that were done there."""
    folder = tmp_path_factory.mktemp("reader")
    for name in ("scenarios", "examples"):
        (folder / name).symlink_to(ROOT / name)
    return folder, set()


@pytest.mark.parametrize("page", [p for p in PAGES if p.name not in ELSEWHERE], ids=lambda p: p.stem)
def test_what_the_page_says_runs(page, place, monkeypatch, capsys):
    folder, done = place
    monkeypatch.chdir(folder)
    names: dict[str, object] = {}
    for step in steps(page):
        if isinstance(step, Python) and page.stem != "README":  # that of the README: tests/house/test_readme.py
            exec(compile(step.text, page.name, "exec"), names)
        elif isinstance(step, File):
            Path(step.name).write_text(step.text)
        elif isinstance(step, Command) and step not in done:
            obey(step, capsys)
            done.add(step)


def obey(command: Command, capsys) -> None:
    """Run a command, or look for what it names if it takes long, stays, or installs."""
    first, *others = command.words
    if first == "softway":
        assert others[0] in app, command
        if not command.long and others[0] not in NAMED_ONLY:
            assert main(others) == command.exit, (command, capsys.readouterr().err)
    elif first == "cp":
        shutil.copy(*others)
    elif first == "make":
        assert re.search(rf"^{others[0]}:", (ROOT / "Makefile").read_text(), re.MULTILINE), command
    elif first == "python":
        assert (ROOT / others[0]).is_file(), command
    elif first == "pip":
        extras = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
        assert set(re.findall(r"\[(\w+)\]", others[-1])) <= extras.keys(), command
    else:
        assert first in SHELL, command


def test_pages_hold_what_is_looked_for():
    assert sum(len(list(steps(page))) for page in PAGES) > 40
    assert len(list(steps(ROOT / "docs/tutorials/first_impact.md"))) > 10


def test_the_readme_names_every_verb():
    commands = [step.words for step in steps(ROOT / "README.md") if isinstance(step, Command)]
    said = {words[1] for words in commands if words[0] == "softway"}
    assert said == {name for name in app if not name.startswith("-")}


def test_a_command_says_how_it_ends_and_how_long_it_takes(tmp_path):
    page = tmp_path / "page.md"
    page.write_text('```sh\nsoftway check a.toml --set x="1 kg"  # exit 2\nsoftway run a.toml &  # minutes\n```\n')
    assert list(steps(page)) == [
        Command(words=("softway", "check", "a.toml", "--set", "x=1 kg"), exit=2, long=False),
        Command(words=("softway", "run", "a.toml"), exit=0, long=True),
    ]
