"""Audit of mechanisms: it agrees with the march of every kind of joint and stop, and finds what is planted."""

from pathlib import Path

import pytest

import softway as sw
from softway import mechanisms as me
from softway.apps.cli.commands import main
from softway.record.audit.mechanism import MechanismAudit, audited_mechanism

FOLDER = Path(__file__).parents[4] / "scenarios"
ORIGIN, AXIS, ACROSS = (0.0, 0.0, 0.0), (0.0, 0.6, 0.8), (1.0, 0.0, 0.0)
BAR = me.Rigid(
    mass=2.0, centre=(0.3, 0.1, 0.2), inertia=(0.3, 0.2, 0.4), velocity=(0.0, 0.3, 0.4), spin=(0.5, 0.6, 0.8)
)
TWO = ("ground", "bar")
JOINTS = {
    "ball": me.BallJoint(between=TWO, at=ORIGIN),
    "hinge": me.Hinge(between=TWO, at=ORIGIN, axis=AXIS),
    "slider": me.Slider(between=TWO, at=ORIGIN, axis=AXIS),
    "cylinder": me.Cylindrical(between=TWO, at=ORIGIN, axis=AXIS),
    "screw": me.Screw(between=TWO, at=ORIGIN, axis=AXIS, pitch=0.1),
    "cross": me.Universal(between=TWO, at=ORIGIN, axes=(ACROSS, (0.0, 1.0, 0.0))),
    "rod": me.Rod(between=TWO, ends=((-0.5, 0.0, 0.0), (0.2, 0.2, 0.2))),
}


def shaken(joint: me.Hinge, **more: object) -> sw.Scenario:
    bodies = {"bar": BAR, **more.pop("bodies", {})}
    weight = sw.Gravity(acceleration=(0.0, 0.0, -9.81))
    joints = {"it": joint, **more.pop("joints", {})}
    time = sw.Time(end=1.0, step=5e-3)
    return sw.Scenario(bodies=bodies, joints=joints, loads=(weight,), time=time, **more)


def audit(run: sw.Run) -> MechanismAudit:
    return audited_mechanism(run, sw.check(sw.loads(run.scenario)).mechanism)


