"""Scenarios of rigid bodies: the motion is that of the Python call, and the run folder tells it."""

from itertools import islice
from pathlib import Path
from shutil import copytree
from threading import Event

import numpy as np
import pytest

import softway as sw
from softway.apps.cli.commands import main
from softway.mechanisms import DistanceStop, Hinge, Mechanism, PlaneStop, Rigid, Slider, march
from softway.record import conduct_rigid
from softway.record.conduct_rigid import RigidRun, record_rigid
from softway.record.read.mechanism_summary import told
from softway.record.storage.run_folder import RunFolder
from softway.record.write.mechanism.columns import rotation_of, rotation_vector
from softway.scenario.checks.mechanism import CheckedMechanism
from softway.scenario.run_rigid import mechanism_records

FOLDER = Path(__file__).parents[4] / "scenarios"
NAMES = (
    "bearing_clearance",
    "flat_follower",
    "hammer_on_stop",
    "newtons_cradle",
    "rocking_block",
    "slider_crank",
    "squeezer",
    "thrown_ball",
    pytest.param("tippe_top", marks=pytest.mark.slow),
    "toggle_snap",
    "woodpecker",
)
TABLES = ("history.csv", "motion.csv", "events.csv")
SHORT = ("time.end=5 ms",)


def engine() -> Mechanism:
    """The slider-crank of the scenario, written in Python."""
    return Mechanism(
        bodies={
            "crank": Rigid(mass=0.04, centre=(0.05, 0.0), inertia=3e-5, velocity=(0.0, 5.0), spin=100.0),
            "rod": Rigid(mass=0.06, centre=(0.2, 0.0), inertia=2e-4, velocity=(0.0, 5.0), spin=-50.0),
            "slider": Rigid(mass=0.1, centre=(0.3, 0.0), inertia=1e-5),
        },
        joints={
            "main": Hinge(between=("ground", "crank"), at=(0.0, 0.0)),
            "pin": Hinge(between=("crank", "rod"), at=(0.1, 0.0)),
            "wrist": Hinge(between=("rod", "slider"), at=(0.3, 0.0)),
            "guide": Slider(between=("ground", "slider"), at=(0.3, 0.0), axis=(1.0, 0.0)),
        },
    )


@pytest.fixture(scope="module", params=NAMES)
def shipped(request, tmp_path_factory) -> sw.Run:
    """Run of each shipped scenario of a mechanism."""
    return sw.run(sw.load(FOLDER / f"{request.param}.toml"), tmp_path_factory.mktemp("runs") / request.param)


@pytest.fixture(scope="module")
def crank(tmp_path_factory) -> sw.Run:
    return sw.run(sw.load(FOLDER / "slider_crank.toml", SHORT), tmp_path_factory.mktemp("runs") / "crank")


def test_the_motion_is_that_of_python_bit_for_bit(crank):
    steps = list(march(engine(), until=5e-3, step=1e-4))
    motion, history = crank.motion, crank.history
    assert motion.rows == history.rows == len(steps) == 51
    for k, step in enumerate(steps):
        assert (motion["time"][k], history["energy_kinetic"][k]) == (step.time, step.energy_kinetic)
        for name, state in step.bodies.items():
            row = [motion[f"{name}.{c}"][k] for c in ("x", "y", "velocity_x", "velocity_y", "spin")]
            assert row == [*state.centre.tolist(), *state.velocity.tolist(), *state.spin.tolist()]
            assert motion[f"{name}.angle"][k] == rotation_vector(state.rotation)[0]


def test_shipped_mechanisms_keep_energy_and_joints(shipped):
    found = shipped.summary
    assert shipped.status == "done" and found["findings"] == []
    assert found["energy_error_relative"] < 1e-12 and found["joint_error_worst"] < 1e-14
    assert shipped.history["time"][-1] == shipped.motion["time"][-1] == found["time_end"]


