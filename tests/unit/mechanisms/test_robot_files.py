"""URDF and MJCF files: the mechanism moves as in MuJoCo, and what is left out is listed."""

import sys
from pathlib import Path

import numpy as np
import pytest

import softway as sw
from softway.mechanisms import BallJoint, Cylindrical, Gear, Hinge, Slider, Universal, Weld, march, read_robot
from softway.mechanisms.robots.urdf import urdf_without_geometry

ARM = """
<mujoco>
  <compiler angle="degree"/>
  <option gravity="0 0 -9.81" integrator="RK4" timestep="0.0002"><flag contact="disable"/></option>
  <worldbody>
    <body name="arm" pos="0 0 1" euler="0 30 10">
      <joint name="shoulder" axis="0 1 0.2" range="-170 170" stiffness="3" springref="20" damping="0.2"/>
      <geom type="capsule" fromto="0 0 0 .5 0 0" size=".05" density="1000"/>
      <body name="fore" pos=".5 0 0">
        <joint name="wrist" type="ball"/>
        <geom type="box" size=".1 .02 .03" pos=".1 0 .02" euler="10 20 30"/>
        <body name="tool" pos=".2 0 0"><inertial pos="0 .1 0" mass=".2" diaginertia="1e-4 2e-4 2e-4"/></body>
        <body name="sled" pos=".1 0 0"><joint name="slide" type="slide" axis="1 1 0" springref="0.1"/>
          <geom size=".03" mass=".1"/></body>
      </body>
    </body>
    <body name="free" pos="2 0 1"><freejoint/><geom type="sphere" size=".1"/></body>
  </worldbody>
  <actuator><motor name="drive" joint="shoulder"/></actuator>
</mujoco>
"""
ROBOT = """<robot name="r">
  <link name="base"/>
  <link name="one"><inertial><origin xyz="0.1 0 0"/><mass value="1"/>
    <inertia ixx="0.01" iyy="0.02" izz="0.02" ixy="0.001" ixz="0" iyz="0"/></inertial>
    <visual><geometry><mesh filename="package://nowhere/one.stl"/></geometry></visual></link>
  <link name="two"><inertial><mass value="0.5"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="three"><inertial><mass value="0.2"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="one"/><origin xyz="0 0 1" rpy="0 0 0.5"/>
    <axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="10" velocity="3"/>
    <dynamics damping="0.2" friction="0.1"/></joint>
  <joint name="push" type="prismatic"><parent link="one"/><child link="two"/><origin xyz="0.3 0 0"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="1" effort="10" velocity="3"/><mimic joint="turn" multiplier="0.3"/></joint>
  <joint name="glue" type="fixed"><parent link="two"/><child link="three"/><origin xyz="0.1 0 0"/></joint>
  <transmission name="gearbox"/>
</robot>
"""


def written(folder: Path, text: str, name: str = "robot.xml") -> Path:
    (folder / name).write_text(text, encoding="utf-8")
    return folder / name


def inside(body: str, rest: str = "") -> str:
    return f"<mujoco><worldbody>{body}</worldbody>{rest}</mujoco>"


def test_a_file_without_mujoco_tells_how_to_install_it(tmp_path, monkeypatch) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(sw.InputError, match=r"(?s)MuJoCo.* is not installed.*pip install 'softway\[robots\]'"):
        read_robot(written(tmp_path, ARM))


def test_files_that_are_not_there_and_other_endings_are_refused(tmp_path) -> None:
    with pytest.raises(sw.InputError, match="path: no such file"):
        read_robot(tmp_path / "arm.urdf")
    with pytest.raises(sw.InputError, match=r"path: arm.step has the ending '.step'"):
        read_robot(tmp_path / "arm.step")


def test_urdf_elements_that_nobody_reads_are_listed() -> None:
    found = urdf_without_geometry(ROBOT)
    assert found is not None and "package://" not in found.text
    assert found.left_out == (
        "visual of the link 'one'",
        "velocity limit of the joint 'turn'",
        "velocity limit of the joint 'push'",
        "'transmission' of the robot ('gearbox')",
    )
    assert urdf_without_geometry(ARM) is None and urdf_without_geometry("no xml") is None