def planted(run: sw.Run, column: str, by: float) -> None:
    """Add a number to a column of motion.csv or history.csv."""
    for name in ("motion.csv", "history.csv"):
        lines = (run.path / name).read_text().splitlines()
        head = [cell.rpartition(" [")[0] for cell in lines[0].split(",")]
        if column in head:
            rows = [line.split(",") for line in lines[1:]]
            for row in rows[len(rows) // 2 :]:
                row[head.index(column)] = repr(float(row[head.index(column)]) + by)
            (run.path / name).write_text("\n".join([lines[0], *map(",".join, rows)]) + "\n")
            return
    raise KeyError(column)


@pytest.mark.parametrize("kind", sorted(JOINTS))
def test_each_joint_holds_and_a_moved_body_is_found(kind, tmp_path):
    run = sw.run(shaken(JOINTS[kind]), tmp_path / "run")
    found = audit(run)
    assert found.joints["it"] < 1e-13 and found.rates["it"] < 1e-9 * found.speed and found.findings == ()
    assert max(found.balances.values()) < 1e-12
    planted(run, "bar.x", 1e-6)
    assert any("the joint 'it'" in sentence for sentence in audit(run).findings)


@pytest.mark.few(4)
@pytest.mark.parametrize(("kind", "column"), [*((kind, "velocity_x") for kind in sorted(JOINTS)), ("hinge", "spin_x")])
def test_a_velocity_that_opens_a_joint_is_found(kind, column, tmp_path):
    run = sw.run(shaken(JOINTS[kind]), tmp_path / "run")
    planted(run, f"bar.{column}", 1e-6)
    assert any("the velocities open the joint 'it'" in sentence for sentence in audit(run).findings)


@pytest.mark.parametrize("kind", ["hinge", "slider", "cylinder", "screw", "cross"])
def test_a_turned_body_is_found(kind, tmp_path):
    run = sw.run(shaken(JOINTS[kind]), tmp_path / "run")
    planted(run, "bar.rotation_x", 1e-6)
    assert audit(run).joints["it"] > 1e-7


def test_a_weld_and_a_torsion_spring(tmp_path):
    more = {"bodies": {"arm": me.Rigid(mass=1.0, centre=(0.0, 0.5, 0.0), inertia=(0.1, 0.1, 0.1))}}
    weld = {"joints": {"weld": me.Weld(between=("bar", "arm"), at=(0.1, 0.1, 0.1))}}
    spring = {"springs": (me.TorsionSpring(joint="it", stiffness=3.0, rest=0.4, damping=0.1),)}
    run = sw.run(shaken(JOINTS["hinge"], **more, **weld, **spring), tmp_path / "run")
    found = audit(run)
    assert found.joints["weld"] < 1e-13 and found.findings == () and "the potential energy" in found.balances
    planted(run, "arm.rotation_z", 1e-6)
    assert "'weld'" in audit(run).findings[0]


def test_a_spring_that_turns_too_far_between_instants_is_left_out(tmp_path):
    wheel = me.Rigid(mass=1.0, centre=(0.0, 0.0), inertia=0.1, spin=100.0)
    scenario = sw.Scenario(
        bodies={"wheel": wheel},
        joints={"axle": me.Hinge(between=("ground", "wheel"), at=(0.0, 0.0))},
        springs=(me.TorsionSpring(joint="axle", stiffness=1.0),),
        time=sw.Time(end=0.2, step=1e-3),
        output=sw.Output(fields_every=0.05),
    )
    found = audit(sw.run(scenario, tmp_path / "run"))
    assert "turns too far" in found.left_out[0] and "the potential energy" not in found.balances and not found.findings


@pytest.mark.parametrize(
    "name",
    [
        "bearing_clearance",
        "newtons_cradle",
        pytest.param("tippe_top", marks=pytest.mark.slow),
        "toggle_snap",
        "woodpecker",
    ],
)
def test_shipped_mechanisms_have_no_findings(name, tmp_path):
    run = sw.run(sw.load(FOLDER / f"{name}.toml"), tmp_path / "run")
    found = audit(run)
    assert found.findings == () and found.instants == run.motion.rows
    assert max(found.joints.values(), default=0.0) < 1e-14 and max(found.overlaps.values(), default=0.0) < 1e-14
    assert max(found.balances.values()) < 1e-12


PLANTED = {
    "hammer.y": "the stop 'anvil' is overlapped by",
    "hammer.velocity_x": "the kinetic energy in history.csv",
    "energy_kinetic": "the kinetic energy in history.csv",
    "dissipation": "the energy balance in history.csv",
    "momentum_y": "the momentum in history.csv",
    "spin_z": "the spin in history.csv",
}


@pytest.mark.few(4)
@pytest.mark.parametrize("column", sorted(PLANTED))
def test_planted_errors_are_found(column, tmp_path):
    run = sw.run(sw.load(FOLDER / "hammer_on_stop.toml"), tmp_path / "run")
    planted(run, column, -1e-5)
    assert any(PLANTED[column] in sentence for sentence in audit(run).findings)


def test_the_command_tells_and_is_strict(tmp_path, capsys):
    out = str(tmp_path / "run")
    run = sw.run(sw.load(FOLDER / "hammer_on_stop.toml", ("time.end=0.4 s",)), out)
    assert main(["audit", out, "--strict"]) == 0
    told = capsys.readouterr().out
    assert "401 instants audited; joints hold to" in told and "energy balance to" in told and "finding" not in told
    planted(run, "hammer.y", -1e-3)
    assert main(["audit", out]) == 0 and main(["audit", out, "--strict", "--quiet"]) == 4
    assert "finding: the joint 'pivot' is open by 0.001 m" in capsys.readouterr().out


def test_a_killed_run_with_a_line_more_is_audited(tmp_path):
    run = sw.run(sw.load(FOLDER / "hammer_on_stop.toml", ("time.end=0.1 s",)), tmp_path / "run")
    lines = (run.path / "motion.csv").read_text().splitlines()
    (run.path / "motion.csv").write_text("\n".join(lines[:-1]) + "\n")
    assert audit(run).findings == ()
    (run.path / "motion.csv").write_text(lines[0] + "\n")
    with pytest.raises(sw.InputError, match="no instant"):
        audit(run)
