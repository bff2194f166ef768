"""The demonstration runs in its quick form and prints what it promises."""

import importlib.util
from pathlib import Path

import pytest

DEMO = Path(__file__).parents[2] / "examples" / "demo.py"


@pytest.fixture
def demo(monkeypatch, tmp_path):
    """The module, writing to a temporary folder."""
    monkeypatch.syspath_prepend(str(DEMO.parents[1] / "tests" / "verification" / "tools"))
    spec = importlib.util.spec_from_file_location("demo", DEMO)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    monkeypatch.setattr(module, "OUT", tmp_path)
    return module


@pytest.mark.minutes
def test_the_examples_of_the_paper(demo, tmp_path, capsys):
    demo.show_example_1()
    demo.show_example_2()
    text = capsys.readouterr().out
    assert "contact instant" in text
    assert "u(point of contact, 10)" in text
    for name in ("example_1.png", "example_2.png"):
        assert (tmp_path / name).stat().st_size > 20_000


def test_the_contact_of_the_massless_node(demo):
    """M u'' + K u = 0 of the two inner nodes: the numbers of the table come from its two modes."""
    assert demo.massless_contact() == pytest.approx(2.29721635, abs=1e-8)
