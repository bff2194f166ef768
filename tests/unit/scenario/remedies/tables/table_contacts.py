"""Refusals of contacts, tools and their motion."""

from math import inf

from try_it import BAR, PLANE, SOLID, SPACE, TWO, Call, Table, Try

from softway import Tie
from softway.bodies import Haversine, SmoothSteps

PAIR = "contacts[0].between"
SHAPE, MOTION = "bodies.w.shape", "bodies.w.motion"
TIES = "ties[0].between"
GLUED = "contacts=[] & bodies.c.mesh.origin=[0, -0.99] & ties=[{between=['b.bottom', 'c.top']}]"
BREAKS = "contacts=[] & bodies.c.mesh.origin=[0, -0.99] & " + (
    "ties=[{between=['b.bottom', 'c.top'], breaks={strength=1, energy=1, stiffness=10}}]"
)
HELD = "bodies.b.supports=[{on='left'}] & bodies.c.supports=[{on='right'}]"
FLOOR = TWO + '[bodies.w]\nkind = "Tool"\nshape = { kind = "HalfSpace", point = [0, -2], normal = [0, 1] }'
SHAFT = FLOOR + '\n[bodies.v]\nkind = "Tool"\nshape = { kind = "HalfSpace", point = [3, 0], normal = [-1, 0] }'
"""Two squares between a floor and a wall."""
PAIRED = "{between=['b', 'w']}, {between=['b', 'v']}"
THREE = f"""{TWO}
[bodies.d]
mesh = {{ kind = "Rectangle", size = [1, 1], cells = [2, 2], origin = [0, -0.99] }}
{SOLID}
"""
OF_TIES: Table = {
    "tie that cools": Try(
        TWO, "ties=[{between=['b.bottom', 'c.top'], conductance=-1}]", "zero or a positive number", GLUED
    ),
    "heat through a tie that breaks": Try(
        TWO,
        "ties=[{between=['b.bottom', 'c.top'], conductance=1, breaks={strength=1, energy=1, stiffness=10}}]",
        "bodies.b.thermal, or no conductance",
        GLUED,
    ),
    "tie of a tool": Try(PLANE, "ties=[{between=['b.bottom', 'w.top']}]", "known: b", "ties=[]"),
    "tie of no tag": Try(TWO, "ties=[{between=['b.bottom', 'c.tip']}]", "top", "contacts=[] & ties=[]"),
    "tie of a body": Try(TWO, "ties=[{between=['b', 'c.top']}]", "two surfaces of solids", GLUED),
    "tie with itself": Try(TWO, "ties=[{between=['b.top', 'b.top']}]", "two surfaces of solids", GLUED),
    "tie of three": Try(TWO, "ties=[{between=['b.top', 'b.left', 'c.top']}]", "a list of 2 entries", GLUED),
    "tie twice": Try(
        TWO,
        f"{GLUED} & ties=[{{between=['b.bottom', 'c.top']}}, {{between=['c.top', 'b.bottom']}}]",
        "a single tie",
        GLUED,
    ),
    "tie tolerance": Try(TWO, f"{GLUED} & ties[0].tolerance=-1", "a fraction such as 0.05", "ties[0].tolerance=0.05"),
    "tie with a gap": Try(
        TWO, f"{GLUED} & bodies.c.mesh.origin=[0, -1.09]", "tolerance = 0.303", "ties[0].tolerance=0.303"
    ),
    "tie with a wide gap": Try(
        TWO, f"{GLUED} & bodies.c.mesh.origin=[0, -3]", "bodies that touch there", "bodies.c.mesh.origin=[0, -0.99]"
    ),
    "tie of surfaces beside each other": Try(
        TWO,
        f"{GLUED} & bodies.c.mesh.origin=[0.5, -0.99]",
        "one lies on the other completely",
        "bodies.c.mesh.origin=[0, -0.99]",
    ),
    "tie of surfaces that look the same way": Try(
        TWO,
        f"{GLUED} & {TIES}=['b.bottom', 'c.bottom']",
        "one lies on the other completely",
        f"{TIES}=['b.bottom', 'c.top']",
    ),
    "tie with velocities that differ": Try(
        TWO,
        f"{GLUED} & bodies.b.velocity=[0, -1]",
        "the same velocity on b.bottom and c.top",
        "bodies.c.velocity=[0, -1]",
    ),
    "tie with a driven support": Try(
        TWO,
        f"{GLUED} & bodies.b.supports=[{{kind='Driven', on='bottom', velocity=0}}]",
        "a tag without nodes of the tie",
        "bodies.b.supports[0].on=top",
    ),
    "tie with a support": Try(
        TWO, f"{GLUED} & {HELD}", "a tag without nodes of the tie", "bodies.b.supports[0].on=top"
    ),
    "two ties of a node": Try(
        THREE,
        f"{GLUED} & bodies.c.mesh.size=[2, 1] & bodies.d.mesh.size=[2, 1] & "
        "ties=[{between=['b.bottom', 'c.top']}, {between=['b.bottom', 'd.top']}]",
        "no nodes with those of other ties",
        "ties=[{between=['b.bottom', 'c.top']}]",
    ),
    "contact of covered facets": Try(
        TWO,
        f"{GLUED} & contacts=[{{between=['b.bottom', 'c.left']}}]",
        "a tag of its free surface",
        "contacts=[{between=['b.top', 'c.bottom']}]",
    ),
    "contact beside a tie": Try(
        TWO, f"{GLUED} & contacts=[{{between=['b.left', 'c.left']}}]", '"all"', "contacts=[{between='all'}]"
    ),
    "tie with another rule": Try(
        FLOOR,
        f"{GLUED} & contacts=[{{between=['c.bottom', 'w'], timing={{kind='Impulse'}}}}]",
        "the rule Energy",
        "contacts=[{between=['c.bottom', 'w']}]",
    ),
    "tie of one name": Call(
        lambda _: Tie(between=("b.bottom",)),  # type: ignore[arg-type]
        "two surfaces of solids",
        lambda _: Tie(between=("b.bottom", "c.top")),
    ),
    "glue that dissipates less than it stores": Try(
        TWO, f"{BREAKS} & ties[0].breaks.energy=0.01", "a stiffness such as 100 Pa/m", "ties[0].breaks.stiffness=100"
    ),
    "glue that dissipates less in shear": Try(
        TWO, f"{BREAKS} & ties[0].breaks.shear_strength=9", "a lower strength", "ties[0].breaks.shear_strength=2"
    ),
    "glue that starts open": Try(
        TWO,
        f"{BREAKS} & bodies.b.displacement=[0, 0.3]",
        "the same displacement on b.bottom and c.top",
        "bodies.c.displacement=[0, 0.3]",
    ),
    "glue with a static start": Try(
        TWO,
        f"{BREAKS} & start={{kind='StaticStart'}} & {HELD}",
        'start = "AsGiven"',
        "start={kind='AsGiven'}",
    ),
    "glue on bodies of revolution": Try(
        TWO,
        f"{BREAKS} & bodies.b.mesh.origin=[1, 0.01] & bodies.c.mesh.origin=[1, -0.99] & "
        "bodies.b.section={kind='Axisymmetric'} & bodies.c.section={kind='Axisymmetric'}",
        "a tie without breaks",
        "ties=[{between=['b.bottom', 'c.top']}]",
    ),
    "tie with central differences": Try(
        TWO, f"{GLUED} & solver={{kind='Explicit'}}", "FixedPoint or Newton", "solver={kind='FixedPoint'}"
    ),
}
WARM = "bodies.b.thermal={temperature=300, law={conductivity=1, capacity=1}}"

