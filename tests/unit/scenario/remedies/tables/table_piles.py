"""Refusals of balls, their walls and their tables."""

from try_it import Table, Try

PILE = """
[bodies.a]
kind = "BallLattice"
count = [2, 2]
radius = 0.1
density = 1
lowest = [0.2, 0.2]
[bodies.b]
kind = "BallList"
centres = [[0.2, 1.0], [0.5, 1.0]]
radius = 0.1
density = 1
[pile]
walls = [{ kind = "Box", lower = [0, 0], upper = [1, "open"] }]
[[loads]]
kind = "Gravity"
acceleration = [0, -1]
[time]
end = 0.01
step = 0.001
"""
"""Six discs in a box."""
LATTICE = "{kind='BallLattice', count=[2, 2], radius=0.1, density=1, lowest=[0.2, 0.2]}"
OTHER = "bodies.b={kind='BallList', centres=[[0.2, 1.0]], radius=0.1, density=1}"
SPACE = "bodies.b={kind='BallList', centres=[[0, 0, 5]], radius=0.1, density=1}"
RIGID = "{kind='Rigid', mass=1, centre=[0.5, 3], inertia=0.1}"
STOP = "stops.s={kind='DistanceStop', between=['a', 'b'], points=[[0, 0], [0, 1]], distance=1}"
OPEN = "pile.walls=[{kind='Box', lower=['open', 'open'], upper=['open', 'open']}]"
WALL = "pile.walls=[{kind='Wall', point=[0, 0], normal=[0, 1]}]"
BOX = "pile.walls=[{kind='Box', lower=[0, 0], upper=[1, 2]}]"

TABLE: Table = {
    "another body": Try(PILE, f"bodies.b={RIGID}", "only BallList", OTHER),
    "walls alone": Try(PILE, f"bodies={{r={RIGID}}}", "omit it", f"bodies={{a={LATTICE}}}"),
    "space and plane": Try(PILE, SPACE, "2 coordinates", OTHER),
    "a probe": Try(PILE, "output.probes=[{name='p', of='a'}]", "omit it", "output.probes=[]"),
    "another load": Try(PILE, "loads=[{kind='Traction', on='a', value=[1, 0]}]", "Gravity", "loads=[]"),
    "a solver": Try(PILE, "solver=Newton", "pile.sweeps", "solver=FixedPoint & pile.sweeps=50"),
    "a joint": Try(PILE, STOP, "Rigid", "stops={}"),
    "automatic step": Try(PILE, "time.step=auto", "a time such as", "time.step=0.001 s"),
    "no sweep": Try(PILE, "pile.sweeps=0", "1 or more", "pile.sweeps=1"),
    "overlap": Try(
        PILE, "bodies.b.centres=[[0.2, 1], [0.3, 1]]", "further apart", "bodies.b.centres=[[0.2, 1], [0.5, 1]]"
    ),
    "all open": Try(PILE, OPEN, "a coordinate", OPEN.replace("'open'", "0", 1)),
    "three components": Try(PILE, "bodies.a.velocity=[1, 0, 0]", "2 components", "bodies.a.velocity=[1, 0]"),
    "no file": Try(PILE, "bodies.b={kind='BallFile', path='no.csv', radius=0.1, density=1}", "a path", OTHER),
    "rows of one": Try(PILE, "bodies.b.centres=[[0], [1]]", "2 coordinates in the plane", OTHER),
    "two radii for one": Try(PILE, f"{OTHER} & bodies.b.radius=[1, 2]", "one number", "bodies.b.radius=0.1"),
    "one velocity for two": Try(PILE, "bodies.b.velocities=[[1, 0]]", "(2, 2)", "bodies.b.velocities=[[1, 0], [1, 0]]"),
    "beyond all numbers": Try(PILE, "bodies.b.centres=[[0, 1e200]]", "finite numbers", OTHER),
    "a line of balls": Try(PILE, "bodies.a.count=[2]", "two axes", "bodies.a.count=[2, 1]"),
    "a lattice in space": Try(PILE, "bodies.a.lowest=[1, 1, 1]", "2 coordinates", "bodies.a.lowest=[0.2, 0.2]"),
    "less than no jitter": Try(PILE, "bodies.a.jitter=-1", "zero or more", "bodies.a.jitter=0"),
    "narrow": Try(PILE, "bodies.a.spacing=0.1", "0.2 m or more", "bodies.a.spacing=0.2"),
    "a wall in space": Try(PILE, WALL.replace("0, 0", "0, 0, 0").replace("1]", "1, 0]"), "2 coordinates", WALL),
    "no direction": Try(PILE, WALL.replace("1]", "0]"), "not all zero", WALL),
    "a point of one": Try(PILE, WALL.replace("point=[0, 0]", "point=[0]"), "two coordinates", WALL),
    "sides that differ": Try(PILE, BOX.replace("[1, 2]", "[1, 2, 1]"), "as many sides", BOX),
    "upside down": Try(PILE, BOX.replace("[1, 2]", "[-1, 2]"), "a greater coordinate", BOX),
    "negative friction": Try(PILE, "pile.friction=-1", "zero or more", "pile.friction=0"),
    "gaining": Try(PILE, "pile.restitution=2", "1 for no loss", "pile.restitution=1"),
}
