"""Refusals of rigid bodies beside solids, and of rigid bodies from shapes."""

from try_it import Table, Try

MIXED = """
[bodies.b]
kind = "Solid"
mesh = { kind = "Rectangle", size = [1, 1], cells = [3, 3], origin = [0, -1] }
material = { kind = "LinearElastic", E = 1000, nu = 0.3 }
density = 1
[bodies.r]
kind = "Rigid"
mass = 1
centre = [0.5, 0.3]
inertia = 0.1
shape = { kind = "Sphere", centre = [0.5, 0.3], radius = 0.2 }
[[contacts]]
between = ["b.top", "r"]
[time]
end = 0.01
"""
"""A disc above a square."""
CARRIED = "bodies.b.supports=[{kind='Carried', on='bottom', by='r'}]"
ROUND = "bodies.b.section={kind='Axisymmetric'}"
SLIDER = "joints.axis={kind='Slider', between=['ground', 'r'], at=[0, 0.3], axis=[0, 1]}"
DENSE = "{kind='Rigid', shape={kind='Sphere', centre=[0.5, 0.3], radius=0.2}, density=1}"
ON_AXIS = "bodies.r.centre=[0, 0.3] & bodies.r.shape.centre=[0, 0.3]"
HOT = "bodies.b.thermal={temperature=300, law={conductivity=1, capacity=1}}"
WARM = f"{HOT} & bodies.r.thermal={{temperature=300, capacity=1, area=1}}"
FLUX = "loads=[{kind='HeatFlux', on='r', value=1}]"
FACE = "loads=[{kind='HeatFlux', on='r.face', value=1}]"


def meets(heat: str, friction: str = "{kind='Frictionless'}") -> str:
    """Change to a contact with heat."""
    return f"{WARM} & contacts=[{{between=['b.top', 'r'], friction={friction}, heat={{{heat}}}}}]"


PAIR = """
[bodies.b]
kind = "Solid"
mesh = { kind = "Rectangle", size = [1, 1], cells = [1, 1], origin = [0, -3] }
material = { kind = "LinearElastic", E = 1000, nu = 0.3 }
density = 1
thermal = { temperature = 300, law = { conductivity = 1, capacity = 1 } }
[bodies.r]
kind = "Rigid"
mass = 1
centre = [0, 0]
inertia = 0.1
thermal = { temperature = 300, capacity = 1 }
[bodies.q]
kind = "Rigid"
mass = 1
centre = [0, 1]
inertia = 0.1
thermal = { temperature = 310, capacity = 1 }
[stops.seat]
kind = "PlaneStop"
between = ["r", "q"]
point = [0, 1]
plane = [0, 1]
normal = [0, 1]
[[heat_links]]
between = ["r", "q"]
conductance = 1
[time]
end = 0.01
"""
"""Two rigid bodies with a temperature."""
LINK = "heat_links=[{between=['r', 'q'], conductance=1}]"
SEAT = "heat_links=[{stop='seat', share=0.5}]"


def links(**given: object) -> str:
    """Change to one heat link."""
    return "heat_links=[{" + ", ".join(f"{key}={value!r}" for key, value in given.items()) + "}]"


RUBS = "{kind='Coulomb', mu=0.1}"

