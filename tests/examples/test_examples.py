"""Examples of the gallery run: their assertions hold, they print figures and draw pictures.  ``make docs`` runs all of
them.
"""

import runpy
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

pytestmark = pytest.mark.slow

EXAMPLES = sorted((Path(__file__).parents[2] / "examples" / "gallery").rglob("*.py"))


@pytest.mark.few(4)
@pytest.mark.parametrize(
    "example",
    [
        pytest.param(e, marks=pytest.mark.minutes if e.stem in ("finer_meshes", "upsetting") else [], id=e.stem)
        for e in EXAMPLES
    ],
)
def test_an_example_runs(example, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    try:
        runpy.run_path(str(example), run_name="__main__")
        assert plt.get_fignums()
        assert any(character.isdigit() for character in capsys.readouterr().out)
    finally:
        plt.close("all")
    assert not list(tmp_path.iterdir())