@pytest.mark.few(4)
def test_a_run_of_the_stored_scenario_has_the_same_bits(shipped, tmp_path):
    again = sw.run(sw.loads(shipped.scenario), tmp_path / "again")
    for name in TABLES:
        assert (again.path / name).read_bytes() == (shipped.path / name).read_bytes()


def test_events_are_those_of_the_stops(tmp_path):
    run = sw.run(sw.load(FOLDER / "hammer_on_stop.toml"), tmp_path / "run")
    events, stop = run.events, run.summary["stops"]["anvil"]
    assert set(events["contact"]) == {"anvil"} and list(events["kind"][-1:]) == ["rest"]
    assert stop["touches"] == (events["kind"] == "touch").sum() > 10 and stop["rests"] == 1
    assert stop["first_touch"] == events["time"][0] and stop["impulse"] == pytest.approx(events["impulse"].sum())
    assert events["normal_velocity_after"][0] == pytest.approx(-0.5 * events["normal_velocity_before"][0])
    assert run.summary["dissipation"] == pytest.approx(0.8 * 9.81 * 0.2, rel=1e-9)


def test_the_last_ball_leaves_with_the_velocity_of_the_first(tmp_path):
    run = sw.run(sw.load(FOLDER / "newtons_cradle.toml"), tmp_path / "run")
    speeds = {k: np.abs(run.motion[f"ball{k}.velocity_x"]).max() for k in range(1, 6)}
    assert speeds[5] == pytest.approx(speeds[1], rel=1e-3) and max(speeds[k] for k in (2, 3, 4)) < 1e-12


def test_probes_of_points_and_of_turning(tmp_path):
    probes = [
        "{name='tip', of='crank', at=['100 mm', 0], quantity='position', component='y'}",
        "{name='speed', of='crank', at=['100 mm', 0], quantity='velocity', component='norm'}",
        "{name='moved', of='slider', quantity='displacement'}",
        "{name='angle', of='crank', quantity='rotation', component='z'}",
        "{name='rate', of='crank', quantity='spin', component='z'}",
    ]
    scenario = sw.load(FOLDER / "slider_crank.toml", (*SHORT, f"output.probes=[{', '.join(probes)}]"))
    run = sw.run(scenario, tmp_path / "run")
    history, motion = run.history, run.motion
    assert [history.units[n] for n in ("tip", "speed", "moved", "angle", "rate")] == ["m", "m/s", "m", "rad", "rad/s"]
    assert history["tip"] == pytest.approx(0.1 * np.sin(history["angle"]), abs=1e-15)
    assert history["speed"] == pytest.approx(0.1 * np.abs(history["rate"]), rel=1e-12)
    assert np.array_equal(history["moved"], motion["slider.x"] - 0.3)


def test_fewer_instants_are_the_same_ones(crank, tmp_path):
    run = sw.run(sw.load(FOLDER / "slider_crank.toml", (*SHORT, "output.fields_every=1 ms")), tmp_path / "run")
    assert run.history["slabs"].tolist() == [0, 10, 20, 30, 40, 50]
    assert run.history["time"] == pytest.approx([0.0, 1e-3, 2e-3, 3e-3, 4e-3, 5e-3])
    assert np.array_equal(run.motion["rod.x"], crank.motion["rod.x"][::10])


def test_a_mechanism_in_space(tmp_path):
    top = Rigid(mass=1.0, centre=(0.0, 0.0, 0.0), inertia=(1.0, 2.0, 2.5), spin=(0.1, 3.0, 0.1))
    scenario = sw.Scenario(bodies={"top": top}, time=sw.Time(end=2.0, step=0.01))
    run = sw.run(sw.loads(sw.dumps(scenario)), tmp_path / "run")
    last = list(march(Mechanism(bodies={"top": top}), until=2.0, step=0.01, every=200))[-1].bodies["top"]
    vector = np.array([run.motion[f"top.rotation_{a}"][-1] for a in "xyz"])
    assert rotation_of(vector) == pytest.approx(last.rotation, abs=1e-14)
    assert np.array_equal([run.motion[f"top.spin_{a}"][-1] for a in "xyz"], last.spin)
    assert run.plot().save(tmp_path / "top.png").stat().st_size > 10_000


