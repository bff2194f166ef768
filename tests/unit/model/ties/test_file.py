"""Ties in a scenario file: the run is audited, and its text has the ties."""

from collections.abc import Callable
from pathlib import Path

import pytest

import softway as sw
from records import differences

TEXT = """
[bodies.frame]
kind = "Solid"
mesh = { kind = "Rectangle", size = [1, 0.5], cells = [4, 4], origin = [0, 0.02] }
material = { kind = "NeoHookean", E = 10, nu = 0.3 }
density = 1
velocity = [0, -0.2]

[bodies.glass]
kind = "Solid"
mesh = { kind = "Rectangle", size = [0.8, 0.2], cells = [6, 2], origin = [0.1, 0.52] }
material = { kind = "NeoHookean", E = 20, nu = 0.3 }
density = 2
velocity = [0, -0.2]

[bodies.floor]
kind = "Tool"
shape = { kind = "HalfSpace", point = [0, 0], normal = [0.1, 1] }

[[contacts]]
between = "all"

[[ties]]
between = ["frame.top", "glass.bottom"]

[time]
end = 1.2
step = 0.02
"""


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> sw.Run:
    """The run that nobody stops."""
    return sw.run(sw.loads(TEXT), tmp_path_factory.mktemp("tied") / "run")


def test_a_run_has_no_findings(whole: sw.Run) -> None:
    scenario, run = sw.loads(TEXT), whole
    assert sw.loads(sw.dumps(scenario)) == scenario
    assert not any(run.events["finding"])
    assert abs(run.history["energy_error"]).max() < 1e-12
    assert run.history["momentum_y"][-1] > 0.0 > run.history["momentum_y"][0]


@pytest.mark.parametrize(
    ("old", "new", "light"),
    [
        ("", "", 8),
        ('between = "all"', 'between = ["frame.bottom", "floor"]', 0),
        ("[0.8, 0.2], cells = [6, 2], origin = [0.1, 0.52]", "[0.5, 0.2], cells = [2, 2], origin = [0.25, 0.52]", 0),
    ],
    ids=["rim touches", "rim left out", "matching"],
)
def test_inertia_that_the_glue_loses_is_noted(old: str, new: str, light: int) -> None:
    """All nodes between the rims of the glue: five of the glass, and three of the frame that it is glued to."""
    text = TEXT.replace(old, new)
    notes = sw.check(sw.loads(text)).notes
    assert [n.where for n in notes] == ["ties[0].between"] * (light > 0)
    if light:
        assert f"{light} of the 12 nodes in the glue have no inertia" in notes[0].problem


@pytest.mark.slow
@pytest.mark.parametrize("asks", [40, 200])
def test_a_cancelled_run_is_resumed_with_the_same_bits(whole: sw.Run, tmp_path: Path, asks: int) -> None:
    """Before the touch and during it, from the text that the run folder keeps."""
    with pytest.raises(sw.Cancelled):
        sw.run(sw.loads(TEXT), tmp_path / "run", cancel=after(asks))
    done = sw.Run(tmp_path / "run").summary["slabs"]
    assert 0 < done < whole.summary["slabs"]
    run = sw.resume(tmp_path / "run")
    assert [r["stopped"] for r in run.provenance["resumed"]] == ["cancelled"]
    assert differences(run.path, whole.path) == []


def after(asks: int) -> Callable[[], bool]:
    """A ``cancel`` that says no so many times."""
    left = iter(range(asks))
    return lambda: next(left, None) is None
