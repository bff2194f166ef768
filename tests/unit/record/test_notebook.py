"""What notebooks show of a scenario, a run and a step."""

import base64
import re
from dataclasses import replace
from html import unescape

import pytest

import softway as sw
from softway.record.conduct import RunFolder, record_run
from softway.record.storage.provenance import Stop
from softway.scenario.files import load
from softway.studies.sweep.rows import Row, Sweep


def text(html):
    return re.sub(r"<[^>]+>", " ", html)


def test_a_run_is_a_table_and_a_picture(square, bar, tmp_path):
    for fake in (square, bar):
        run = record_run(fake.steps(), fake.opening(), RunFolder(), title="<Made> up")
        html = run._repr_html_()
        assert "20 until 1 s" in text(html) and "1 touch, 1 release" in text(html) and "&lt;Made&gt;" in html
        packed = re.search(r"base64,([^\"]+)", html)[1]
        assert base64.b64decode(packed).startswith(b"\x89PNG") and len(packed) < 150_000


def test_a_run_without_steps_is_a_table(square):
    run = record_run(iter(()), square.opening(), RunFolder())
    html = run._repr_html_()
    assert "<img" not in html and "done" in html


def test_a_step_is_a_table(square):
    step = next(s for s in square.steps() if s.events)
    shown = text(step._repr_html_())
    assert "touch of node 0" in shown and "part.surface-floor" in shown and "Slab from 0.35 s to 0.4 s" in shown


def test_a_step_shows_eight_events_and_the_number_of_the_others(square):
    step = next(s for s in square.steps() if s.events)
    event = step.events[0]
    for count, more in ((8, ""), (9, "and 1 more"), (20, "and 12 more")):
        shown = text(replace(step, events=(event,) * count)._repr_html_())
        assert shown.count("touch of node") == 8
        assert ("more" in shown) == bool(more) and more in shown


def test_the_numbers_of_a_certificate_have_their_units(square):
    shown = text(next(square.steps()).certificate._repr_html_())
    lines = {
        "min gap": "m",
        "min force": "N",
        "complementarity": "J",
        "power residual": "J",
        "momentum error": "kg m/s",
        "energy error": "J",
    }
    for name, unit in lines.items():
        assert re.search(rf"{name}\s+\S+ {unit}\s", shown), name


@pytest.mark.slow
def test_a_scenario_is_a_table(pytestconfig):
    for file in sorted((pytestconfig.rootpath / "scenarios").glob("*.toml")):
        scenario = load(file)
        shown = unescape(text(scenario._repr_html_()))
        assert scenario.title in shown and all(name in shown for name in scenario.bodies)
    assert isinstance(scenario, sw.Scenario)


def test_tables_audits_and_pictures_show_themselves(square, tmp_path):
    """In two lines of a notebook: a picture, a table with units, what a slab leaves over."""
    run = record_run(square.steps(), square.opening(), RunFolder())
    assert "energy_kinetic" in run.history._repr_html_() and "greatest" in run.history._repr_html_()
    assert "normal_velocity_before [m/s]" in text(run.events._repr_html_())
    step = next(s for s in square.steps() if s.events)
    assert (
        "kg m/s" in text(step.certificate._repr_html_()) and "contact part.surface-floor" in step.ledger._repr_html_()
    )
    assert run.plot()._repr_png_().startswith(b"\x89PNG")
    assert run.plot("history").save(tmp_path / "deep" / "history.svg").stat().st_size > 10_000
    assert "keep" not in repr(run)
    with pytest.raises(sw.InputError, match="no picture 'curves'"):
        run.plot("curves")
    with pytest.raises(sw.InputError, match="no field 'presure'"):
        run.plot(colour="presure")


def test_a_sweep_shows_its_runs(tmp_path):
    row = Row(values={"time.end": "1 s"}, folder=tmp_path, stop=Stop("done"), numbers={"slabs": 3})
    shown = text(Sweep(path=tmp_path, rows=(row,))._repr_html_())
    assert "time.end" in shown and "1 s" in shown and "done" in shown
