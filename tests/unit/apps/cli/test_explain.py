"""The verb ``explain``, and completion in shells."""

import pytest

from softway.apps.cli import main
from softway.apps.cli.commands import app
from softway.scenario.class_index import classes, keys


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("Time", ["kind", "End time [s].", "required", "auto", ">>> Time(end=4.0).step"]),
        ("density", ["key", "Solid", "kg/m^3"]),
        ("copies", ["key of bodies", "at and keys", "lattice"]),
        ("sweep", ["command", "every combination"]),
        ("coulomb", ["Coulomb  kind"]),
        ("Ring", ["Inner radius [m].", "quad4"]),
    ],
)
def test_what_is_told(name: str, told: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", name]) == 0
    out = capsys.readouterr().out
    assert all(words in out for words in told), out


def test_an_unknown_name_has_neighbours(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "Columb"]) == 2
    assert "Coulomb" in capsys.readouterr().err


def test_every_kind_and_key_can_be_explained(capsys: pytest.CaptureFixture[str]) -> None:
    assert len(classes()) > 60
    for name in ("Solid", "Tool", "J2", "Coulomb", "MeshFile", "friction", "cells", *list(keys())[:10]):
        assert main(["explain", name]) == 0, name
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_shells_complete_the_verbs(shell: str) -> None:
    text = app.generate_completion(shell=shell)
    assert all(verb in text for verb in ("sweep", "resume", "--over"))
    assert "--install-completion" in list(app)