TABLE: Table = {
    "heat in the contact itself": Try(
        PLANE,
        f"{WARM} & contacts=[{{between=['b.bottom', 'w'], conductance=1}}]",
        "heat = { conductance = ... }",
        "contacts=[{between=['b.bottom', 'w'], heat={conductance=1, tool_temperature=300}}]",
    ),
    **OF_TIES,
    "tool first": Try(PLANE, f"{PAIR}=['w', 'b.bottom']", '["b.bottom", "w"]', f"{PAIR}=['b.bottom', 'w']"),
    "tag of a tool": Try(PLANE, f"{PAIR}=['b.bottom', 'w.top']", '["b.bottom", "w"]', f"{PAIR}=['b.bottom', 'w']"),
    "unknown body": Try(PLANE, f"{PAIR}=['bb.bottom', 'w']", "'b'", f"{PAIR}=['b.bottom', 'w']"),
    "unknown opponent": Try(PLANE, f"{PAIR}=['b.bottom', 'ww']", "'w'", f"{PAIR}=['b.bottom', 'w']"),
    "two tools": Try(PLANE, f"{PAIR}=['w', 'w']", "known: b", f"{PAIR}=['b.bottom', 'w']"),
    "unknown tag": Try(PLANE, f"{PAIR}=['b.botom', 'w']", "bottom, or one of", f"{PAIR}=['b.bottom', 'w']"),
    "one name": Try(TWO, f"{PAIR}=['b']", '["b", "b"]', f"{PAIR}=['b', 'b']"),
    "no name": Try(TWO, f"{PAIR}=[]", '"all"', f"{PAIR}=all"),
    "a name for a list": Try(TWO, f"{PAIR}=b", "a list of text", f"{PAIR}=all"),
    "mortar for all": Try(
        TWO,
        f"{PAIR}=all & contacts[0].method={{kind='DualMortar'}}",
        "NodeToSurface",
        "contacts[0].method=NodeToSurface",
    ),
    "mortar of surfaces that adjoin": Try(
        TWO,
        f"{PAIR}=['b.left', 'b.top'] & contacts[0].method={{kind='DualMortar'}}",
        "surfaces that are apart",
        f"{PAIR}=['b.left', 'b.right']",
    ),
    "friction by area for all": Try(
        TWO,
        f"{PAIR}=all & contacts[0].friction={{kind='Tresca', shear=1000}}",
        "in proportion to the pressure",
        "contacts[0].friction={kind='Coulomb', mu=0.3}",
    ),
    "all with another rule": Try(
        TWO,
        f"{PAIR}=all & contacts[0].timing={{kind='Impulse'}}",
        "contacts of two solids",
        f"{PAIR}=['b.bottom', 'c.top']",
    ),
    "tools alone": Try(PLANE, f"{PAIR}=['w', 'w', 'w']", "known: b", f"{PAIR}=['b', 'b', 'w']"),
    "list of pairs of others": Try(
        SHAFT,
        f"contacts=[{PAIRED}, {{between=['b', 'w', 'v']}}]",
        "leave this contact out",
        f"contacts=[{PAIRED}]",
    ),
    "no whole facet": Try(
        TWO,
        f"{PAIR}=['b.corner', 'c.top'] & bodies.b.mesh={{kind='MeshFile', path='tagged.inp'}} & "
        "bodies.b.place.bottom=0.01",
        "a tag that covers a surface",
        f"{PAIR}=['b.bottom', 'c.top']",
    ),
    "two of one name": Try(
        TWO,
        "contacts=[{name='a', between=['b.bottom', 'c.top']}, {name='a', between=['b.left', 'c.top']}]",
        "another name",
        "contacts[1].name=d",
    ),
    "the same pair": Try(
        TWO,
        "contacts=[{name='a', between=['b.bottom', 'c.top']}, {name='d', between=['c.top', 'b.bottom']}]",
        "a single contact",
        "contacts=[{name='a', between=['b.bottom', 'c.top']}]",
    ),
    "two rules": Try(
        TWO,
        "contacts=[{name='a', between=['b.bottom', 'c.top']}, "
        "{name='d', between=['b.left', 'c.top'], timing={kind='Impulse'}}]",
        "the same timing rule for all contacts",
        "contacts[0].timing={kind='Impulse'}",
    ),
    "mortar against a tool": Try(
        PLANE, "contacts[0].method={kind='DualMortar'}", "NodeToSurface", "contacts[0].method={kind='NodeToSurface'}"
    ),
    "mortar with another rule": Try(
        TWO,
        "contacts[0].method={kind='DualMortar'} & contacts[0].timing={kind='Impulse'}",
        "NodeToSurface",
        "contacts[0].method={kind='NodeToSurface'}",
    ),
    "inside": Try(PLANE, "bodies.b.place.bottom=-0.1", "out by 0.1 m", "bodies.b.place.bottom=0"),
    "inside, moved": Try(
        TWO, "bodies.b.place.translation=[0.2, -0.11]", "out by 0.1 m", "bodies.b.place.translation=[0.2, -0.01]"
    ),
    "inside, fitted": Try(TWO, "bodies.b.place.bottom=-0.01", 'start = "fit"', "contacts[0].start=fit"),
    "deep fit": Try(
        TWO,
        "bodies.b.place.bottom=-0.4 & contacts[0].start=fit",
        "cells of",
        "bodies.b.mesh.cells=[1, 2] & bodies.c.mesh.cells=[1, 2]",
    ),
    "deep fit, apart": Try(
        TWO,
        "bodies.b.place.bottom=-0.4 & contacts[0].start=fit",
        "bodies that start apart",
        "bodies.b.place.bottom=0.01",
    ),
    "friction in 1D": Try(
        BAR,
        "contacts[0].friction={kind='Coulomb', mu=0.3}",
        "two or three dimensions",
        "contacts[0].friction=Frictionless",
    ),
    "spread": Try(PLANE, "contacts[0].timing={kind='Energy', spread=0}", "1 or more", "contacts[0].timing.spread=1"),
    "calm": Try(PLANE, "contacts[0].timing={kind='Energy', calm=2}", "from 0 to 1", "contacts[0].timing.calm=0.2"),
    "calm, located": Try(
        PLANE,
        "contacts[0].timing={kind='Energy', calm=0.2, located=true}",
        "located = false",
        "contacts[0].timing.located=false",
    ),
    "method of nothing": Try(PLANE, "contacts[0].method=DualMorter", "DualMortar", "contacts[0].method=NodeToSurface"),
    "negative friction": Try(
        PLANE, "contacts[0].friction={kind='Coulomb', mu=-1}", "zero or more", "contacts[0].friction.mu=0"
    ),
    "infinite friction": Try(PLANE, "contacts[0].friction={kind='Coulomb', mu=inf}", "", "contacts[0].friction.mu=1"),
    "static below kinetic": Try(
        PLANE,
        "contacts[0].friction={kind='StaticKinetic', mu_s=0.1, mu_k=0.2}",
        "mu_s >= mu_k",
        "contacts[0].friction.mu_s=0.2",
    ),
    "Stribeck": Try(
        PLANE,
        "contacts[0].friction={kind='Stribeck', mu_s=0.1, mu_k=0.2, v_s=1}",
        "mu_s >= mu_k",
        "contacts[0].friction.mu_s=0.2",
    ),
    "half-space at no point": Try(PLANE, f"{SHAPE}.point=[]", "1, 2 or 3 finite coordinates", f"{SHAPE}.point=[0, 0]"),
    "normal of another space": Try(PLANE, f"{SHAPE}.normal=1", "2 finite components", f"{SHAPE}.normal=[0, 1]"),
    "no normal": Try(PLANE, f"{SHAPE}.normal=[0, 0]", "a vector out of the obstacle", f"{SHAPE}.normal=[0, 1]"),
    "tool in 1D": Try(
        PLANE,
        f"{SHAPE}={{kind='HalfSpace', point=0, normal=1}}",
        "2 coordinates",
        f"{SHAPE}={{kind='HalfSpace', point=[0, 0], normal=[0, 1]}}",
    ),
    "no radius": Try(
        PLANE, f"{SHAPE}={{kind='Sphere', centre=[0.5, -1], radius=0}}", "a positive length", f"{SHAPE}.radius=0.9"
    ),
    "no axis": Try(
        SPACE,
        f"{SHAPE}={{kind='Torus', centre=[0, 0, -2], axis=[0, 0, 0], radius=1, tube=0.1}}",
        "[0, 0, 1]",
        f"{SHAPE}.axis=[0, 0, 1]",
    ),
    "thick torus": Try(
        SPACE,
        f"{SHAPE}={{kind='Torus', centre=[0, 0, -2], axis=[0, 0, 1], radius=0.1, tube=0.2}}",
        "a greater radius",
        f"{SHAPE}.radius=0.3",
    ),
    "cylinder of no length": Try(
        SPACE,
        f"{SHAPE}={{kind='Cylinder', start=[0, 0, -1], end=[0, 0, -1], radius=0.1}}",
        "another point",
        f"{SHAPE}.end=[1, 0, -1]",
    ),
    "flat block": Try(
        PLANE, f"{SHAPE}={{kind='Block', low=[0, -1], high=[1, -1]}}", "low < high", f"{SHAPE}.high=[1, 0]"
    ),
    "motion in another space": Try(
        PLANE, f"{MOTION}={{kind='Translation', velocity=[0, 0, 1]}}", "2 components", f"{MOTION}.velocity=[0, 1]"
    ),
    "no motion": Try(
        PLANE,
        f"{MOTION}={{kind='Translation', velocity=[]}}",
        "1, 2 or 3 finite components",
        f"{MOTION}.velocity=[0, 1]",
    ),
    "instants": Try(
        PLANE,
        f"{MOTION}={{kind='Table', times=[0, 0], displacements=[[0, 0], [0, -1]]}}",
        "increasing instants",
        f"{MOTION}.times=[0, 1]",
    ),
    "one displacement": Try(
        PLANE,
        f"{MOTION}={{kind='Table', times=[0, 1], displacements=[[0, 0]]}}",
        "one for each instant",
        f"{MOTION}.displacements=[[0, 0], [0, -1]]",
    ),
    "mixed displacements": Try(
        PLANE,
        f"{MOTION}={{kind='Table', times=[0, 1], displacements=[[0, 0], [0]]}}",
        "vectors of equal length",
        f"{MOTION}.displacements=[[0, 0], [0, -1]]",
    ),
    "turning in 1D": Try(
        BAR,
        f"{MOTION}={{kind='Turning', point=0, rate=1}}",
        "a point in 2D or 3D",
        f"{MOTION}.point=[0, 0]",
        "components",
    ),
    "turning about nothing": Try(
        SPACE, f"{MOTION}={{kind='Turning', point=[0, 0, 0], rate=1}}", "[0, 0, 1]", f"{MOTION}.axis=[0, 0, 1]"
    ),
    "axis in the plane": Try(
        PLANE, f"{MOTION}={{kind='Turning', point=[0, 0], axis=[0, 0, 1], rate=1}}", "none in 2D", f"{MOTION}.axis=[]"
    ),
    "sliding nowhere": Try(
        PLANE,
        f"{MOTION}={{kind='Sliding', direction=[0, 0], travel={{kind='Haversine', height=0.01, duration=1}}}}",
        "not all zero",
        f"{MOTION}.direction=[0, 1]",
    ),
    "spline through one point": Try(
        PLANE,
        f"{MOTION}={{kind='Sliding', direction=[0, 1], travel={{kind='Spline', times=[0], points=[0]}}}}",
        "two or more",
        f"{MOTION}.travel={{kind='Spline', times=[0, 1], points=[0, 0.01]}}",
    ),
    "spline back in time": Try(
        PLANE,
        f"{MOTION}={{kind='Sliding', direction=[0, 1], travel={{kind='Spline', times=[1, 0], points=[0, 1]}}}}",
        "increasing instants",
        f"{MOTION}.travel.times=[0, 1]",
    ),
    "velocities that begin late": Try(
        PLANE,
        f"{MOTION}={{kind='Sliding', direction=[0, 1], travel={{kind='RatePolyline', times=[1, 2], rates=[0, 1]}}}}",
        "the first 0",
        f"{MOTION}.travel.times=[0, 1]",
    ),
    "endless steps": Call(
        lambda _: SmoothSteps(times=(0.0, 1.0), points=(0.0, inf)),
        "finite numbers",
        lambda _: SmoothSteps(times=(0.0, 1.0), points=(0.0, 1.0)),
    ),
    "endless pulse": Call(
        lambda _: Haversine(height=inf, duration=1.0), "finite numbers", lambda _: Haversine(height=1.0, duration=1.0)
    ),
    "pulse of no time": Try(
        PLANE,
        f"{MOTION}={{kind='Swinging', point=[0, 0], angle={{kind='Haversine', height=0.01, duration=0}}}}",
        "a positive time",
        f"{MOTION}.angle.duration=1",
    ),
}
