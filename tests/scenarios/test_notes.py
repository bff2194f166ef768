"""Notes of the check on shipped scenarios: each is explained where the scenario is, with its numbers."""

import re
from pathlib import Path

import pytest

from softway.scenario.checks.check import check
from softway.scenario.files import load
from variants import SCENARIOS

SAID = "`check` notes that "
FILES = sorted(SCENARIOS.glob("*.toml"))


def explained(file: Path) -> str:
    """Sentence of the comment at the top on the notes of the check; empty without one."""
    text = file.read_text(encoding="utf-8").partition("title")[0]
    comment = " ".join(line.lstrip("# ") for line in text.splitlines())
    return comment.partition(SAID)[2].partition(". ")[0]


def measured(problem: str) -> list[str]:
    """Words of a note that a comment repeats: shares, factors, and walls that are computed otherwise than given."""
    shares = [f"{share} %" for share in re.findall(r"(\d+)%", problem)]
    factors = re.findall(r"[\d.]+ times", problem)
    return shares + factors + re.findall("one cell thick", problem)


@pytest.mark.slow
@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_the_comment_explains_each_note_of_the_check(file: Path) -> None:
    """It names the body, or the contact, and what a note measures; without notes there is no explanation."""
    checked, told = check(load(file)), explained(file)
    assert checked.slabs >= 1
    notes = checked.notes
    assert bool(notes) == bool(told), [str(note) for note in notes]
    for note in notes:
        words = measured(note.problem)
        assert words, f"say here how a comment explains: {note}"
        assert all(word in told for word in words), f"{note}\n{told}"
        assert note.where.split(".")[1] in told, f"{note}\n{told}"