def test_an_arm_moves_as_in_mujoco(tmp_path) -> None:
    """MJCF with all kinds of joints, inertia from geometry, a spring and a damper; against its Runge-Kutta method."""
    mujoco = pytest.importorskip("mujoco")
    robot = read_robot(written(tmp_path, ARM))
    assert robot.left_out == (
        "limits of the joint 'shoulder'",
        *(f"contacts of the body '{name}'" for name in ("arm", "fore", "sled", "free")),
        "actuator 'drive'",
    )
    steps = list(march(robot.mechanism, until=1.0, step=0.001, every=100))
    model = mujoco.MjModel.from_xml_string(ARM)
    data = mujoco.MjData(model)
    for step in steps:
        while data.time < step.time - 1e-5:
            mujoco.mj_step(model, data)
        mujoco.mj_kinematics(model, data)
        for name, body in step.bodies.items():
            np.testing.assert_allclose(body.centre, data.body(name).xipos, atol=1e-4)
    assert all(abs(s.energy_error) < 1e-12 * steps[-1].energy_kinetic for s in steps) and steps[-1].dissipation > 0.01
    assert np.linalg.norm(steps[-1].bodies["tool"].centre - steps[0].bodies["tool"].centre) > 0.5


def test_a_urdf_robot_with_a_mimic_joint(tmp_path) -> None:
    pytest.importorskip("mujoco")
    robot = read_robot(written(tmp_path, ROBOT, "robot.urdf"))
    joints = robot.mechanism.joints
    assert isinstance(joints["turn"], Hinge) and isinstance(joints["push"], Slider)
    assert isinstance(joints["three fixed"], Weld)
    assert [(gear.joints, gear.ratio) for gear in robot.mechanism.gears.values()] == [(("turn", "push"), 0.3)]
    for told in ("friction of the joint 'turn'", "limits of the joint 'push'", "visual of the link 'one'"):
        assert told in robot.left_out
    body = robot.mechanism.bodies["one"]
    assert body.tensor.trace() == pytest.approx(0.05) and np.linalg.eigvalsh(body.tensor)[0] < 0.01
    steps = list(march(robot.mechanism, until=1.0, step=0.001, every=100))
    assert max(abs(s.energy_error) for s in steps) < 1e-11
    one, two = steps[-1].bodies["one"], steps[-1].bodies["two"]
    axis = one.rotation @ [np.cos(0.5), np.sin(0.5), 0.0]
    angle = np.arctan2(-axis[2], axis[:2] @ [np.cos(0.5), np.sin(0.5)])
    assert np.linalg.norm(two.centre - (0.0, 0.0, 1.0)) == pytest.approx(0.3 + 0.3 * angle, abs=1e-11)


def test_loops_fixed_bodies_and_pairs_of_joints(tmp_path) -> None:
    pytest.importorskip("mujoco")
    text = inside(
        """<body name="post" pos="0 0 1"><geom size=".1"/>
             <body name="a"><joint name="h"/><geom size=".1" pos="1 0 0"/></body></body>
           <body name="b"><joint name="x" axis="1 0 0"/><joint name="y" axis="0 1 0"/>
             <geom size=".1" pos="0 0 1"/></body>
           <body name="c"><joint name="t" axis="0 0 1"/><joint name="s" type="slide" axis="0 0 1"/>
             <geom size=".1" pos="1 0 0"/></body>""",
        """<equality><connect name="loop" body1="a" body2="b" anchor="0 0 .5"/>
             <weld name="w" body1="a" body2="c"/><joint name="bent" joint1="h" polycoef="0 1 0 0 0"/></equality>""",
    )
    robot = read_robot(written(tmp_path, text))
    joints = robot.mechanism.joints
    assert set(robot.mechanism.bodies) == {"a", "b", "c"}, "the post is part of the ground"
    assert isinstance(joints["x + y"], Universal) and isinstance(joints["t + s"], Cylindrical)
    loop = joints["equality 'loop'"]
    assert isinstance(loop, BallJoint) and loop.at == pytest.approx((0.0, 0.0, 1.5))
    assert "equality 'w'" in robot.left_out and "equality 'bent'" in robot.left_out
    assert not any(isinstance(gear, Gear) for gear in robot.mechanism.gears.values())


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (
            inside("<body name='a'><joint/><joint type='slide' axis='1 0 0'/><geom size='1'/></body>"),
            "body 'a': has the joints",
        ),
        (inside("<body name='a'><joint/></body>"), "MuJoCo does not read it"),
        (
            inside("<body name='a'><joint colour='red'/><geom size='1'/></body>"),
            "robot.xml: MuJoCo does not read it: .*colour",
        ),
        ("no xml", "MuJoCo does not read it"),
    ],
)
def test_files_that_cannot_be_read_are_refused(tmp_path, text: str, told: str) -> None:
    pytest.importorskip("mujoco")
    with pytest.raises(sw.InputError, match=f"(?s){told}"):
        read_robot(written(tmp_path, text))
