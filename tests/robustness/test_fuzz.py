"""A few of the damaged inputs, a long run, and the page of the results."""

import warnings
from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from endurance import endured
from fuzz import judged
from inputs.decks import judged_deck
from inputs.mesh_files import judged_mesh
from inputs.mutations import damaged
from inputs.scenarios.judge import judged_scenario, lost_values
from page import drops, endurance, fuzz
from softway.errors import InputError
from softway.scenario.files import loads


def test_damaged_inputs_are_told_apart_from_right_ones():
    for number in (747, 1542, *range(20)):
        assert judged(damaged(number)) in ("ok", "refused", "failed"), number


def test_nothing_of_a_mutated_deck_is_lost_in_silence():
    verdicts = [judged_deck(number) for number in range(120)]
    assert not {verdict for verdict in verdicts if verdict not in ("ok", "refused")}
    assert min(verdicts.count("ok"), verdicts.count("refused")) > 20


def test_nothing_of_a_mutated_mesh_file_is_lost_in_silence():
    verdicts = [judged_mesh(number) for number in range(200)]
    assert not {verdict for verdict in verdicts if verdict not in ("ok", "refused")}
    assert min(verdicts.count("ok"), verdicts.count("refused")) > 40


@pytest.mark.slow
def test_mutated_scenarios_are_computed_or_refused():
    verdicts = [judged_scenario(number) for number in (1, 3, 7, 15, 26)]
    assert not {verdict for verdict in verdicts if verdict not in ("ok", "refused", "failed")}


def test_a_lost_value_is_seen(tmp_path):
    given = {"time": {"end": "2 ms"}, "loads": [1, 2], "friction": "Frictionless", "mass": {}}
    read = {"time": {"end": "0.002 s"}, "loads": [1], "friction": {"kind": "Frictionless"}}
    assert lost_values(given, read, tmp_path) == ["loads: 2 entries became 1", "mass = {} is nowhere"]


@settings(max_examples=100)
@given(text=st.text(max_size=200))
def test_any_text_is_read_or_refused(text):
    with suppress(InputError):
        loads(text)


@pytest.mark.slow
def test_a_short_run_of_endurance():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = endured(400)
    assert found["touches"] > 3
    assert found["energy"] < 1e-10


def test_the_page():
    told = fuzz({"inputs": 3, "families": {"bytes": {"ok": 1, "refused": 2}}, "defects": 0, "slowest": 0.1})
    assert "| bytes | 1 | 2 | 0 | 0 | 0 |" in told
    one = dict.fromkeys(("space", "body", "cells", "law", "obstacle", "solver", "friction", "speed", "why"), "x")
    figures = {"depth": 1e-16, "tension": 0.0, "energy": 1e-12}
    told = drops([{**one, **figures, "number": 7, "end": "stops", "rule": "Energy"}])
    assert "| Energy | 1 | 0 | 1 | 0 | 0 | 0 | 1.0e-16 |" in told
    assert "| 7 | x |" in told
    assert "12 touches" in endurance({"slabs": 10, "touches": 12, "early": 1.0, "late": 1.0, "energy": 0.0})
