"""Piles of balls from scenario files: records, resumption bit by bit, audit, export, pictures and pages."""

import json
from pathlib import Path
from shutil import copytree

import numpy as np
import pytest

import softway as sw
from softway.apps.cli.commands import main
from softway.piles import Balls, Box, Pile, march
from softway.record.audit.pile import audited_pile
from softway.record.view.page import page
from softway.record.view.pictures import picture

SCENARIO = Path(__file__).parents[4] / "scenarios" / "poured_balls.toml"
SMALL = ("bodies.marbles.count=[3,3,3]", "time.end=0.2 s")
DISCS = """
[bodies.discs]
kind = "BallFile"
path = "discs.csv"
density = 2000
[pile]
friction = 0.5
walls = [{ kind = "Wall", point = [0, 0], normal = [-1, 1] }, { kind = "Wall", point = [0, 0], normal = [1, 1] }]
[[loads]]
kind = "Gravity"
acceleration = [0, -10]
[time]
end = 0.3
step = 0.002
"""
TABLE = "x [m], y [m], radius [m], velocity_x [m/s], spin [rad/s]\n0, 0.3, 0.1, 0, 5\n0.3, 0.5, 0.05, -1, 0\n"


def files(folder: Path) -> dict[str, bytes]:
    """Contents of the tables of a run."""
    return {name: (folder / name).read_bytes() for name in ("history.csv", "balls.f64", "events.csv", "pile.json")}


@pytest.fixture(scope="module")
def poured(tmp_path_factory) -> sw.Run:
    return sw.run(sw.load(SCENARIO, SMALL), tmp_path_factory.mktemp("runs") / "poured")


@pytest.fixture(scope="module")
def discs(tmp_path_factory) -> sw.Run:
    folder = tmp_path_factory.mktemp("discs")
    (folder / "discs.csv").write_text(TABLE, encoding="utf-8")
    (folder / "discs.toml").write_text(DISCS, encoding="utf-8")
    return sw.run(sw.load(folder / "discs.toml"), folder / "run")


def test_records_are_those_of_the_march_in_python(discs):
    balls = Balls(
        centres=[[0.0, 0.3], [0.3, 0.5]],
        radius=[0.1, 0.05],
        density=2000.0,
        velocities=[[0.0, 0.0], [-1.0, 0.0]],
        spins=[5.0, 0.0],
    )
    walls = sw.load(discs.path / "scenario.toml").pile.planes
    steps = list(
        march(Pile(balls=balls, walls=walls, gravity=(0.0, -10.0), friction=0.5), until=0.3, step=0.002, every=2)
    )
    motion, history = discs.balls, discs.history
    for name in ("centres", "turns", "velocities", "spins"):
        assert np.array_equal(getattr(motion, name), [getattr(step, name) for step in steps])
    for name in ("energy_kinetic", "energy_potential", "dissipation", "energy_error", "overlap"):
        assert history[name].tolist() == [getattr(step, name) for step in steps]
    assert motion.times.tolist() == history["time"].tolist() == [step.time for step in steps]
    assert history["slabs"].tolist() == list(range(0, 151, 2))
    assert discs.summary["touches"] == sum(step.touches for step in steps) > 2


def test_a_resumed_run_has_the_same_bits(poured, tmp_path):
    seen: list[int] = []

    def stop(progress) -> None:
        seen.append(progress.slabs)
        assert progress.left >= 0.0
        if len(seen) == 41:
            raise KeyboardInterrupt

    folder = tmp_path / "stopped"
    with pytest.raises(KeyboardInterrupt):
        sw.run(sw.load(SCENARIO, SMALL), folder, progress=stop)
    assert sw.Run(folder).status == "interrupted" and sw.Run(folder).history.rows == 41
    assert poured.history["closed_contacts"][40] > 5  # the state that is stored has contacts
    resumed = sw.resume(folder)
    assert [r["slabs"] for r in resumed.provenance["resumed"]] == [80] and resumed.status == "done"
    assert files(folder) == files(poured.path)
    assert not (folder / "checkpoints").exists()


def test_a_block_that_was_cut_is_not_read(poured, tmp_path):
    copytree(poured.path, tmp_path / "run")
    data = (poured.path / "balls.f64").read_bytes()
    (tmp_path / "run" / "balls.f64").write_bytes(data[:-8])
    assert len(sw.Run(tmp_path / "run").times) == len(poured.times) - 1


def test_the_audit_finds_nothing_in_a_run_and_what_is_put_into_it(poured, tmp_path):
    pile = sw.check(sw.load(SCENARIO, SMALL)).pile
    told = audited_pile(poured, pile)
    assert told.findings == () and told.instants == 101 and told.between < 1e-12
    assert set(told.balances) >= {"the kinetic energy", "the energy balance", "the momentum", "the spin"}
    copytree(poured.path, tmp_path / "run")
    data = np.frombuffer((poured.path / "balls.f64").read_bytes(), "<f8").copy()
    width = len(data) // 101
    data[-width + 1 : -width + 4] = data[-width + 4 : -width + 7]  # the first ball at the place of the second
    data[-1] += 1.0
    (tmp_path / "run" / "balls.f64").write_bytes(data.tobytes())
    found = " ".join(audited_pile(sw.Run(tmp_path / "run"), pile).findings)
    assert "two balls overlap by 0.02 m" in found and "the kinetic energy" in found and "the spin" in found


