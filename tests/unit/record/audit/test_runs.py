"""Runs whose contact is satisfied while their bodies overlap: the audit says so, and nothing else changes."""

import itertools
import json
import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import softway as sw
from softway.apps import cli
from softway.arrays import Array
from softway.marching.audit.balances import Balances, balances
from softway.marching.march import march
from softway.marching.results.finding import KINDS
from softway.marching.results.step import Event, Step
from softway.marching.results.step_states import KnownStates
from softway.model.scene import State
from softway.record.audit.energy_watch import ENERGIES
from softway.record.audit.watch import APART, watcher
from softway.record.storage.table import Table
from softway.scenario.checks.check import check
from softway.scenario.files import loads
from softway.scenario.run import _opening

THROUGH = """
title = "Block that falls through a floor it knows nothing of"
[bodies.block]
kind = "Solid"
mesh = { kind = "Rectangle", size = [1.0, 1.0], cells = [2, 2] }
material = { kind = "LinearElastic", E = "1 MPa", nu = 0.3 }
density = "1000 kg/m^3"
velocity = ["0 m/s", "-1 m/s"]
[bodies.other]
kind = "Solid"
mesh = { kind = "Rectangle", size = [3.0, 1.0], cells = [3, 1], origin = [-1.0, -1.5] }
material = { kind = "LinearElastic", E = "1 MPa", nu = 0.3 }
density = "1000 kg/m^3"
[bodies.floor]
kind = "Tool"
shape = { kind = "HalfSpace", point = [0, -2], normal = [0, 1] }
[[contacts]]
between = ["other.bottom", "floor"]
[time]
end = "0.8 s"
step = "0.02 s"
[output]
fields_every = "0.1 s"
"""
"""The block meets the other body at t = .5 s; no contact between them is declared."""


@pytest.fixture(scope="module")
def through(tmp_path_factory: pytest.TempPathFactory) -> sw.Run:
    return sw.run(loads(THROUGH), tmp_path_factory.mktemp("through") / "run")


def test_an_overlap_that_nobody_declared_is_an_event(through: sw.Run) -> None:
    events = through.events
    rows = np.flatnonzero(np.isin(events["kind"], KINDS))
    assert {str(k) for k in events["kind"][rows]} <= {"overlap", "overlap between nodes"} and len(rows)
    nodes = [k for k in rows if events["kind"][k] == "overlap"]
    assert {str(events["contact"][k]) for k in nodes} == {"block-other"}
    # frames at .1, .2, ... are audited where ten slabs have passed, and the end: .2 s is slab 10
    assert events["time"][nodes].tolist() == pytest.approx([0.6, 0.8])
    assert events["depth"][nodes].tolist() == pytest.approx([0.1, 0.3], abs=1e-12)
    assert events["y"][nodes].tolist() == pytest.approx([-0.6, -0.8], abs=1e-12)
    assert "inside 'other'" in str(events["finding"][nodes[0]])


def test_the_status_and_the_summary_tell_it(through: sw.Run) -> None:
    found = through.summary
    assert through.stop.reason == "done" and through.status == "done, with findings" == found["status"]
    assert found["penetration_worst"] == 0.0 and found["penetration_nodes"] == pytest.approx(0.3, abs=1e-12)
    (first, *_) = found["findings"]
    assert (first["kind"], first["between"], first["count"]) == ("overlap", "block-other", 2)
    assert first["depth"] == pytest.approx(0.3, abs=1e-12)
    assert "done, with findings" in through._repr_html_() and "inside" in through._repr_html_()


def test_the_certificate_has_the_gaps_of_the_slabs_that_were_audited(through: sw.Run) -> None:
    gap = through.history["certificate.gap_nodes"]
    seen = np.flatnonzero(~np.isnan(gap))
    assert seen.tolist() == [10, 20, 30, 40]
    assert gap[seen].tolist() == pytest.approx([0.0, 0.0, -0.1, -0.3], abs=1e-12)
    assert (through.history["certificate.min_gap"] >= 0.0).all()


