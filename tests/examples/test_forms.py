"""No page of the checkout speaks of a command that there is not: verbs, options, files, targets, extras."""

from pathlib import Path

import pytest

from forms import ROOT, commands, complaint

PAGES = [
    *ROOT.glob("*.md"),
    *ROOT.glob("scenarios/*.md"),
    *(page for page in ROOT.glob("docs/**/*.md") if "_build" not in page.parts),
]


@pytest.mark.parametrize("page", sorted(PAGES), ids=lambda page: str(page.relative_to(ROOT)))
def test_commands_of_a_page_could_be_given(page):
    wrong = {" ".join(words): found for words in commands(page) if (found := complaint(words))}
    assert wrong == {}


def test_many_commands_are_found():
    assert len({words for page in PAGES for words in commands(page)}) > 100


@pytest.mark.parametrize(
    "command",
    [
        "softway chek bar.toml",
        "softway run bar.toml --verbos",
        "softway run scenarios/none.toml",
        "make nothing",
        "python benchmarks/none.py",
        "python benchmarks/run.py --no-such-option",
        "pip install .[none]",
    ],
)
def test_a_wrong_one_is_noticed(command):
    assert complaint(tuple(command.split()))


def test_sentences_are_read(tmp_path):
    page = Path(tmp_path / "page.md")
    page.write_text("Say `softway check FILE | verify --quick` or `make docs`; not `make`.\n")
    words = [("softway", "check", "FILE"), ("softway", "verify", "--quick"), ("make", "docs"), ("make",)]
    assert list(commands(page)) == words
