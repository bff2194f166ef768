"""Every block of commands and every block of Python of the pages does what it says.

Commands that take minutes are given by test_minutes.py, and here looked at; so are those of the gallery, of which this
test reads each scenario.
"""

import pytest

from pages import Command, steps
from reader import ELSEWHERE, GALLERY, PAGES, ROOT, Reader
from softway.apps.cli import main
from softway.apps.cli.commands import app

pytestmark = pytest.mark.slow

SHIPPED = sorted(ROOT.glob("scenarios/*.toml"))
LONG = ("forming", "mechanism", "stops", "view")
"""Pages whose commands together take a minute or more."""


@pytest.fixture(scope="module")
def reader(tmp_path_factory):
    """Who reads all the pages in one folder."""
    return Reader(tmp_path_factory.mktemp("reader")).settle()


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(p, marks=pytest.mark.minutes if p.stem in LONG else [], id=f"{p.parent.name}-{p.stem}")
        for p in PAGES
        if p.name not in ELSEWHERE and any(steps(p))
    ],
)
def test_what_the_page_says_runs(page, reader, monkeypatch):
    monkeypatch.chdir(reader.folder)
    reader.read(page)


def test_the_gallery_runs_every_scenario():
    text = GALLERY.read_text(encoding="utf-8")
    assert [f.name for f in SHIPPED if f"softway run scenarios/{f.name} " not in text] == []


@pytest.mark.few(4)
@pytest.mark.parametrize("file", SHIPPED, ids=lambda file: file.stem)
def test_a_scenario_of_the_gallery_is_right(file):
    """By the command line; tests/scenarios/test_notes.py checks all of them."""
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
