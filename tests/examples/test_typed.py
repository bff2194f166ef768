"""Programs that use the package are checked by mypy with all its rules: the Python of the page for them, and calls of
every argument that they have.
"""

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import softway
from pages import Python, steps

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
CLIENT = """
import threading
from pathlib import Path

import softway as sw


def watch(now: sw.Progress) -> None:
    figures: tuple[float, float, int, float, float] = (now.fraction, now.left, now.slabs, now.wall, now.pace)
    error: float = now.step.ledger.energy_error
    print(figures, error, [event.kind for event in now.step.events])


def main(file: Path) -> None:
    off = threading.Event()
    scenario: sw.Scenario = sw.load(file, ["time.end=1 s"])
    run: sw.Run = sw.run(scenario, "out", progress=watch, cancel=off.is_set, overwrite=True)
    run = sw.resume(run.path, scenario=scenario, progress=watch, cancel=lambda: False)
    print(run.history["time"].max(), run.summary["slabs"], run.stop.reason, len(run.fields))
    scene = sw.Scene(bodies=scenario.scene.bodies, contacts=scenario.contacts)
    for step in sw.march(sw.build(scene), until=1.0, step="auto", method=sw.Newton(), cancel=off.is_set):
        print(step.after.time, step.march_state.slabs)
    table: sw.studies.Sweep = sw.sweep(file, {"time.end": ["1 s", "2 s"]}, jobs=2, cancel=off.is_set)
    print([row.numbers["slabs"] for row in table.rows], table.failed)
    try:
        print(sw.dumps(scenario))
    except sw.InputError as error:
        print(error.where, error.problem, error.remedy)
    except (sw.NumericsError, sw.StorageError, sw.Cancelled):
        raise


main(Path("bar.toml"))
"""
WRONG = """
import softway as sw

sw.run(1.0)
sw.march(sw.Scene(bodies={}), until="late")


def watch(step: sw.Step) -> None:
    print(step.after.time)


def wanted(scenario: sw.Scenario) -> None:
    sw.run(scenario, progress=watch)
    sw.run(scenario, cancel=True)
    sw.no_such_thing()
"""


@pytest.fixture(scope="module")
def checked(tmp_path_factory):
    """What mypy says of some programs, each by the lines of its errors."""
    folder = tmp_path_factory.mktemp("typed")
    page = "\n".join(s.text for s in steps(ROOT / "docs/how-to/embed.md") if isinstance(s, Python))
    for name, text in (("page", page), ("client", CLIENT), ("wrong", WRONG)):
        (folder / f"{name}.py").write_text(text)
    command = [sys.executable, "-m", "mypy", "--strict", "--config-file=", "page.py", "client.py", "wrong.py"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert not done.stderr, done.stderr
    return [line for line in done.stdout.splitlines() if " error: " in line]


def test_programs_that_are_right_pass(checked):
    assert [line for line in checked if not line.startswith("wrong.py")] == []


def test_programs_that_are_wrong_do_not(checked):
    lines = {int(line.split(":")[1]) for line in checked if line.startswith("wrong.py")}
    assert lines == {n for n, text in enumerate(WRONG.splitlines(), 1) if "sw." in text and "def" not in text}


def test_the_mark_is_there_and_travels():
    """Beside the package, and in what hatch packs: all of the folder, of which nothing is left out."""
    mark = Path(softway.__file__).with_name("py.typed")
    build = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["hatch"]["build"]
    assert mark.is_file() and not mark.read_bytes()
    assert build["targets"]["wheel"] == {"packages": ["src/softway"]} and "src" in build["targets"]["sdist"]["include"]
    assert build.keys() == {"targets"} and "py.typed" not in (ROOT / ".gitignore").read_text()
