"""What notebooks show of a scenario, a run and a step."""

import base64
import re
from html import unescape

import softway as sw
from softway.record.conduct import Place, conduct
from softway.scenario.codec import load


def text(html):
    return re.sub(r"<[^>]+>", " ", html)


def test_a_run_is_a_table_and_a_picture(square, bar, tmp_path):
    for fake in (square, bar):
        run = conduct(fake.steps(), fake.opening(), Place(), title="<Made> up")
        html = run._repr_html_()
        assert "20 until 1 s" in text(html) and "1 touch, 1 release" in text(html) and "&lt;Made&gt;" in html
        packed = re.search(r"base64,([^\"]+)", html)[1]
        assert base64.b64decode(packed).startswith(b"\x89PNG") and len(packed) < 150_000


def test_a_run_without_steps_is_a_table(square):
    run = conduct(iter(()), square.opening(), Place())
    html = run._repr_html_()
    assert "<img" not in html and "done" in html


def test_a_step_is_a_table(square):
    step = next(s for s in square.steps() if s.events)
    shown = text(step._repr_html_())
    assert "touch of node 0" in shown and "part.surface-floor" in shown and "Slab from 0.35 s to 0.4 s" in shown


def test_a_scenario_is_a_table(pytestconfig):
    for file in sorted((pytestconfig.rootpath / "scenarios").glob("*.toml")):
        scenario = load(file)
        shown = unescape(text(scenario._repr_html_()))
        assert scenario.title in shown and all(name in shown for name in scenario.bodies)
    assert isinstance(scenario, sw.Scenario)
