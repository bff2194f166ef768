"""Exported motion of rigid bodies: every file tells the same numbers as the run folder."""

import json
from pathlib import Path

import numpy as np
import pytest

import softway as sw
from softway.apps.cli.commands import main
from softway.mechanisms import Rigid
from softway.record.export.tables import ENTRIES, UNITS
from softway.record.storage import table
from softway.record.write.mechanism.columns import rotation_of, rotation_vector

FOLDER = Path(__file__).parents[4] / "scenarios"


@pytest.fixture(scope="module")
def run(tmp_path_factory) -> sw.Run:
    """Two bodies that tumble in space, one of them by more than half a turn."""
    bodies = {
        "long": Rigid(mass=1.0, centre=(0.0, 0.0, 0.0), inertia=(1.0, 2.0, 2.5), spin=(0.1, 3.0, 0.1)),
        "flat": Rigid(mass=2.0, centre=(1.0, 0.5, 0.0), inertia=(1.0, 1.0, 1.9), spin=(1.0, 0.0, 0.5)),
    }
    scenario = sw.Scenario(bodies=bodies, time=sw.Time(end=2.0, step=0.02))
    return sw.run(scenario, tmp_path_factory.mktemp("runs") / "space")


def test_rotations_are_those_of_the_table_and_orthogonal(run):
    for name, body in run.bodies.items():
        vectors = np.stack([run.motion[f"{name}.rotation_{a}"] for a in "xyz"], axis=1)
        assert body.rotation == pytest.approx(np.array([rotation_of(v) for v in vectors]), abs=1e-15)
        assert body.rotation @ body.rotation.transpose(0, 2, 1) == pytest.approx(
            np.tile(np.eye(3), (len(vectors), 1, 1)), abs=1e-14
        )
        w, v = body.quaternion[:, :1], body.quaternion[:, 1:]
        x = np.array([0.3, -0.2, 0.9])
        turned = x + 2.0 * np.cross(v, np.cross(v, np.broadcast_to(x, v.shape)) + w * x)
        assert turned == pytest.approx(body.rotation @ x, abs=1e-14)
        assert np.array([rotation_vector(r) for r in body.rotation]) == pytest.approx(vectors, abs=1e-13)


def test_points_move_with_the_velocities(run):
    """The mean of the rates at both ends of a slab moves a point, to second order."""
    body, time = run.bodies["long"], run.motion["time"]
    arm = body.rotation @ np.array([0.5, 0.1, 0.0])
    rate = body.velocity + np.cross(body.spin, arm)
    moved = np.diff(body.place + arm, axis=0)
    assert moved == pytest.approx(0.5 * (rate[1:] + rate[:-1]) * np.diff(time)[:, None], abs=2e-5)


@pytest.mark.parametrize("ending", [".csv", ".json", ".npz"])
def test_files_hold_the_same_bits(run, tmp_path, ending):
    file = run.export(tmp_path / f"motion{ending}")
    bodies, time = run.bodies, run.motion["time"]
    if ending == ".npz":
        stored = np.load(file, allow_pickle=False)
        found = {name: {part: stored[f"{name}.{part}"] for part in UNITS} for name in bodies}
        times = stored["time"]
    elif ending == ".json":
        parsed = json.loads(file.read_text(encoding="utf-8"))
        found, times = parsed["bodies"], parsed["time"]
        assert parsed["units"]["spin"] == "rad/s"
    else:
        lines = table.read(file)
        assert lines.units["velocity_x"] == "m/s"
        mine = {name: lines["body"] == name for name in bodies}
        found = {
            name: {part: np.stack([lines[c][mine[name]] for c in ENTRIES[part]], axis=1) for part in UNITS}
            for name in bodies
        }
        times = lines["time"][mine["long"]]
    assert np.array_equal(times, time)
    for name, body in bodies.items():
        for part in UNITS:
            given = getattr(body, part)
            assert np.array_equal(np.reshape(found[name][part], given.shape), given), (name, part)


def test_a_mechanism_in_the_plane_turns_about_z(tmp_path):
    run = sw.run(sw.load(FOLDER / "slider_crank.toml", ("time.end=10 ms",)), tmp_path / "crank")
    crank, angle = run.bodies["crank"], run.motion["crank.angle"]
    assert crank.quaternion[:, 3] == pytest.approx(np.sin(0.5 * angle), abs=1e-15)
    assert not crank.place[:, 2].any() and not crank.quaternion[:, 1:3].any()
    assert np.array_equal(crank.spin[:, 2], run.motion["crank.spin"])


def test_the_command_exports_and_refuses(run, tmp_path, capsys):
    out = tmp_path / "motion.csv"
    assert main(["export", str(run.path), "--to", str(out)]) == 0 and out.is_file()
    assert "2 bodies at 101 instants" in capsys.readouterr().out
    assert main(["export", str(run.path), "--to", str(tmp_path / "motion.xls")]) == 2
    assert ".csv, .json, .npz, .gltf" in capsys.readouterr().err
    assert main(["export", str(run.path), "--to", str(tmp_path / "none" / "motion.csv")]) == 2
    solids = sw.run(sw.load(FOLDER / "paper_bar.toml", ["time.end=0.05 s"]), tmp_path / "bar")
    assert main(["export", str(solids.path), "--to", str(out)]) == 2
    assert "fields.vtkhdf" in capsys.readouterr().err