def test_an_interrupted_run_is_read(tmp_path):
    seen = []

    def stop(progress):
        seen.append((progress.slabs, progress.fraction, progress.left))
        if progress.slabs == 7:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sw.run(sw.load(FOLDER / "slider_crank.toml", SHORT), tmp_path / "run", progress=stop)
    run = sw.Run(tmp_path / "run")
    assert [slabs for slabs, *_ in seen] == list(range(8)) and seen[-1][1] == pytest.approx(0.14)
    assert (run.status, run.history.rows, run.motion.rows, run.summary["slabs"]) == ("interrupted", 8, 8, 7)


def test_a_cancelled_run_is_read(tmp_path):
    with pytest.raises(sw.Cancelled):
        sw.run(sw.load(FOLDER / "slider_crank.toml", SHORT), tmp_path / "run", cancel=lambda: True)
    assert sw.Run(tmp_path / "run").status == "cancelled" and sw.Run(tmp_path / "run").motion.rows == 1


def test_a_march_that_fails_leaves_what_it_has_found(tmp_path):
    checked = sw.check(sw.load(FOLDER / "slider_crank.toml", SHORT))
    opening = RigidRun(
        **mechanism_records(checked.mechanism, ()), until=5e-3, slabs=50, every=1, title="lost", texts={}
    )

    def lost():
        yield from islice(march(engine(), until=5e-3, step=1e-4), 4)
        raise sw.NumericsError("no solution", 4e-4, "a shorter step")

    with pytest.raises(sw.NumericsError):
        record_rigid(lost(), opening, RunFolder(out=tmp_path / "run"))
    run = sw.Run(tmp_path / "run")
    assert run.stop.reason == "failed" and "no solution" in run.stop.message
    assert run.history.rows == 4 and run.summary["slabs"] == 3


def test_balls_are_drawn_and_the_notebook_shows_a_run(crank, tmp_path):
    pair = {"a": Rigid(mass=1.0, centre=(0.0, 0.0), velocity=(1.0, 0.0)), "b": Rigid(mass=1.0, centre=(1.0, 0.0))}
    stop = DistanceStop(between=("a", "b"), points=((0.0, 0.0), (1.0, 0.0)), distance=0.5, restitution=1.0)
    scenario = sw.Scenario(bodies=pair, stops={"touch": stop}, time=sw.Time(end=1.0, step=0.01))
    run = sw.run(scenario, tmp_path / "run")
    assert run.plot(times=[0.0, 0.5]).save(tmp_path / "balls.png").stat().st_size > 10_000
    assert run.plot("history").save(tmp_path / "history.png").stat().st_size > 10_000
    assert "data:image/png" in crank._repr_html_()
    with pytest.raises(sw.InputError, match="no fields"):
        run.plot(colour="von_mises")
    with pytest.raises(sw.InputError, match="not in the run"):
        run.plot(times=[2.0])
    with pytest.raises(sw.InputError, match="has no fields"):
        len(run.fields)


def test_a_damaged_outline_is_refused(crank, tmp_path):
    folder = tmp_path / "run"
    copytree(crank.path, folder)
    text = (folder / "mechanism.json").read_text(encoding="utf-8")
    for old, new in (("0.05", '"x"'), ('"crank"', '"crunk"'), ('"joints"', '"jonts"'), ("2", "3"), ("{", "")):
        (folder / "mechanism.json").write_text(text.replace(old, new, 1), encoding="utf-8")
        with pytest.raises(sw.InputError, match="mechanism.json"):
            sw.Run(folder).plot()


def test_compiling_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(conduct_rigid, "PATIENCE", 0.0)
    said = Event()

    def waiting():
        assert said.wait(60.0)
        yield from march(engine(), until=1e-3, step=1e-4)

    records = mechanism_records(engine(), ())
    opening = RigidRun(**records, until=1e-3, slabs=10, every=1, title="", texts={})
    run = record_rigid(waiting(), opening, RunFolder(), tell=lambda line: said.set() if "compiling" in line else None)
    assert run.history.rows == 11


