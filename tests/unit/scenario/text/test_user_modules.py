"""Laws of the user's own in a scenario: where they may come from, what is said of mistakes, and their text."""

import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import softway as sw
from softway.errors import InputError
from softway.laws.law import StoredEnergy
from softway.scenario.files import dumps, load
from softway.scenario.hints.units_text import Units
from softway.scenario.text.templates import templates
from softway.scenario.text.user_modules import Modules

UNITS = Units.standard()
OWN = '''
from dataclasses import dataclass
from typing import ClassVar

import softway as sw
from softway.laws.strain_measures import Small
from softway.units import Pascal

ran = True

@dataclass(frozen=True, slots=True, kw_only=True)
class Soft:
    """Hooke's law of a material without lateral contraction.

    Examples
    --------
    >>> Soft(stiffness=3.0)
    """

    stiffness: Pascal
    measure: ClassVar[Small] = Small()
    linear: ClassVar[bool] = True

    def __post_init__(self):
        if self.stiffness <= 0.0:
            raise ValueError("too soft")

    def energy(self, E):
        return sw.LinearElastic(E=self.stiffness).energy(E)

    def stress(self, E):
        return sw.LinearElastic(E=self.stiffness).stress(E)

    def tangent(self, E):
        return sw.LinearElastic(E=self.stiffness).tangent(E)

    def wave_speed(self, density):
        return sw.LinearElastic(E=self.stiffness).wave_speed(density)

    def youngs(self):
        return self.stiffness

@dataclass(frozen=True)
class Half:
    measure: ClassVar[Small] = Small()
    linear: ClassVar[bool] = True
    energy = stress = None

class Plain:
    pass
'''


@pytest.fixture
def place(tmp_path, monkeypatch):
    """A folder with a scenario and its own law; modules imported from it are forgotten afterwards."""
    known = dict(sys.modules)
    ours, own = '{ kind = "LinearElastic", E = "1 Pa" }', '{ kind = "my_law:Soft", stiffness = 1 }'
    text = templates()["bar"].replace(ours, own)
    (tmp_path / "bar.toml").write_text(text)
    (tmp_path / "my_law.py").write_text(OWN)
    yield tmp_path
    for name in set(sys.modules) - set(known):
        if str(tmp_path) in str(getattr(sys.modules[name], "__file__", "")):
            del sys.modules[name]


def bar(place, *changes, **options):
    return load(place / "bar.toml", changes, UNITS, **options).bodies["bar"].material


def test_a_law_beside_the_scenario(place):
    path = list(sys.path)
    law = bar(place, "bodies.bar.material={kind='my_law:Soft', stiffness='2 GPa'}")
    assert type(law).__name__ == "Soft" and law.stiffness == 2e9
    assert sys.path == path


def test_its_text_reads_back_as_the_same(place):
    scenario = load(place / "bar.toml", ["bodies.bar.material={kind='my_law:Soft', stiffness=2}"], UNITS)
    text = dumps(scenario)
    assert 'kind = "my_law:Soft"' in text and 'stiffness = "2.0 Pa"' in text
    (place / "again.toml").write_text(text)
    assert load(place / "again.toml", units=UNITS) == scenario


def test_packages_beside_the_scenario(place):
    (place / "own").mkdir()
    (place / "own" / "__init__.py").write_text("")
    (place / "own" / "helper.py").write_text("from my_law import Soft\n")
    assert bar(place, "bodies.bar.material={kind='own.helper:Soft', stiffness=2}").stiffness == 2.0


def test_two_folders_with_modules_of_one_name(place, tmp_path):
    other = place / "other"
    other.mkdir()
    (other / "bar.toml").write_text((place / "bar.toml").read_text())
    (other / "my_law.py").write_text(OWN.replace("stiffness", "spring"))
    assert bar(place, "bodies.bar.material={kind='my_law:Soft', stiffness=2}").stiffness == 2.0
    assert bar(other, "bodies.bar.material={kind='my_law:Soft', spring=2}").spring == 2.0
    assert bar(place, "bodies.bar.material={kind='my_law:Soft', stiffness=2}").stiffness == 2.0


@pytest.mark.slow
def test_a_run_records_the_module_that_it_was_read_with(place):
    """Also where another scenario has brought one of the same name since, with a law or a function."""
    other = place / "other"
    other.mkdir()
    wall = ["bodies.wall.shape={kind='SignedDistance', function='my_law:near', dim=1}"]
    texts = [OWN + f"def near(x):\n    return {reach} - x[:, 0]\n" for reach in (1.3, 1.4)]
    for folder, text in zip((place, other), texts, strict=True):
        (folder / "bar.toml").write_text((place / "bar.toml").read_text())
        (folder / "my_law.py").write_text(text)
    law, function = "bodies.bar.material={kind='LinearElastic', E=1}", "time.end=0.1"
    for changes in ([*wall, law], [function], [*wall, function]):
        scenarios = [load(folder / "bar.toml", changes, UNITS) for folder in (place, other)]
        runs = [sw.run(scenario) for scenario in scenarios]
        assert [(run.path / "my_law.py").read_text() for run in runs] == texts