TABLE: Table = {
    "no heat capacity": Try(MIXED, f"{HOT} & bodies.r.thermal={{temperature=300}}", "either specific_heat", WARM),
    "a conductivity without a density": Try(
        PAIR,
        "bodies.r.thermal={temperature=300, capacity=1, conductivity=2}",
        "no conductivity",
        "bodies.r={kind='Rigid', shape={kind='Block', low=[-1, -1], high=[1, 0]}, density=1, "
        "thermal={temperature=300, capacity=1, conductivity=2}}",
    ),
    "a rigid body alone is hot": Try(
        MIXED, "bodies.r.thermal={temperature=300, capacity=1}", "bodies.NAME.thermal of a solid", WARM
    ),
    "heat of a mechanism": Try(
        MIXED,
        f"bodies={{r={DENSE.replace('}, density', '}, thermal={temperature=300, capacity=1}, density')}}} "
        "& contacts=[] & time.step=0.001",
        "omit it",
        f"bodies={{r={DENSE}}} & contacts=[] & time.step=0.001",
    ),
    "heat between nothing": Try(PAIR, links(conductance=1), "stop = the name of one", LINK),
    "heat that passes backwards": Try(
        PAIR, links(between=["r", "q"], conductance=-1), "zero or a positive number", SEAT
    ),
    "heat that does not pass": Try(PAIR, links(between=["r", "q"]), "a positive number", LINK),
    "a share of no stop": Try(PAIR, links(between=["r", "q"], conductance=1, share=0.5), "omit it", LINK),
    "heat of no stop": Try(PAIR, links(stop="wall"), "one of ['seat']", SEAT),
    "heat with the ground": Try(PAIR, links(between=["r", "ground"], conductance=1), "['r', 'q']", LINK),
    "heat with itself": Try(PAIR, links(between=["r", "r"], conductance=1), "two different bodies", LINK),
    "a stop that heats twice": Try(
        PAIR,
        "heat_links=[{stop='seat', share=0.5}, {stop='seat', conductance=1, share=0.5}]",
        "one link of the stop",
        "heat_links=[{stop='seat', conductance=1, share=0.5}]",
    ),
    "a stop that nobody shares": Try(PAIR, links(stop="seat"), "a share from 0 to 1", SEAT),
    "heat on a face of a rigid body": Try(MIXED, f"{WARM} & {FACE}", "'r'", f"{WARM} & {FLUX}"),
    "heat on no area": Try(
        MIXED, f"{WARM.replace(', area=1', '')} & {FLUX}", "bodies.r.thermal.area", f"{WARM} & {FLUX}"
    ),
    "a source in no volume": Try(
        MIXED, f"{WARM} & loads=[{{kind='HeatSource', of='r', value=1}}]", "a HeatFlux on its area", f"{WARM} & {FLUX}"
    ),
    "two temperatures of a rigid body": Try(
        MIXED, meets("conductance=1, tool_temperature=300"), "omit it", meets("conductance=1")
    ),
    "friction whose heat nobody shares": Try(
        MIXED, meets("conductance=1", RUBS), "a share from 0 to 1", meets("conductance=1, share=0.5", RUBS)
    ),
    "no carrier": Try(MIXED, "bodies.b.supports=[{kind='Carried', on='bottom', by='q'}]", "one of ['r']", CARRIED),
    "no rigid at all": Try(
        MIXED,
        f"bodies={{b={{kind='Solid', mesh={{kind='Rectangle', size=[1, 1], cells=[3, 3]}}, "
        f"material={{kind='LinearElastic', E=1, nu=0.3}}, density=1}}}} & contacts=[] & {CARRIED}",
        "a Rigid among the bodies",
        "bodies.b.supports=[]",
    ),
    "carried twice": Try(
        MIXED,
        "bodies.b.supports=[{kind='Carried', on='bottom', by='r'}, {kind='Driven', on='left', velocity=0}]",
        "tags without common nodes",
        CARRIED,
    ),
    "explicit": Try(MIXED, "solver=Explicit", "FixedPoint or Newton", "solver=FixedPoint"),
    "scaled": Try(MIXED, "inertia={kind='Scaled', factor=2}", "omit it", "inertia=Full"),
    "static": Try(MIXED, "start=StaticStart", 'start = "AsGiven"', "start=AsGiven"),
    "rule": Try(MIXED, "contacts[0].timing=Impulse", "the rule Energy", "contacts[0].timing=Energy"),
    "off the axis": Try(MIXED, f"{ROUND} & {ON_AXIS}", "[joints.axis]", f"{ROUND} & {ON_AXIS} & {SLIDER}"),
    "the solid first": Try(
        MIXED, "contacts=[{between=['r', 'b.top']}]", "the solid first", "contacts=[{between=['b.top', 'r']}]"
    ),
    "a tag of a rigid body": Try(
        MIXED, "contacts=[{between=['b.top', 'r.face']}]", "its name", "contacts=[{between=['b.top', 'r']}]"
    ),
    "no inertia": Try(MIXED, "bodies.r.inertia=0", "its moment of inertia", "bodies.r.inertia=0.1"),
    "no surface": Try(
        MIXED,
        "bodies.r={kind='Rigid', mass=1, centre=[0.5, 0.3], inertia=0.1}",
        "bodies.r.shape",
        "bodies.r={kind='Rigid', mass=1, centre=[0.5, 0.3], inertia=0.1, "
        "shape={kind='Sphere', centre=[0.5, 0.3], radius=0.2}}",
    ),
    "another dimension": Try(
        MIXED,
        "bodies.r={kind='Rigid', mass=1, centre=[0, 0, 0]} & contacts=[]",
        "2 coordinates",
        "bodies.r={kind='Rigid', mass=1, centre=[0, 1]} & contacts=[]",
    ),
    "a shape in space": Try(
        MIXED,
        "bodies.r.shape={kind='Sphere', centre=[0, 0, 0], radius=1}",
        "a shape in 2D",
        "bodies.r.shape={kind='Sphere', centre=[0.5, 0.3], radius=0.2}",
    ),
    "two masses": Try(MIXED, "bodies.r.density=1", "either mass or density", f"bodies.r={DENSE}"),
    "a negative density": Try(
        MIXED,
        "bodies.r={kind='Rigid', shape={kind='Sphere', centre=[0.5, 0.3], radius=0.2}, density=-1}",
        "a positive number",
        f"bodies.r={DENSE}",
    ),
    "a density alone": Try(
        MIXED,
        "bodies.r={kind='Rigid', density=1} & contacts=[]",
        "a shape, or mass",
        f"bodies.r={DENSE}",
    ),
    "no volume": Try(
        MIXED,
        "bodies.r={kind='Rigid', shape={kind='HalfSpace', point=[0, 0.1], normal=[0, -1]}, density=1}",
        "or mass, centre and inertia",
        f"bodies.r={DENSE}",
    ),
}
