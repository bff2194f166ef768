"""The verb ``verify``: its table, its files and its exit codes."""

import json
from pathlib import Path

import pytest

from softway.apps.cli import main


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder to work in."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_case_that_passes(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "A01", "--json", "table.json"]) == 0
    told = capsys.readouterr().out
    assert "3 of 3 quantities of 1 cases are within their tolerance" in told
    assert {p.name for p in here.iterdir()} == {"verification.html", "table.json"}
    assert [line["pass"] for line in json.loads((here / "table.json").read_text())] == [True] * 3


def test_the_list_computes_nothing(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "--list"]) == 0
    assert "A01" in capsys.readouterr().out
    assert not list(here.iterdir())


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["A0x"], "known: A01, A02"),
        (["A01", "--jobs", "0"], "--jobs"),
        (["A01", "--out", "nowhere/page.html"], "there is no folder"),
        (["A01", "--json", "."], "is a folder"),
    ],
)
def test_wrong_words(words: list[str], told: str, here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", *words]) == 2
    assert told in capsys.readouterr().err
    assert not list(here.iterdir())


@pytest.mark.slow
def test_a_miss_with_a_known_cause_is_told_and_no_failure(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Hertz's half-space in place of a ball."""
    assert main(["verify", "B04", "--quiet", "--json", "table.json"]) == 0
    assert "B04" in capsys.readouterr().out
    assert not all(line["pass"] for line in json.loads(Path("table.json").read_text()))


def test_a_case_that_fails(here: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    from softway.apps.verify import Case

    monkeypatch.setattr(
        "softway.apps.cli.computing.verify.chosen", lambda *_, **__: (Case(id="A01", module="nowhere", seconds=1.0),)
    )
    assert main(["verify", "--quiet"]) == 1
    assert "No module named 'nowhere'" in capsys.readouterr().out
