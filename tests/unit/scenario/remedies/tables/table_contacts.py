"""Refusals of contacts, tools and their motion."""

from try_it import BAR, PLANE, SPACE, TWO, Table, Try

PAIR = "contacts[0].between"
SHAPE, MOTION = "bodies.w.shape", "bodies.w.motion"
TABLE: Table = {
    "tool first": Try(PLANE, f"{PAIR}=['w', 'b.bottom']", '["b.bottom", "w"]', f"{PAIR}=['b.bottom', 'w']"),
    "tag of a tool": Try(PLANE, f"{PAIR}=['b.bottom', 'w.top']", '["b.bottom", "w"]', f"{PAIR}=['b.bottom', 'w']"),
    "unknown body": Try(PLANE, f"{PAIR}=['bb.bottom', 'w']", "'b'", f"{PAIR}=['b.bottom', 'w']"),
    "unknown opponent": Try(PLANE, f"{PAIR}=['b.bottom', 'ww']", "'w'", f"{PAIR}=['b.bottom', 'w']"),
    "two tools": Try(PLANE, f"{PAIR}=['w', 'w']", "known: b", f"{PAIR}=['b.bottom', 'w']"),
    "unknown tag": Try(PLANE, f"{PAIR}=['b.botom', 'w']", "bottom, or one of", f"{PAIR}=['b.bottom', 'w']"),
    "itself": Try(TWO, f"{PAIR}=['b.bottom', 'b.top']", "two bodies", f"{PAIR}=['b.bottom', 'c.top']"),
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
}