def test_the_motion_is_exported(discs, tmp_path):
    arrays = np.load(discs.export(tmp_path / "motion.npz"))
    assert np.array_equal(arrays["centres"], discs.balls.centres) and arrays["groups"].tolist() == ["discs", "discs"]
    lines = discs.export(tmp_path / "motion.csv").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 1 + 2 * len(discs.times) and lines[1].startswith("0,0,discs,0.1")
    x, y = (float(cell) for cell in lines[-1].split(",")[4:6])
    assert [x, y] == discs.balls.centres[-1, 1].tolist()
    scene = json.loads(discs.export(tmp_path / "motion.gltf").read_text(encoding="utf-8"))
    moved = [scene["accessors"][s["output"]] for s in scene["animations"][0]["samplers"]]
    assert [(m["type"], m["count"]) for m in moved] == [("VEC3", 76), ("VEC4", 76)] * 2
    assert np.allclose(moved[2]["max"][:2], discs.balls.centres[:, 1].max(axis=0))
    with pytest.raises(sw.InputError, match="of no known kind"):
        discs.export(tmp_path / "motion.json")


@pytest.mark.parametrize("name", ["poured", "discs"])
def test_pictures_and_the_page_are_made(name, request, tmp_path):
    run = request.getfixturevalue(name)
    assert run.plot().save(tmp_path / "balls.png").stat().st_size > 10_000
    assert run.plot(colour="speed", times=[0.0, 0.1]).save(tmp_path / "two.png").stat().st_size > 10_000
    assert run.plot("history").save(tmp_path / "history.png").stat().st_size > 10_000
    assert "data:image/png" in run._repr_html_()
    with pytest.raises(sw.InputError, match="does not colour balls"):
        run.plot(colour="von_mises")
    with pytest.raises(sw.InputError, match="not in the run"):
        run.plot(times=[2.0])


def test_balls_have_the_colours_of_their_speed(discs):
    figure = picture(discs, look=sw.record.view.options.PictureOptions(field="speed", times=(0.0,))).figure
    (circles,) = [c for c in figure.axes[0].collections if type(c).__name__ == "EllipseCollection"]
    colours = circles.get_facecolors()[:, :3]
    assert np.abs(colours[0] - [0.267, 0.005, 0.329]).max() < 1e-2  # viridis: at rest, and the fastest
    assert np.abs(colours[1] - [0.993, 0.906, 0.144]).max() < 1e-2


@pytest.mark.slow
def test_the_page_and_the_shipped_scenario(tmp_path, monkeypatch):
    monkeypatch.setattr("softway.record.view.page.FRAMES", 9)
    run = sw.run(sw.load(SCENARIO), tmp_path / "run")
    found = run.summary
    assert found["balls"] == 442 and found["energy_error_relative"] < 1e-13 and found["overlap_worst"] < 1e-12
    assert found["energy_kinetic_end"] < 1e-3 * found["dissipation"]
    assert audited_pile(run, sw.check(sw.load(SCENARIO)).pile).findings == ()
    text = page(run, ("a sentence",))
    assert text.count("data:image/png") == 9 + 1 and "a sentence" in text


def test_notes(tmp_path):
    def noted(*changes: str) -> list[str]:
        return [note.where for note in sw.check(sw.load(SCENARIO, (*SMALL, *changes))).notes]

    assert noted() == []
    assert noted("pile.walls=[]") == ["pile.walls"]
    assert noted("time.step=5 ms") == ["time.step"]
    assert noted("bodies.shot.radius=0.5 mm") == ["time.step", "bodies"]


def test_a_damaged_outline_is_refused(discs, tmp_path):
    copytree(discs.path, tmp_path / "run")
    parts = json.loads((discs.path / "pile.json").read_text(encoding="utf-8"))
    for wrong in ({"dim": 4}, {"radii": [0.1, "x"]}, {"groups": {"discs": 3}}, {"walls": [{"point": [0, 0]}]}):
        (tmp_path / "run" / "pile.json").write_text(json.dumps({**parts, **wrong}), encoding="utf-8")
        with pytest.raises(sw.InputError, match="pile.json"):
            sw.Run(tmp_path / "run").plot()


def test_records_of_a_pile_are_no_others(discs):
    with pytest.raises(sw.InputError, match="run of a pile, which has no fields"):
        len(discs.fields)
    with pytest.raises(sw.InputError, match="not the run of a mechanism"):
        len(discs.motion)


def test_a_box_is_its_walls():
    walls = Box(lower=(0.0, "open"), upper=(1.0, 2.0), friction=0.1).walls
    assert [(w.point, w.normal) for w in walls] == [
        ((0.0, 0.0), (1.0, 0.0)),
        ((1.0, 0.0), (-1.0, 0.0)),
        ((0.0, 2.0), (0.0, -1.0)),
    ]
    assert {wall.friction for wall in walls} == {0.1}


def test_the_commands_know_piles(discs, tmp_path, capsys):
    folder = tmp_path / "run"
    copytree(discs.path, folder)
    assert main(["audit", str(folder), "--strict"]) == 0
    assert main(["show", str(folder)]) == 0
    assert main(["export", str(folder), "--to", str(tmp_path / "balls.csv")]) == 0
    told = capsys.readouterr().out
    assert "76 instants audited" in told and "2 balls moved for 0.3 s" in told and "2 balls at 76 instants" in told
    data = np.frombuffer((folder / "balls.f64").read_bytes(), "<f8").copy()
    data[-1] += 1.0
    (folder / "balls.f64").write_bytes(data.tobytes())
    assert main(["audit", str(folder), "--strict"]) == 4
    assert "the kinetic energy" in capsys.readouterr().out
