"""Refusals of rigid bodies, joints, stops, springs and torques."""

from try_it import PLANE, Call, Table, Try

from softway.mechanisms import DistanceStop, Mechanism, PlaneStop, Rigid, march

LINKS = """
[bodies.a]
kind = "Rigid"
mass = 1
centre = [0.5, 0]
inertia = 0.1
[bodies.c]
kind = "Rigid"
mass = 1
centre = [1.5, 0]
inertia = 0.1
[joints.j]
kind = "Hinge"
between = ["ground", "a"]
at = [0, 0]
[joints.k]
kind = "Hinge"
between = ["a", "c"]
at = [1, 0]
[stops.s]
kind = "PlaneStop"
between = ["ground", "c"]
point = [2, 0]
plane = [0, -1]
normal = [0, 1]
[time]
end = 0.01
step = 0.001
"""
"""Two arms in the plane above a floor."""
FREE = """
[bodies.a]
kind = "Rigid"
mass = 1
centre = [0, 0, 0]
inertia = [0.1, 0.1, 0.1]
[bodies.c]
kind = "Rigid"
mass = 1
centre = [1, 0, 0]
inertia = [0.1, 0.1, 0.1]
[time]
end = 0.01
step = 0.001
"""
"""Two bodies in space."""
TOOL = "joints={} & stops={} & bodies.c={kind='Tool', shape={kind='HalfSpace', point=[0, 0], normal=[0, 1]}}"
RIGID = "bodies={a={kind='Rigid', mass=1, centre=[0, 0]}} & contacts=[] & time.step=0.001"
HINGE = "{kind='Hinge', between=['ground', 'a'], at=[0, 0]}"
SPRING = "springs=[{between=['ground', 'a'], ends=[[0, 1], [0.5, 0]], stiffness=1}]"


def one(**given: object) -> Mechanism:
    """Mechanism of one free body."""
    return Mechanism(bodies={"a": Rigid(mass=1.0, centre=(0.0, 0.0))}, **given)


def floor(**given: object) -> PlaneStop:
    """Floor under the body."""
    words = {"between": ("ground", "a"), "point": (0.0, 0.0), "plane": (0.0, 0.0), "normal": (0.0, 1.0)}
    return PlaneStop(**(words | given))


