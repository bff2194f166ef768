"""Every block of commands and every block of Python of the pages does what it says.

Commands that take minutes, those of the gallery among them, are looked at by test_forms.py alone; of the scenarios of
the gallery this test reads each.
"""

import shutil
from pathlib import Path

import pytest

from forms import BEGINS, complaint
from pages import Command, File, Python, steps
from softway.cli import main
from softway.cli.commands import app

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
ELSEWHERE = {"own_law.md"}
"""Pages that a test of their own runs: tests/unit/test_own_law.py."""
GALLERY = ROOT / "docs" / "gallery.md"
PAGES = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    ROOT / "scenarios" / "README.md",
    *sorted(page for page in ROOT.glob("docs/**/*.md") if "_build" not in page.parts and page != GALLERY),
]
NAMED_ONLY = {"view", "sweep"}
"""Verbs that serve until Ctrl-C or start processes of their own: tests of theirs run them."""
SHELL = (".", "cd", "python3")


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder from which the scenarios of the checkout are seen, and the commands that were done there."""
    folder = tmp_path_factory.mktemp("reader")
    for name in ("scenarios", "examples"):
        (folder / name).symlink_to(ROOT / name)
    return folder, set()


@pytest.mark.parametrize(
    "page", [p for p in PAGES if p.name not in ELSEWHERE and any(steps(p))], ids=lambda p: f"{p.parent.name}-{p.stem}"
)
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
    """Run a command; if it takes long, stays, makes an environment or measures, look at what it names."""
    first, *others = command.words
    if first == "softway" and not command.long and others[0] not in NAMED_ONLY:
        assert main(others) == command.exit, (command, capsys.readouterr().err)
    elif first == "cp":
        shutil.copy(*others)
    else:
        assert first in (*SHELL, *BEGINS) and not complaint(command.words), command


@pytest.mark.parametrize("file", sorted(ROOT.glob("scenarios/*.toml")), ids=lambda file: file.stem)
def test_a_scenario_of_the_gallery_is_right(file):
    assert f"softway run scenarios/{file.name} " in GALLERY.read_text(encoding="utf-8")
    assert main(["check", str(file), "--quiet"]) == 0


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