def test_solids_have_no_motion(tmp_path):
    run = sw.run(sw.load(FOLDER / "paper_bar.toml", ["time.end=0.05 s"]), tmp_path / "run")
    assert not run.of_mechanism
    with pytest.raises(sw.InputError, match="not the run of a mechanism"):
        len(run.motion)


def test_a_rod_that_jams_is_told(tmp_path):
    rod = Rigid(mass=1.0, centre=(-0.5, 0.75**0.5), inertia=1.0 / 3.0, velocity=(1.0, 0.0))
    tip = PlaneStop(between=("ground", "rod"), point=(0, 0), plane=(0, 0), normal=(0, 1), friction=1.8)
    weight = sw.Gravity(acceleration=(0.0, -9.81))
    scenario = sw.Scenario(bodies={"rod": rod}, stops={"tip": tip}, loads=(weight,), time=sw.Time(end=0.01, step=0.001))
    run = sw.run(scenario, tmp_path / "run")
    assert run.summary["stops"]["tip"]["jams"] == 1
    assert "its sliding jammed once" in "".join(told(run.summary))


def test_the_command_line_checks_runs_shows_and_draws(tmp_path, capsys):
    file, out = str(FOLDER / "hammer_on_stop.toml"), str(tmp_path / "run")
    assert main(["check", file]) == 0
    assert "1000 slabs" in capsys.readouterr().out
    assert main(["run", file, "--out", out]) == 0
    assert main(["show", out]) == 0
    out_text = capsys.readouterr().out
    for sentence in ("moved for 1 s in 1000 slabs", "The joints hold to", "it came to rest once", "dissipated 1.57 J"):
        assert sentence in out_text
    assert main(["plot", out]) == 0
    assert (tmp_path / "run" / "bodies.png").stat().st_size > 10_000
    assert main(["plot", out, "--film", str(tmp_path / "film.gif"), "--times", "0 ms, 3 ms"]) == 0
    assert (tmp_path / "film.gif").stat().st_size > 10_000
    assert main(["race", file]) == 2 and "rigid bodies" in capsys.readouterr().err
    assert main(["audit", out]) == 0 and "1001 instants audited" in capsys.readouterr().out


def test_a_velocity_that_joints_do_not_allow_is_told(crank, tmp_path):
    """The slider cannot move while the crank and the rod are in line."""
    assert crank.summary["velocity_change_start"] == 0.0
    scenario = sw.load(FOLDER / "slider_crank.toml", (*SHORT, "bodies.slider.velocity=['1 m/s', 0]"))
    run = sw.run(scenario, tmp_path / "run")
    assert run.summary["velocity_change_start"] == pytest.approx(1.0)
    assert "velocities by up to 1 m/s" in told(run.summary)[0]
    wrong = sw.run(sw.load(FOLDER / "slider_crank.toml", (*SHORT, "bodies.rod.spin=0")))
    assert crank.summary["spin_change_start"] == 0.0 < wrong.summary["spin_change_start"] < 50.0


@pytest.mark.slow
def test_a_sweep_runs_mechanisms(tmp_path):
    found = sw.sweep(
        FOLDER / "hammer_on_stop.toml",
        {"stops.anvil.restitution": [0.2, 0.4]},
        out=tmp_path / "sweep",
        changes=("time.end=0.3 s",),
        jobs=1,
    )
    assert not found.failed and len(found.rows) == 2
    assert found.table["stops.anvil.touches"].tolist() == [1, 1] and found.table.units["joint_error_worst"] == "m"


def test_the_check_tells_the_scales():
    checked = sw.check(sw.load(FOLDER / "slider_crank.toml"))
    assert isinstance(checked, CheckedMechanism) and (checked.slabs, checked.every) == (1100, 2)
    assert (checked.bodies["crank"].mass, checked.bodies["rod"].spin) == (0.04, 50.0)
