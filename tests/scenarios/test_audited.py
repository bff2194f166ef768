"""Every shipped scenario is audited: what it finds is what the comment of its file and the gallery say."""

import re
from pathlib import Path

import numpy as np
import pytest

import softway as sw
from softway.marching.results.finding import BETWEEN, DISSIPATION, ENERGY, INVERTED, MOMENTUM, OVERLAP, SPIN
from softway.record.audit import watch
from softway.record.audit.folder import frames_audited
from softway.scenario.files import loads
from softway.scenario.text.templates import templates
from variants import SCENARIOS, VARIANTS, each, names, small, whole

WITHIN = 0.25
"""Greatest difference of the depth that a sentence tells, relative to the depth: figures are rounded upwards."""
COARSE = {"oblique_blocks": {MOMENTUM}}
"""Findings of small variants only: an edge of two cells turns the normals of its mean gaps by more than a tenth."""
SLOW = ("ball_impact", "block_on_sphere", "stamp_on_pad")
"""Scenarios that are audited as they are shipped without those for ``minutes``: cheap ones, two with findings."""
MARKS = {name: pytest.mark.slow if name in SLOW else pytest.mark.minutes for name in VARIANTS}


def sentence(name: str) -> str:
    """Sentence of the comment of a file on the findings of the audit; empty if there is none."""
    comment, *_ = (SCENARIOS / f"{name}.toml").read_text(encoding="utf-8").partition("title")
    text = " ".join(line.lstrip("# ") for line in comment.splitlines())
    found = re.search(r"The audit finds that .*", text)
    return found[0] if found else ""


def told(text: str) -> tuple[set[str], float]:
    """Kinds of the findings that a sentence tells, and their greatest depth [m].

    Overlaps "between nodes" are of that kind only; surfaces that just overlap do so at nodes and between them.
    """
    kinds = {BETWEEN} if re.search(r"between (their )?nodes", text) else {OVERLAP, BETWEEN}
    return kinds, 1e-3 * float(re.search(r"up to ([\d.]+) mm", text)[1])


@pytest.mark.parametrize("name", [pytest.param(name, marks=MARKS[name]) for name in names()])
def test_the_audit_finds_what_the_file_says(name, tmp_path):
    run, text = sw.run(whole(name), tmp_path / "run"), sentence(name)
    found = run.summary["findings"]
    assert run.stop.reason == "done" and run.status == ("done, with findings" if text else "done")
    frames = list(frames_audited(run.fields))
    deepest = max(depths.between for depths in frames)
    assert {one["kind"] for one in found} == {f.kind for depths in frames for f in depths.findings}
    if text:
        kinds, depth = told(text)
        assert {one["kind"] for one in found} == kinds
        assert deepest <= depth * (1.0 + 1e-9) and depth <= (1.0 + WITHIN) * deepest
    else:
        assert not found


@pytest.mark.slow
@pytest.mark.few(6)
@pytest.mark.parametrize("name", each())
def test_balances_hold_in_every_slab(name, tmp_path, monkeypatch):
    """Small variants, with a frame and an audit at each slab."""
    monkeypatch.setattr(watch, "APART", 1)
    given = small(name)
    run = sw.run(small(name, f"output.fields_every={1e-4 * given.time.end} s"), tmp_path / "run")
    assert run.stop.reason == "done"
    audited = ~np.isnan(run.history["certificate.gap_nodes"])
    assert audited.sum() == run.summary["slabs"]
    wrong = {INVERTED, DISSIPATION, ENERGY, MOMENTUM, SPIN} - COARSE.get(name, set())
    assert not [one for one in run.summary["findings"] if one["kind"] in wrong]
    energy = run.history["energy_kinetic"] + np.abs(run.history["energy_strain"]) + np.abs(run.history["work_external"])
    assert run.history["certificate.complementarity"].max() <= 1e-8 * energy.max()


@pytest.mark.parametrize(
    "name",
    [pytest.param(n, marks=pytest.mark.minutes if n == "part" else pytest.mark.slow) for n in sorted(templates())],
)
def test_a_template_has_no_finding(name, tmp_path):
    text = templates()[name].replace('"part.msh"', '"bracket.msh"')
    run = sw.run(loads(text, folder=SCENARIOS), tmp_path / "run")
    assert run.status == "done" and not run.summary["findings"]


def test_six_files_tell_findings():
    assert [name for name in names() if sentence(name)] == [
        "bar_through_die",
        "beam_on_cylinder",
        "block_on_sphere",
        "oblique_blocks",
        "ring_in_ring",
        "stamp_on_pad",
    ]
    gallery = (Path(__file__).parents[2] / "docs" / "tutorials" / "gallery.md").read_text(encoding="utf-8")
    assert all(sentence(name) in gallery for name in names())
