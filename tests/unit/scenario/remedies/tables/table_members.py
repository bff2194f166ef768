"""Refusals of motors, gears, forces and friction of mechanisms, and of rigid bodies from their geometry."""

from math import inf

import numpy as np
from table_mechanisms import FREE, LINKS
from try_it import Call, Table, Try

from softway.mechanisms import (
    AngleStop,
    HingeTorque,
    PointForce,
    Polyline,
    Sine,
    Steady,
    rigid_box,
    rigid_disc,
    rigid_mesh,
    rigid_rod,
    rigid_surface,
)
from softway.meshes.generators.shapes import interval, rectangle

DRIVE = "motors.m={{joint='{}', motion={{kind='Steady', rate=1}}}}"
TABLED = "motors.m={joint='j', motion={kind='Polyline', times=[0, 1], values=[0, 1]}}"
GEARED = "gears.g={joints=['j', 'k'], ratio=2}"
SLIDING = (
    "stops={} & joints={j={kind='Slider', between=['ground', 'a'], at=[0, 0], axis=[1, 0]}, "
    "k={kind='Slider', between=['ground', 'c'], at=[1, 0], axis=[1, 0]}}"
)
TORSION = "springs=[{kind='TorsionSpring', joint='j', stiffness=1}]"
SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
EDGES = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])


TABLE: Table = {
    "friction": Try(LINKS, "stops.s.friction=-0.1", "zero or more", "stops.s.friction=0.1"),
    "limit of no joint": Try(
        LINKS, "stops.t={kind='AngleStop', joint='i', limit=1}", "one of ['j', 'k']", "stops.t.joint=j"
    ),
    "limit": Call(lambda _: AngleStop(joint="j", limit=inf), "an angle", lambda _: AngleStop(joint="j", limit=1.0)),
    "side of a limit": Call(
        lambda _: AngleStop(joint="j", limit=1.0, side="up"),
        "'most'",
        lambda _: AngleStop(joint="j", limit=1.0, side="most"),
    ),
    "motor of no joint": Try(LINKS, DRIVE.format("i"), "one of ['j', 'k']", "motors.m.joint=j"),
    "two motors of one motion": Try(
        LINKS,
        f"{DRIVE.format('j')} & motors.n={{joint='j', motion={{kind='Steady', rate=2}}}}",
        "one motor for each",
        "motors.n.joint=k",
    ),
    "table of a motor": Try(
        LINKS, f"{TABLED} & motors.m.motion.values=[0]", "as many as times", "motors.m.motion.values=[0, 2]"
    ),
    "times of a motor": Try(
        LINKS, f"{TABLED} & motors.m.motion.times=[1, 0]", "increasing times", "motors.m.motion.times=[0, 1]"
    ),
    "gear of one joint": Try(
        LINKS, f"{GEARED} & gears.g.joints=['j', 'j']", "two different", "gears.g.joints=['j', 'k']"
    ),
    "gear without a ratio": Try(LINKS, f"{GEARED} & gears.g.ratio=0", "other than zero", "gears.g.ratio=2"),
    "gear of no joint": Try(LINKS, f"{GEARED} & gears.g.joints=['j', 'i']", "two of", "gears.g.joints=['j', 'k']"),
    "gear of sliders": Try(
        LINKS,
        f"{SLIDING} & {GEARED}",
        "with an angle",
        "joints.k={kind='Hinge', between=['ground', 'c'], at=[1, 0]}",
    ),
    "torsion of no joint": Try(LINKS, f"{TORSION} & springs[0].joint=i", "one of ['j', 'k']", "springs[0].joint=j"),
    "pitch": Try(
        FREE,
        "joints.j={kind='Screw', between=['a', 'c'], at=[0, 0, 0], axis=[0, 0, 1], pitch=0}",
        "a full turn",
        "joints.j.pitch=0.01",
    ),
    "joint of welded bodies": Try(
        LINKS,
        f"stops={{}} & joints.w={{kind='Weld', between=['a', 'c'], at=[1, 0]}} & {DRIVE.format('k')}",
        "no weld",
        "joints.w={kind='Hinge', between=['ground', 'c'], at=[2, 0]}",
    ),
    "force": Try(
        LINKS, "forces=[{on='a', at=[0.5, 0], value=[1]}]", "2 finite", "forces=[{on='a', at=[0.5, 0], value=[1, 0]}]"
    ),
    "force on no body": Try(
        LINKS, "forces=[{on='b', at=[0, 0], value=[1, 0]}]", "known: a, c", "forces=[{on='a', at=[0, 0], value=[1, 0]}]"
    ),
    "infinite force": Call(
        lambda _: PointForce(on="a", at=(0.0, 0.0), value=(inf, 0.0)),
        "finite",
        lambda _: PointForce(on="a", at=(0.0, 0.0), value=(1.0, 0.0)),
    ),
    "rate": Call(lambda _: Steady(rate=inf), "metres per second", lambda _: Steady(rate=1.0)),
    "sine": Call(
        lambda _: Sine(amplitude=inf, frequency=1.0), "a finite", lambda _: Sine(amplitude=1.0, frequency=1.0)
    ),
    "box": Call(
        lambda _: rigid_box(size=(1, 1, 1), density=1.0, centre=(0, 0, 0), edges=((1, 0, 0), (1, 1, 0))),
        "perpendicular",
        lambda _: rigid_box(size=(1, 1, 1), density=1.0, centre=(0, 0, 0), edges=((1, 0, 0), (0, 1, 0))),
    ),
    "rod": Call(
        lambda _: rigid_rod(ends=((0.0, 0.0), (0.0, 0.0)), line_density=1.0),
        "two different places",
        lambda _: rigid_rod(ends=((0.0, 0.0), (1.0, 0.0)), line_density=1.0),
    ),
    "disc": Call(
        lambda _: rigid_disc(radius=0.0, density=1.0, centre=(0.0, 0.0)),
        "a positive number",
        lambda _: rigid_disc(radius=1.0, density=1.0, centre=(0.0, 0.0)),
    ),
    "mesh of a line": Call(
        lambda _: rigid_mesh(interval(1.0, 2), density=1.0),
        "a mesh of the plane",
        lambda _: rigid_mesh(rectangle((1.0, 1.0), (2, 2)), density=1.0),
    ),
    "density of a mesh": Call(
        lambda _: rigid_mesh(rectangle((1.0, 1.0), (2, 2)), density=0.0),
        "the density",
        lambda _: rigid_mesh(rectangle((1.0, 1.0), (2, 2)), density=1.0),
    ),
    "thickness of a mesh": Call(
        lambda _: rigid_mesh(rectangle((1.0, 1.0), (2, 2)), density=1.0, thickness=0.0),
        "the thickness",
        lambda _: rigid_mesh(rectangle((1.0, 1.0), (2, 2)), density=1.0, thickness=1.0),
    ),
    "open surface": Call(
        lambda _: rigid_surface(SQUARE, EDGES[:3], density=1.0),
        "without holes",
        lambda _: rigid_surface(SQUARE, EDGES, density=1.0),
    ),
    "table that is not finite": Call(
        lambda _: Polyline(times=(0.0, 1.0), values=(0.0, inf)),
        "finite numbers",
        lambda _: Polyline(times=(0.0, 1.0), values=(0.0, 1.0)),
    ),
    "torque about a hinge": Call(
        lambda _: HingeTorque(joint="j", value=inf), "", lambda _: HingeTorque(joint="j", value=1.0)
    ),
}