def test_the_exit_code_and_the_words_on_the_terminal(through: sw.Run, tmp_path: Path, capsys) -> None:
    file = tmp_path / "through.toml"
    file.write_text(THROUGH, encoding="utf-8")
    assert cli.main(["run", str(file), "--out", str(tmp_path / "a")]) == 0
    shown = capsys.readouterr()
    assert "finding: node" in shown.out and "done, with findings" in shown.out
    assert "warning done, with" in shown.err
    assert cli.main(["run", str(file), "--out", str(tmp_path / "b"), "--strict", "--quiet"]) == 4
    shown = capsys.readouterr()
    assert not shown.out and "finding: node" in shown.err
    assert cli.main(["show", str(tmp_path / "a")]) == 0
    assert "finding: node" in capsys.readouterr().out
    assert cli.main(["audit", str(tmp_path / "a"), "--strict"]) == 4
    assert "8 frames audited; deepest overlap at nodes 0.3 m" in capsys.readouterr().out
    assert cli.main(["audit", str(tmp_path / "a")]) == 0


def test_an_audit_says_what_a_summary_leaves_out(through: sw.Run, tmp_path: Path, capsys) -> None:
    folder = Path(shutil.copytree(through.path, tmp_path / "run"))
    said = json.loads((folder / "summary.json").read_text(encoding="utf-8"))

    def warned(findings) -> str:
        (folder / "summary.json").write_text(json.dumps({**said, "findings": findings}), encoding="utf-8")
        assert cli.main(["audit", str(folder)]) == 0
        return capsys.readouterr().err

    assert not warned(said["findings"])
    nodes, *_ = said["findings"]
    assert "tells 0.1 m of 0.3 m: overlap of 'block-other'" in warned([{**nodes, "depth": 0.1}, *said["findings"][1:]])
    assert "does not tell: overlap of 'block-other'" in warned([])
    events = (folder / "events.csv").read_text(encoding="utf-8")
    missed = "0.8,all,energy,-1,0,0,0,0,0,0,0,the balance misses,"
    (folder / "events.csv").write_text(f"{events}{missed}\n", encoding="utf-8")
    assert "does not tell: energy of 'all'" in warned(said["findings"])
    (folder / "events.csv").write_text(events, encoding="utf-8")
    text = (folder / "history.csv").read_text(encoding="utf-8").splitlines()
    column, last = text[0].split(",").index("energy_kinetic [J]"), text[-1].split(",")
    last[column] = str(0.5 * float(last[column]))
    (folder / "history.csv").write_text("\n".join([*text[:-1], ",".join(last), ""]), encoding="utf-8")
    assert warned(said["findings"]) == "warning summary.json does not tell: energy of 'all'\n"


def test_the_picture_tells_it(through: sw.Run) -> None:
    texts = [text.get_text() for text in through.plot().figure.findobj(lambda a: hasattr(a, "get_text"))]
    assert any("inside 'other'" in text for text in texts)


def test_the_switch(tmp_path: Path) -> None:
    text = THROUGH.replace('fields_every = "0.1 s"', 'fields_every = "0.1 s"\naudit = false')
    run = sw.run(loads(text), tmp_path / "run")
    assert run.status == "done" and run.summary["penetration_nodes"] is None and not run.summary["findings"]
    assert np.isnan(run.history["certificate.gap_nodes"]).all()


def test_a_run_that_goes_on_after_a_stop_has_the_same_findings(through: sw.Run, tmp_path: Path) -> None:
    class Enough(Exception):
        pass

    def stop(progress: sw.Progress) -> None:
        if progress.slabs == 27:
            raise Enough

    with pytest.raises(Enough):
        sw.run(loads(THROUGH), tmp_path / "run", progress=stop)
    sw.resume(tmp_path / "run")
    for name in ("history.csv", "events.csv"):
        assert (tmp_path / "run" / name).read_bytes() == (through.path / name).read_bytes()


