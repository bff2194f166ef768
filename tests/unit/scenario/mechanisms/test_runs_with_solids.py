"""Runs of solids and rigid bodies together: records, probes, pictures, audit, resumption."""

import shutil
from pathlib import Path

import numpy as np
import pytest

import softway as sw
from softway.apps.cli.commands import main
from softway.marching.march import march
from softway.record.audit.among_solids import audited_among_solids
from softway.record.storage.table import read
from softway.scenario.checks.check import check
from softway.scenario.files import loads

FOLDER = Path(__file__).parents[4] / "scenarios"
SHORT = ("bodies.beam.mesh.cells=[20, 2]", "time.end=6 ms", "time.step=0.2 ms", "output.fields_every=1 ms")
STOP = (
    "stops.limit={kind='PlaneStop', between=['ground', 'hammer'], point=[0.4, 0.06], plane=[0, '0.0599 m'], "
    "normal=[0, 1], restitution=0.5}"
)
FALL = """
title = "A sled falls by 0.2 m onto a plate and touches it at the end of a slab"
[bodies.plate]
kind = "Rigid"
mass = "8 kg"
centre = ["0 m", "-0.05 m"]
inertia = "0.1 kg m^2"
[bodies.sled]
kind = "Rigid"
mass = "2 kg"
centre = ["0 m", "0.2 m"]
inertia = "0.01 kg m^2"
[bodies.witness]
kind = "Solid"
mesh = { kind = "Rectangle", size = ["10 mm", "10 mm"], cells = [1, 1], origin = ["0 m", "1 m"] }
material = { kind = "LinearElastic", E = "1 MPa", nu = 0.3 }
density = "2000 kg/m^3"
supports = [{ on = "bottom", components = "xy" }]
[joints.rail]
kind = "Slider"
between = ["ground", "plate"]
at = ["0 m", "-0.05 m"]
axis = [1, 0]
[stops.left]
kind = "PlaneStop"
between = ["plate", "sled"]
point = ["-0.05 m", "0.2 m"]
plane = ["0 m", "0 m"]
normal = [0, 1]
[stops.right]
kind = "PlaneStop"
between = ["plate", "sled"]
point = ["0.05 m", "0.2 m"]
plane = ["0 m", "0 m"]
normal = [0, 1]
[[loads]]
kind = "Gravity"
acceleration = ["0 m/s^2", "-10 m/s^2"]
[time]
end = "0.3 s"
step = "10 ms"
[output]
fields_every = "0.1 s"
"""
"""The speed of 2 m/s of the sled has 4 J, which are dissipated in the slab after the touch."""
TABLES = ("history.csv", "rigid.csv", "events.csv", "scenario.toml")


def scenario(*more):
    return sw.load(FOLDER / "hammer_on_beam.toml", (*SHORT, *more))


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return sw.run(scenario(), tmp_path_factory.mktemp("with_solids") / "run")


@pytest.mark.slow
def test_the_tables_hold_the_motion_of_the_march(run):
    checked = check(scenario())
    steps = list(march(checked.model, until=6e-3, step=checked.step))
    table = read(run.path / "rigid.csv")
    assert table.rows == len(steps) + 1
    for row, step in enumerate(steps, 1):
        hammer = step.after.rigid["hammer"]
        assert [table[f"hammer.{axis}"][row] for axis in "xy"] == hammer.centre.tolist()
        assert table["hammer.spin"][row] == hammer.spin[0]
    assert run.history["hammer angle"][-1] == pytest.approx(table["hammer.angle"][-1], rel=1e-12)
    assert run.history["energy_error"] == pytest.approx(0.0, abs=1e-10 * run.history["energy_kinetic"][0])
    assert {"touch"} <= set(run.events["kind"].tolist())


def test_the_frames_show_the_body_where_it_is(run):
    cells, times = run.fields.cells, run.fields.times
    for k in (0, len(times) - 1):
        placed = cells.obstacles(float(times[k]))["hammer"]
        table = read(run.path / "rigid.csv")
        row = int(np.argmin(np.abs(table["time"] - times[k])))
        turn = table["hammer.angle"][row]
        arm = np.array([0.36 - 0.4, 0.035 - 0.06])
        c, s = np.cos(turn), np.sin(turn)
        centre = np.array([table["hammer.x"][row], table["hammer.y"][row]]) + np.array([[c, -s], [s, c]]) @ arm
        assert float(placed.gap(centre[None])[0]) == pytest.approx(-0.03, rel=1e-12)


def test_show_plot_and_audit_take_the_run(run, capsys, tmp_path):
    for command in (["show", str(run.path)], ["plot", str(run.path), "--out", str(tmp_path / "bodies.png")]):
        main(command)
    assert (tmp_path / "bodies.png").stat().st_size > 10_000
    assert "contact beam.top-hammer" in capsys.readouterr().out


