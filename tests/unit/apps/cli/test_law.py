"""softway check-law: tables, exit codes, parameters; and scenarios with laws of the user's own."""

import sys
from pathlib import Path

import pytest

from softway.apps.cli import main
from softway.laws.bulk import Hencky
from softway.scenario.example_law import law_named, sample

OWN = '''
from dataclasses import dataclass
from typing import ClassVar

import softway as sw
from softway.laws.strain_measures import Green
from softway.units import Pascal

@dataclass(frozen=True, slots=True, kw_only=True)
class Wrong:
    """A law whose stress is not the derivative of its energy.

    Examples
    --------
    >>> Wrong(modulus=2.0).stress(None)
    """

    modulus: Pascal
    excess: float = 0.0
    measure: ClassVar[Green] = Green()
    linear: ClassVar[bool] = False

    def inside(self):
        return sw.NeoHookean(E=self.modulus)

    def energy(self, E):
        return self.inside().energy(E)

    def stress(self, E):
        if self.excess > 1.0:
            raise ZeroDivisionError("one over nothing")
        return (1.0 + self.excess) * self.inside().stress(E)

    def tangent(self, E):
        return self.inside().tangent(E)

    def wave_speed(self, density):
        return self.inside().wave_speed(density)

    def youngs(self):
        return self.modulus
'''


@pytest.fixture
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("wrong_law.py").write_text(OWN)
    yield tmp_path
    sys.modules.pop("wrong_law", None)


@pytest.mark.few(2)
@pytest.mark.parametrize("name", ["Hencky", "MooneyRivlin", "LinearOrthotropic", "J2", "NortonHoff", "Stribeck"])
def test_laws_of_softway_pass(name, capsys):
    assert main(["check-law", name]) == 0
    printed = capsys.readouterr().out
    assert f"{name}(" in printed and "passed all" in printed and "failed" not in printed


def test_parameters_are_set_with_units(capsys):
    assert main(["check-law", "Hencky", "--set", "E=210 GPa", "--set", "nu=0.3"]) == 0
    assert str(Hencky(E=2.1e11, nu=0.3)) in capsys.readouterr().out
    assert main(["check-law", "Hencky", "--quiet"]) == 0
    assert capsys.readouterr().out == ""


def test_a_law_of_your_own_that_is_wrong(place, capsys):
    assert main(["check-law", "wrong_law:Wrong"]) == 1
    printed = capsys.readouterr().out
    assert "excess is a number without unit" in printed and "1 of 13 examinations failed" in printed
    assert main(["check-law", "wrong_law:Wrong", "--set", "excess=0.01", "--quiet"]) == 1
    printed = capsys.readouterr().out
    assert "stress is not the derivative of the energy" in printed and "passed" not in printed
    assert main(["check-law", "wrong_law:Wrong", "--set", "excess=2"]) == 1
    assert "ZeroDivisionError: one over nothing" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["NeoHookian"], "did you mean 'NeoHookean'"),
        (["nowhere:Law"], "there is no module 'nowhere'"),
        (["wrong_law:Right"], "has no 'Right'"),
        (["Hencky", "--set", "nu=0.7"], "nu: 0.7 is not between"),
        (["Hencky", "--set", "E=7 m"], "dimension"),
        (["Hencky", "--set", "K=7"], "unknown key"),
    ],
)
def test_bad_input(place, arguments, told, capsys):
    assert main(["check-law", *arguments]) == 2
    assert told in capsys.readouterr().err


def test_parameters_that_are_needed_come_from_the_example():
    assert sample(Hencky) == {"E": 2.5, "nu": 0.25}
    assert law_named("Hencky", ["nu=0.1"]) == Hencky(E=2.5, nu=0.1)


def test_a_run_with_a_law_of_your_own(place):
    text = """
[bodies.bar]
kind = "Solid"
mesh = { kind = "Interval", length = "1 m", cells = 3 }
material = { kind = "wrong_law:Wrong", modulus = "1 Pa" }
density = "1 kg/m^3"
velocity = "0.01 m/s"
[time]
end = "0.2 s"
step = "0.1 s"
"""
    Path("bar.toml").write_text(text)
    assert main(["run", "bar.toml", "--out", "made", "--quiet"]) == 0
    assert 'kind = "wrong_law:Wrong"' in Path("made/scenario.toml").read_text()
    assert Path("made/wrong_law.py").read_text() == OWN
    assert main(["run", "made/scenario.toml", "--out", "again", "--quiet"]) == 0
    assert Path("made/history.csv").read_text() == Path("again/history.csv").read_text()
    Path("bar.toml").write_text(text.replace("wrong_law", "elsewhere.law"))
    assert main(["check", "bar.toml"]) == 2
    assert main(["check", "bar.toml", "--allow-python"]) == 2
