"""Newton's method for a slab with angles and motors: the motion of the fixed point, and on through dead centres."""

import numpy as np

from softway.kernels.multibody.slab import begin, project_velocities, solve_motion
from softway.kernels.multibody.tables import space
from softway.mechanisms import Gear, Hinge, Mechanism, Motor, Rigid, Sine, Slider, TorsionSpring, march
from softway.mechanisms.arrays import arrays
from softway.mechanisms.newton import newton_motion


def geared() -> Mechanism:
    """Two wheels with skew axes on a free box, with a gear, a spring, and a motor on the box."""
    bodies = {
        "box": Rigid(mass=3.0, centre=(0, 0, 0), inertia=(0.8, 0.9, 1.0), spin=(0.3, 1.0, -0.5)),
        "one": Rigid(mass=1.0, centre=(1, 0, 0), inertia=(0.1, 0.1, 0.2), velocity=(0, 0.5, 0), spin=(0, 0, 5)),
        "two": Rigid(mass=1.0, centre=(0, 1, 0), inertia=(0.2, 0.1, 0.1), velocity=(0.1, 0, 0), spin=(-2, 0, 0)),
        "arm": Rigid(mass=0.5, centre=(0, 0, 1.2), inertia=(0.1, 0.1, 0.1)),
    }
    joints = {
        "z": Hinge(between=("box", "one"), at=(1, 0, 0), axis=(0, 0, 1)),
        "x": Hinge(between=("box", "two"), at=(0, 1, 0), axis=(1, 2, 2)),
        "y": Hinge(between=("box", "arm"), at=(0, 0, 1), axis=(0, 1, 0.5)),
    }
    return Mechanism(
        bodies=bodies,
        joints=joints,
        gears={"gear": Gear(joints=("z", "x"), ratio=0.7)},
        motors={"motor": Motor(joint="y", motion=Sine(amplitude=0.8, frequency=1.5))},
        springs=(TorsionSpring(joint="z", stiffness=2.0, rest=1.0, damping=0.1),),
    )


def test_newton_and_the_fixed_point_find_the_same_slab() -> None:
    it, h, found = arrays(geared()), 0.02, []
    for method in ("fixed point", "newton"):
        it = arrays(geared())
        room = space(it.joints, len(it.names), len(it.bodies.jointed))
        for _ in range(2):
            begin(it.bodies, it.joints, it.springs, it.motion, room)
            project_velocities(it.bodies, it.joints, it.motion, room)
        if method == "newton":
            assert 0 < newton_motion(it, room, h, 1.0) < 8
        else:
            assert solve_motion(it.bodies, it.joints, it.springs, it.motion, room, h, 1.0) > 0
        found.append((room.z[:-1].copy(), it.motion.impulse.copy()))
    np.testing.assert_allclose(found[0][0], found[1][0], atol=1e-12)
    np.testing.assert_allclose(found[0][1], found[1][1], atol=1e-9)


def test_the_slab_by_itself_closes_the_energy() -> None:
    """Before the projection of the velocities: energies, work of the motor, and what the damper takes."""
    for h in (0.02, 0.1):
        it = arrays(geared())
        room = space(it.joints, len(it.names), len(it.bodies.jointed))
        for _ in range(2):
            begin(it.bodies, it.joints, it.springs, it.motion, room)
            project_velocities(it.bodies, it.joints, it.motion, room)
        start, angle, rotation = it.motion.energy.sum(), it.motion.angle.copy(), room.R0.copy()
        assert newton_motion(it, room, h, 1.0)
        velocity = 2.0 / h * room.z[:, :3] - it.motion.velocity
        spin = np.einsum("nji,nj->ni", rotation, 2.0 / h * room.z[:, 3:]) - it.motion.spin
        kinetic = 0.5 * (it.bodies.mass @ (velocity**2).sum(axis=1))
        kinetic += 0.5 * np.einsum("ni,nij,nj->", spin, it.bodies.inertia, spin)
        stiffness, rest, damping, _ = it.springs.torsion[0]
        new, old = room.angle[it.springs.about[0]], angle[it.springs.about[0]]
        lost = damping * (new - old) ** 2 / h
        work = it.motion.impulse[it.joints.drives.row[0]] * 0.8 * np.sin(3.0 * np.pi * h) / h
        assert abs(new - old) > 2.0 * h and abs(work) > 0.01
        np.testing.assert_allclose(kinetic + 0.5 * stiffness * (new - rest) ** 2, start + work - lost, rtol=1e-12)


def test_a_motor_drives_a_crank_through_dead_centres() -> None:
    """Crank and rod of equal length fold flat, where the slider passes the axle."""
    bodies = {
        "crank": Rigid(mass=1.0, centre=(0.5, 0.0), inertia=0.1),
        "rod": Rigid(mass=1.0, centre=(1.5, 0.0), inertia=0.1),
        "slider": Rigid(mass=1.0, centre=(2.0, 0.0), inertia=0.1),
    }
    joints = {
        "main": Hinge(between=("ground", "crank"), at=(0.0, 0.0)),
        "pin": Hinge(between=("crank", "rod"), at=(1.0, 0.0)),
        "wrist": Hinge(between=("rod", "slider"), at=(2.0, 0.0)),
        "guide": Slider(between=("ground", "slider"), at=(2.0, 0.0), axis=(1.0, 0.0)),
    }
    motors = {"motor": Motor(joint="main", motion=Sine(amplitude=1.4, frequency=0.5))}
    mechanism = Mechanism(bodies=bodies, joints=joints, motors=motors, gravity=(0.0, -9.81))
    steps = list(march(mechanism, until=4.0, step=0.005))
    for step in steps:
        angle = 1.4 * np.sin(np.pi * step.time)
        assert abs(step.bodies["slider"].centre[0] - 2.0 * np.cos(angle)) < 1e-11
        assert abs(step.energy_error) < 1e-11