def planted(run, folder, name, column, by):
    """Copy of a run with a number added to a column of one of its tables, from the middle on."""
    shutil.copytree(run.path, folder)
    lines = (folder / name).read_text().splitlines()
    k = [cell.rpartition(" [")[0] for cell in lines[0].split(",")].index(column)
    rows = [line.split(",") for line in lines[1:]]
    for row in rows[len(rows) // 2 :]:
        row[k] = repr(float(row[k]) + by)
    (folder / name).write_text("\n".join([lines[0], *map(",".join, rows)]) + "\n")
    return sw.Run(folder)


def audit(run):
    return audited_among_solids(run, check(scenario()).model)


def test_the_audit_of_the_rigid_bodies_agrees_with_the_march(run, capsys):
    found = audit(run)
    assert found.findings == () and found.instants == run.history.rows
    assert found.joints["pivot"] < 1e-14 and found.rates["pivot"] < 1e-9
    assert set(found.balances) == {"the kinetic energy", "the momentum", "the spin"}
    assert max(found.balances.values()) < 1e-13
    assert main(["audit", str(run.path), "--strict"]) == 0
    assert "joints hold to" in capsys.readouterr().out


PLANTED = {
    ("rigid.csv", "hammer.y"): "the joint 'pivot' is open by",
    ("rigid.csv", "hammer.angle"): "the joint 'pivot' is open by",
    ("rigid.csv", "hammer.velocity_x"): "the velocities open the joint 'pivot'",
    ("rigid.csv", "hammer.spin"): "the kinetic energy in history.csv",
    ("history.csv", "energy_kinetic"): "the kinetic energy in history.csv",
    ("history.csv", "momentum_y"): "the momentum in history.csv",
    ("history.csv", "spin_z"): "the spin in history.csv",
}


@pytest.mark.few(4)
@pytest.mark.parametrize(("name", "column"), sorted(PLANTED))
def test_a_changed_record_is_found(name, column, run, tmp_path, capsys):
    changed = planted(run, tmp_path / "run", name, column, 1e-6)
    assert any(PLANTED[name, column] in sentence for sentence in audit(changed).findings)
    assert main(["audit", str(changed.path), "--strict", "--quiet"]) == 4
    assert PLANTED[name, column] in capsys.readouterr().out


def test_an_overlapped_stop_is_found(tmp_path):
    run = sw.run(scenario(STOP, "time.end=2 ms"), tmp_path / "run")
    stopped = check(scenario(STOP)).model
    assert audited_among_solids(run, stopped).overlaps["limit"] < 1e-14
    changed = planted(run, tmp_path / "changed", "rigid.csv", "hammer.y", -0.1)
    assert any("the stop 'limit' is overlapped" in text for text in audited_among_solids(changed, stopped).findings)


@pytest.mark.slow
@pytest.mark.parametrize("more", [(), (STOP,)], ids=["contact", "contact and stop"])
def test_an_interrupted_run_ends_with_the_same_bits(more, tmp_path):
    whole = sw.run(scenario(*more), tmp_path / "whole")

    def stop(progress):
        if progress.fraction >= 0.5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sw.run(scenario(*more), tmp_path / "run", progress=stop)
    done = sw.resume(tmp_path / "run")
    for file in TABLES:
        assert (done.path / file).read_bytes() == (whole.path / file).read_bytes(), file
    if more:
        assert "limit" in whole.events["contact"].tolist()


@pytest.mark.slow
def test_a_flexible_rod_moves_the_slider_nearly_as_a_rigid_one(tmp_path):
    changes = ("bodies.rod.mesh.cells=[6, 1]", "bodies.rod.material.E=200 GPa", "time.end=20 ms", "time.step=1 ms")
    run = sw.run(sw.load(FOLDER / "flexible_crank.toml", changes), tmp_path / "run")
    angle = 40.0 * run.history["time"]
    rigid = 0.1 * np.cos(angle) + np.sqrt(0.4**2 - (0.1 * np.sin(angle)) ** 2)
    assert run.history["slider"] == pytest.approx(rigid, abs=2e-5)


@pytest.mark.slow
def test_a_cradle_of_elastic_discs_passes_the_velocity_on_less_what_vibrates(tmp_path):
    cells = tuple(f"bodies.disc{k}.mesh.cells=8" for k in range(1, 6))
    run = sw.run(
        sw.load(FOLDER / "elastic_cradle.toml", (*cells, "time.end=16 ms", "time.step=0.5 ms")), tmp_path / "r"
    )
    history = run.history
    energy = history["energy_kinetic"] + history["energy_strain"]
    assert np.abs(history["energy_error"]).max() < 1e-10 * energy[0]
    assert 0.85 * 0.5 < history["last core"][-1] < 0.5  # rigid balls, one after the other: all of it
    assert abs(history["first core"][-1]) < 0.1 * 0.5
    first = run.events["contact"][np.argsort(run.events["time"])]
    touched = [name for name in dict.fromkeys(first.tolist()) if name.startswith("disc")]
    assert touched == [f"disc{k}.boundary-disc{k + 1}.boundary" for k in range(1, 5)]


def test_the_audit_sees_the_state_before_an_impact_at_the_end_of_a_slab(tmp_path):
    run = sw.run(loads(FALL), tmp_path / "run")
    assert not [f for f in run.events["finding"] if f]
    assert run.events["time"] == pytest.approx([0.2, 0.2]) and run.events["impulse"] == pytest.approx([2.0, 2.0])
    assert run.history["energy_kinetic"][20] == pytest.approx(4.0, rel=1e-6)
    assert run.history["dissipation"][20:22] == pytest.approx([0.0, 4.0], rel=1e-12)


def test_a_march_from_a_state_at_a_touch_has_the_impact_in_its_first_slab():
    checked = check(loads(FALL))
    *_, last = march(checked.model, until=0.2, step=checked.step)
    assert last.after.rigid["sled"].velocity == pytest.approx([0.0, -2.0], abs=1e-12)
    first = next(march(checked.model, until=0.3, step=checked.step, state=last.after))
    assert [event.kind for event in first.events] == ["touch", "touch"]
    assert first.ledger.dissipation == pytest.approx(4.0, rel=1e-12)
    resting = next(march(checked.model, until=0.4, step=checked.step, state=first.after))
    assert not resting.events and resting.ledger.dissipation == pytest.approx(0.0, abs=1e-12)
    assert resting.after.rigid["sled"].centre == pytest.approx([0.0, 0.0], abs=1e-12)