TABLE: Table = {
    "a tool": Try(LINKS, TOOL, "[stops.NAME]", "bodies.c={kind='Rigid', mass=1, centre=[3, 0]}"),
    "no rigid, joints": Try(PLANE, f"joints.j={HINGE}", 'kind = "Rigid" only', f"{RIGID} & bodies.a.inertia=1"),
    "no rigid, impacts": Try(PLANE, "impacts=sequential", 'kind = "Rigid" only', RIGID),
    "contacts": Try(LINKS, "contacts=[{between=['a', 'c']}]", "[stops.NAME]", "contacts=[]"),
    "weight": Try(LINKS, "time.weight=Momentum", "omit it", "time.weight=EndPeaks"),
    "no body": Try(LINKS, "joints.k.between=['a', 'b']", "known: a, c, ground", "joints.k.between=['a', 'c']"),
    "no body of a torque": Try(LINKS, "torques=[{on='b', value=1}]", "known: a, c", "torques=[{on='a', value=1}]"),
    "traction": Try(
        LINKS,
        "loads=[{kind='Traction', on='a', value=[0, 1]}]",
        "[[torques]]",
        "loads=[] & torques=[{on='a', value=1}]",
    ),
    "ramp": Try(
        LINKS,
        "loads=[{kind='Gravity', acceleration=[0, -9.81], ramp={times=[0, 1], factors=[0, 1]}}]",
        "omit it",
        "loads=[{kind='Gravity', acceleration=[0, -9.81]}]",
    ),
    "overlap": Try(LINKS, "stops.s.plane=[0, 0.5]", "a gap of zero or more", "stops.s.plane=[0, 0]"),
    "auto": Try(LINKS, "time.step=auto", '"1e-05 s"', "time.step=1e-5 s"),
    "long step": Try(LINKS, "time.step=1", "a shorter step", "time.step=0.01"),
    "too many slabs": Try(LINKS, "time.step=1e-13", "longer slabs", "time.step=1e-3"),
    "probe of no body": Try(
        LINKS, "output.probes=[{name='p', of='b'}]", "one of ['a', 'c']", "output.probes=[{name='p', of='a'}]"
    ),
    "probe of a column": Try(
        LINKS, "output.probes=[{name='time', of='a'}]", "another name", "output.probes=[{name='p', of='a'}]"
    ),
    "probe with a tag": Try(
        LINKS, "output.probes=[{name='p', of='a', tag='top'}]", "'at'", "output.probes=[{name='p', of='a', at=[0, 0]}]"
    ),
    "probe of a reaction": Try(
        LINKS,
        "output.probes=[{name='p', of='a', quantity='reaction'}]",
        "'spin'",
        "output.probes=[{name='p', of='a', quantity='spin', component='z'}]",
    ),
    "probe of a spin at a point": Try(
        LINKS,
        "output.probes=[{name='p', of='a', quantity='spin', component='z', at=[0, 0]}]",
        "omit 'at'",
        "output.probes=[{name='p', of='a', quantity='spin', component='z'}]",
    ),
    "probe of a component": Try(
        LINKS,
        "output.probes=[{name='p', of='a', quantity='spin'}]",
        "'z'",
        "output.probes=[{name='p', of='a', quantity='spin', component='z'}]",
    ),
    "probe at a point": Try(
        LINKS,
        "output.probes=[{name='p', of='a', at=[0]}]",
        "2 coordinates",
        "output.probes=[{name='p', of='a', at=[0, 0]}]",
    ),
    "mass": Try(LINKS, "bodies.a.mass=0", "the mass of the body", "bodies.a.mass=1"),
    "centre": Try(LINKS, "bodies.a.centre=[1]", "two coordinates", "bodies.a.centre=[0.5, 0]"),
    "velocity": Try(LINKS, "bodies.a.velocity=[1]", "2 components", "bodies.a.velocity=[1, 0]"),
    "great velocity": Try(LINKS, "bodies.a.velocity=[1e200, 0]", "of a motion", "bodies.a.velocity=[1, 0]"),
    "spin": Try(LINKS, "bodies.a.spin=[1, 1, 1]", "one component", "bodies.a.spin=1"),
    "inertia in the plane": Try(LINKS, "bodies.a.inertia=[1, 1, 1]", "one moment", "bodies.a.inertia=1"),
    "inertia in space": Try(FREE, "bodies.a.inertia=1", "three principal", "bodies.a.inertia=[1, 1, 1]"),
    "inertia not symmetric": Try(
        FREE, "bodies.a.inertia=[[1, 1, 0], [0, 1, 0], [0, 0, 1]]", "a symmetric", "bodies.a.inertia=[1, 1, 1]"
    ),
    "negative inertia": Try(LINKS, "bodies.a.inertia=-1", "zero or more", "bodies.a.inertia=1"),
    "impossible inertia": Try(FREE, "bodies.a.inertia=[1, 1, 9]", "of matter", "bodies.a.inertia=[1, 1, 1]"),
    "ground": Try(
        LINKS,
        "joints={} & stops={} & bodies={ground={kind='Rigid', mass=1, centre=[0, 0]}}",
        "another name",
        "bodies={a={kind='Rigid', mass=1, centre=[0, 0]}}",
    ),  # fmt: skip
    "plane and space": Try(
        LINKS,
        "bodies.c.centre=[1.5, 0, 0] & bodies.c.inertia=0",
        "of two or of three",
        "bodies.c.centre=[1.5, 0] & bodies.c.inertia=1",
    ),
    "point in space": Try(LINKS, "joints.k.at=[1, 0, 0]", "2 coordinates", "joints.k.at=[1, 0]"),
    "one body twice": Try(LINKS, "joints.k.between=['a', 'a']", "two different", "joints.k.between=['a', 'c']"),
    "one name twice": Try(
        LINKS,
        f"stops={{}} & joints.s={HINGE} & stops.s="
        "{kind='PlaneStop', between=['ground', 'c'], point=[2, 0], plane=[0, -1], normal=[0, 1]}",
        "other names",
        "stops={}",
    ),  # fmt: skip
    "axis of a slider": Try(
        LINKS,
        "joints.k={kind='Slider', between=['a', 'c'], at=[1, 0], axis=[0, 0]}",
        "not all zero",
        "joints.k.axis=[1, 0]",
    ),  # fmt: skip
    "no axis in space": Try(
        FREE, "joints.j={kind='Hinge', between=['a', 'c'], at=[0, 0, 0]}", "(0, 0, 1)", "joints.j.axis=[0, 0, 1]"
    ),  # fmt: skip
    "axes": Try(
        FREE,
        "joints.j={kind='Universal', between=['a', 'c'], at=[0, 0, 0], axes=[[1, 0, 0], [1, 0, 0]]}",
        "two perpendicular",
        "joints.j.axes=[[1, 0, 0], [0, 1, 0]]",
    ),  # fmt: skip
    "rod without length": Try(
        LINKS,
        "joints.k={kind='Rod', between=['a', 'c'], ends=[[1, 0], [1, 0]]}",
        "two places",
        "joints.k.ends=[[1, 0], [1, 1]]",
    ),  # fmt: skip
    "no inertia": Try(LINKS, "bodies.a.inertia=0", "its inertia", "bodies.a.inertia=0.1"),
    "all welded": Try(
        LINKS,
        "stops={} & joints={j={kind='Weld', between=['ground', 'a'], at=[0, 0]}, "
        "k={kind='Weld', between=['a', 'c'], at=[1, 0]}}",
        "lets a body move",
        "joints.k.kind=Hinge",
    ),
    "normal": Try(LINKS, "stops.s.normal=[0, 0]", "not all zero", "stops.s.normal=[0, 1]"),
    "radius": Try(LINKS, "stops.s.radius=-1", "zero or more", "stops.s.radius=0.5"),
    "restitution": Try(LINKS, "stops.s.restitution=2", "no rebound", "stops.s.restitution=1"),
    "friction": Try(LINKS, "stops.s.friction=-1", "zero or more", "stops.s.friction=0"),
    "friction at rest": Try(LINKS, "stops.s.friction=0.3 & stops.s.mu_s=0.2", "friction or more", "stops.s.mu_s=0.3"),
    "rolling": Try(LINKS, "stops.s.rolling=-1", "zero or more", "stops.s.rolling=0.01"),
    "drilling": Try(LINKS, "stops.s.drilling=0.1", "omit it", "stops.s.drilling=0"),
    "belt of another dimension": Try(
        LINKS, "stops.s.friction=0.3 & stops.s.velocity=[1, 0, 0]", "2 finite", "stops.s.velocity=[1, 0]"
    ),
    "belt across": Try(
        LINKS, "stops.s.friction=0.3 & stops.s.velocity=[1, 1]", "along the normal", "stops.s.velocity=[1, 0]"
    ),
    "belt without friction": Try(
        LINKS, "stops.s.velocity=[1, 0]", "friction above zero", "stops.s.friction=0.3 & stops.s.velocity=[1, 0]"
    ),
    "distance": Try(
        LINKS,
        "stops.s={kind='DistanceStop', between=['a', 'c'], points=[[0, 0], [2, 0]], distance=0}",
        "at which the stop acts",
        "stops.s.distance=1",
    ),  # fmt: skip
    "side": Call(
        lambda _: DistanceStop(between=("a", "b"), points=((0.0, 0.0), (1.0, 0.0)), distance=1.0, side="up"),
        "'most'",
        lambda _: DistanceStop(between=("a", "b"), points=((0.0, 0.0), (1.0, 0.0)), distance=1.0, side="most"),
    ),
    "stiffness": Try(LINKS, f"{SPRING} & springs[0].stiffness=-1", "zero or more", "springs[0].stiffness=1"),
    "torque in the plane": Try(
        LINKS, "torques=[{on='a', value=[1, 1, 1]}]", "one component", "torques=[{on='a', value=1}]"
    ),
    "no bodies": Call(lambda _: Mechanism(bodies={}), "at least one", lambda _: one()),
    "gravity": Call(lambda _: one(gravity=(1.0,)), "2 components", lambda _: one(gravity=(1.0, 0.0))),
    "restitution of impacts": Call(
        lambda _: one(restitution="none"), "'Poisson'", lambda _: one(restitution="Poisson")
    ),
    "impacts": Call(lambda _: one(impacts="none"), "'sequential'", lambda _: one(impacts="sequential")),
    "unknown body": Call(
        lambda _: one(stops={"s": floor(between=("ground", "b"))}),
        "['a', 'ground']",
        lambda _: one(stops={"s": floor()}),
    ),
    "until": Call(
        lambda _: march(one(), until=0.0, step=1.0), "after the start", lambda _: march(one(), until=1.0, step=1.0)
    ),
    "short step": Call(
        lambda _: march(one(), until=1.0, step=1e-300), "longer", lambda _: march(one(), until=1.0, step=1e-3)
    ),
    "step": Call(
        lambda _: march(one(), until=1.0, step=2.0), "at most 1 s", lambda _: march(one(), until=1.0, step=1.0)
    ),
    "every": Call(
        lambda _: march(one(), until=1.0, step=1.0, every=0), "1 or more", lambda _: march(one(), until=1.0, step=1.0)
    ),
}