@pytest.mark.parametrize(
    ("every", "audited"), [("0.02 s", [10, 20, 30, 40]), ("0.1 s", [10, 20, 30, 40]), ("0.24 s", [12, 24, 36, 40])]
)
def test_slabs_that_are_not_due_are_not_looked_at(every: str, audited: list[int]) -> None:
    """Frames are stored at each slab, at each fifth and at each twelfth; an audit is ten slabs from the last one."""
    assert APART == 10
    checked = check(loads(THROUGH.replace('fields_every = "0.1 s"', f'fields_every = "{every}"')))
    opening, calls = _opening(checked), []

    def counted(state: State) -> Balances:
        calls.append(state.time)
        return balances(checked.model, state)

    audit = watcher(replace(opening, balances=counted))
    steps = list(audit.watched(march(checked.model, until=checked.scenario.time.end, step=checked.step)))
    seen = [k for k, step in enumerate(steps, 1) if not np.isnan(step.certificate.gap_nodes)]
    assert seen == audited and calls == [steps[k - 1].after.time for k in audited]


def made_wrong(checked, change) -> Iterator[str]:
    """Sentences of the audit on steps whose ledger is changed from slab 12 on."""
    opening = _opening(checked)

    def wrong() -> Iterator[Step]:
        for k, step in enumerate(march(checked.model, until=checked.scenario.time.end, step=checked.step), 1):
            yield step if k < 12 else replace(step, ledger=replace(step.ledger, **change(step.ledger)))

    for step in itertools.islice(watcher(opening).watched(wrong()), 20):
        yield from (event.finding for event in step.events if event.kind in KINDS)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda l: {"dissipation": -1e-3}, "gave 0.001 J back"),
        (lambda l: {"energy_error": 20.0}, "the energy balance misses 20 J"),
        (lambda l: {"energy_kinetic": l.energy_kinetic * (1 + 1e-6)}, "the kinetic energy of the fields"),
        (lambda l: {"energy_strain": l.energy_strain + 1e-3}, "the strain energy of the fields"),
        (lambda l: {"momentum": l.momentum + [0.0, 1e-3, 0.0]}, "the momentum of the fields and that of the ledger"),
        (lambda l: {"spin": l.spin + [0.0, 0.0, 1e-3]}, "the spin of the fields and that of the ledger"),
    ],
)
def test_a_ledger_that_is_wrong(change, words: str) -> None:
    checked = check(loads(THROUGH))
    told = list(made_wrong(checked, change))
    assert len(told) == 1 and words in told[0]
    assert not list(made_wrong(checked, lambda ledger: {}))


def test_a_balance_that_misses_between_two_audits_is_told_with_its_time() -> None:
    checked = check(loads(THROUGH))
    opening = _opening(checked)

    def wrong() -> Iterator[Step]:
        for k, step in enumerate(march(checked.model, until=checked.scenario.time.end, step=checked.step), 1):
            yield replace(step, ledger=replace(step.ledger, energy_error={13: -30.0, 16: 40.0}.get(k, 0.0)))

    for known in range(0, 20, 4):  # slabs that were computed before the run is resumed
        steps, audit = wrong(), watcher(opening)
        before = [step.ledger for step in itertools.islice(steps, known)]
        columns = {name: np.array([getattr(ledger, name) for ledger in (opening.ledger, *before)]) for name in ENERGIES}
        audit.past(Table({"time": 0.02 * np.arange(known + 1), **columns}))
        told = [e for s in itertools.islice(audit.watched(steps), 40) for e in s.events if e.kind == "energy"]
        assert [(e.time, "misses 40 J" in e.finding) for e in told] == [(pytest.approx(0.32), True)]