def test_scenarios_with_modules_of_one_name_are_read_in_threads(place):
    folders = [place / str(k) for k in range(4)]
    for k, folder in enumerate(folders):
        folder.mkdir()
        (folder / "my_shape.py").write_text(f"import time\ntime.sleep(0.02)\ndef near(x):\n    return {k} - x[:, 0]\n")
        (folder / "bar.toml").write_text(templates()["bar"])

    def gap(k: int) -> float:
        change = "bodies.wall.shape={kind='SignedDistance', function='my_shape:near', dim=1}"
        shape = load(folders[k % 4] / "bar.toml", [change], UNITS).bodies["wall"].shape
        return float(shape.gap(np.zeros((1, 1)))[0])

    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(gap, range(24))) == [float(k % 4) for k in range(24)]


def test_a_copy_of_a_module_is_that_module(place):
    other = place / "other"
    other.mkdir()
    for name in ("bar.toml", "my_law.py"):
        (other / name).write_text((place / name).read_text())
    change = "bodies.bar.material={kind='my_law:Soft', stiffness=2}"
    assert bar(place, change) == bar(other, change)


def test_an_installed_module_needs_leave(place, monkeypatch):
    elsewhere = place / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "installed_law.py").write_text(OWN)
    monkeypatch.syspath_prepend(elsewhere)
    change = "bodies.bar.material={kind='installed_law:Soft', stiffness=2}"
    with pytest.raises(InputError, match="would run Python") as found:
        bar(place, change)
    assert found.value.where == "bodies.bar.material.kind" and "--allow-python" in found.value.remedy
    assert "installed_law" not in sys.modules
    assert bar(place, change, allow_python=True).stiffness == 2.0


@pytest.mark.parametrize(
    ("kind", "problem", "remedy"),
    [
        ("my_law:Sofd", "has no 'Sofd'", "Soft"),
        ("my_law:Plain", "no dataclass", "dataclass"),
        ("my_law:ran", "no dataclass", "dataclass"),
        ("my_law:Half", "is no StoredEnergy", "needs: tangent, wave_speed, youngs"),
        ("my_low:Soft", "would run Python", "my_low.py"),
        ("my_law.inner:Soft", "no module", "my_law.inner"),
        ("broken:Law", "cannot be imported: SyntaxError", "correct the module broken"),
        ("needy:Law", "imports the module 'not_there'", "install"),
        ("statistics:Law", "name of another module", "another name"),
        ("../my_law:Soft", "is not of the form", "module:name"),
        ("my_law:", "is not of the form", "module:name"),
        ("my_law:Soft.ran", "is not of the form", "module:name"),
    ],
)
def test_mistakes_name_their_place(place, kind, problem, remedy):
    (place / "broken.py").write_text("def\n")
    (place / "needy.py").write_text("import not_there\n")
    (place / "statistics.py").write_text(OWN)
    with pytest.raises(InputError, match=f"(?s){problem}.*try:.*{remedy}") as found:
        bar(place, f"bodies.bar.material={{kind='{kind}', stiffness=1}}")
    assert found.value.where == "bodies.bar.material.kind"


@pytest.mark.parametrize(
    ("parameters", "where", "problem"),
    [
        ("kind='my_law:Soft'", "bodies.bar.material.stiffness", "missing"),
        ("kind='my_law:Soft', stiffness='1 m'", "bodies.bar.material.stiffness", "dimension"),
        ("kind='my_law:Soft', stiffnes=1", "bodies.bar.material.stiffnes", "unknown key"),
        ("kind='my_law:Soft', stiffness=0", "bodies.bar.material", "Soft cannot be constructed: ValueError: too soft"),
    ],
)
def test_its_parameters_are_checked_like_ours(place, parameters, where, problem):
    with pytest.raises(InputError, match=problem) as found:
        bar(place, f"bodies.bar.material={{{parameters}}}")
    assert found.value.where == where


def test_functions_of_shapes_need_leave_too(place):
    (place / "shape.py").write_text("def gap(x):\n    return x[:, 0] - 9.0\n")
    change = "bodies.wall.shape={kind='SignedDistance', dim=1, function='shape:gap'}"
    shape = load(place / "bar.toml", [change], UNITS).bodies["wall"].shape
    assert shape.gap(np.array([[10.0]])).tolist() == [1.0]
    with pytest.raises(InputError, match="would run Python"):
        load(place / "bar.toml", [change.replace("shape:gap", "os:getcwd")], UNITS)


def test_text_without_a_folder_runs_nothing(place):
    with pytest.raises(InputError, match="would run Python"):
        Modules().law("my_law:Soft", (StoredEnergy,), "kind")