def kicked(velocity) -> list[Event]:
    """Findings on a march whose velocities are changed in slab 20; its ledger has the momentum and spin of the state.

    ``velocity`` makes the change (n, d) of the velocities at points (n, d).
    """
    checked = check(loads(THROUGH))
    opening = _opening(checked)

    def steps() -> Iterator[Step]:
        for k, step in enumerate(march(checked.model, until=checked.scenario.time.end, step=checked.step), 1):
            if k == 20:
                places = {n: opening.meshes[n].points + u for n, u in step.after.displacement.items()}
                after = replace(
                    step.after, velocity={n: v + velocity(places[n]) for n, v in step.after.velocity.items()}
                )
                now = balances(checked.model, after)
                ledger = replace(step.ledger, energy_kinetic=now.kinetic, momentum=now.momentum, spin=now.spin)
                step = replace(step, states=replace(KnownStates.of(step.states), after=after), ledger=ledger)
            yield step

    seen = itertools.islice(watcher(opening).watched(steps()), 25)
    return [event for step in seen for event in step.events if event.kind in KINDS]


def test_a_body_that_changes_its_momentum_without_a_cause() -> None:
    seen = [e for e in kicked(lambda x: 1e-3 + 0.0 * x) if e.kind == "momentum"]
    assert [e.contact for e in seen] == ["block", "other"]
    assert all(e.time == pytest.approx(0.4) for e in seen) and "the contacts give at most 0 N" in seen[0].finding


def test_a_body_that_changes_its_spin_without_a_cause() -> None:
    def turned(x: Array) -> Array:
        arm = x - x.mean(axis=0)
        return 0.1 * np.stack([-arm[:, 1], arm[:, 0]], axis=1)

    seen = [e for e in kicked(turned) if e.kind == "spin"]
    assert [e.contact for e in seen] == ["block", "other"]
    assert "is turned by" in seen[0].finding and "the contacts give at most 0 N m" in seen[0].finding
    assert not kicked(lambda x: 0.0 * x)


HOLLOW = """
title = "Hollow rubber ball that folds on a floor, plane strain"
[bodies.ball]
kind = "Solid"
mesh = { kind = "Ring", inner = "24 mm", outer = "30 mm", cells = [3, 48], cell = "tri3" }
material = { kind = "NeoHookean", E = "3 MPa", nu = 0.45 }
density = "1000 kg/m^3"
dilatation = "mean"
velocity = { kind = "Affine", value = ["10 m/s", "-10 m/s"], gradient = [[0, 100], [-100, 0]] }
place = { bottom = "0.1 mm" }
[bodies.floor]
kind = "Tool"
shape = { kind = "HalfSpace", point = [0, 0], normal = [0, 1] }
[[contacts]]
name = "floor"
between = ["ball.surface", "floor"]
friction = { kind = "Coulomb", mu = 0.6 }
[time]
end = "5.4 ms"
"""


@pytest.mark.minutes
def test_the_walls_of_a_hollow_ball_pass_through_each_other(tmp_path: Path) -> None:
    run = sw.run(loads(HOLLOW), tmp_path / "run")
    assert run.summary["penetration_worst"] < 1e-12 and run.status == "done, with findings"
    found = {one["kind"]: one for one in run.summary["findings"]}
    assert found["overlap"]["between"] == "ball-ball"
    assert 4.0e-3 < found["overlap"]["first"] < 5.4e-3 and found["overlap"]["depth"] > 1e-4


def test_a_body_at_rest_has_no_finding(tmp_path: Path) -> None:
    """Its energies are rounding errors of strains of 1e-15: those of the fields and of the ledger differ by 5 %."""
    text = """
title = "Block at rest, far from a floor"
solver = { kind = "Explicit" }
[bodies.block]
kind = "Solid"
mesh = { kind = "Rectangle", size = [0.02, 0.02], cells = [4, 4] }
material = { library = "steel S235", law = "plastic" }
dilatation = "mean"
[bodies.floor]
kind = "Tool"
shape = { kind = "HalfSpace", point = [0, -1], normal = [0, 1] }
[[contacts]]
between = ["block.bottom", "floor"]
[time]
end = "5 us"
"""
    done = sw.run(loads(text), tmp_path / "run")
    assert done.status == "done" and done.history["energy_strain"][-1] < 1e-20
