"""Refusals of bodies: sections, supports, initial fields, loads, forces."""

from try_it import BAR, PLANE, SPACE, TWO, UNITS, Call, Table, Try

from softway.bodies import Placement, Rotation, placed_together
from softway.scenario.checks.check import check
from softway.scenario.files import loads

B = "bodies.b"
ONE = f"{B}.mesh.cells=[1, 1] & {B}.mesh.cell=quad8"
FALL = "start={kind='StaticStart', loads=[{kind='Gravity', acceleration=[0, -1]}]}"
TABLE: Table = {
    "overridden support": Try(
        PLANE,
        f"{B}.supports=[{{on='top'}}, {{kind='Driven', on='top', velocity=1}}]",
        "one support for each",
        f"{B}.supports=[{{on='top'}}]",
    ),
    "direction and components": Try(
        PLANE,
        f"{B}.supports=[{{on='top', components='x', direction=[1, 1]}}]",
        "one of the two",
        f"{B}.supports=[{{on='top', direction=[1, 1]}}]",
    ),
    "no direction": Try(
        PLANE,
        f"{B}.supports=[{{on='top', direction=[0, 0]}}]",
        "not all zero",
        f"{B}.supports=[{{on='top', direction=[0, 1]}}]",
    ),
    "direction in space": Try(
        PLANE,
        f"{B}.supports=[{{on='top', direction=[0, 0, 1]}}]",
        "2 components",
        f"{B}.supports=[{{on='top', direction=[0, 1]}}]",
    ),
    "normal of a bar": Try(
        BAR, f"{B}.supports=[{{on='left', direction='normal'}}]", 'components = "x"', f"{B}.supports=[{{on='left'}}]"
    ),
    "two motions along one direction": Try(
        PLANE,
        f"{B}.supports=[{{on='top', direction=[1, 1]}}, {{kind='Driven', on='top', direction=[2, 2], velocity=0}}]",
        "a direction of its own",
        f"{B}.supports=[{{on='top', direction=[1, 1]}}, {{kind='Driven', on='top', direction=[1, -1], velocity=0}}]",
    ),
    "displacement along a direction": Try(
        PLANE,
        f"{B}.supports=[{{on='left', direction=[1, 1]}}] & {B}.displacement={{kind='Uniform', value=[0, 0.01]}}",
        'kind = "Driven"',
        f"{B}.supports=[{{kind='Driven', on='left', direction=[1, 1], velocity=0}}]",
    ),
    "normal of no side": Try(
        PLANE,
        f"{B}.supports=[{{on='all', direction='normal'}}]",
        "a tag of a side",
        f"{B}.supports=[{{on='top', direction='normal'}}]",
    ),
    "direction with Impulse": Try(
        PLANE,
        f"{B}.supports=[{{on='top', direction=[1, 1]}}] & contacts[0].timing=Impulse",
        "the rule Energy",
        "contacts[0].timing=Energy",
    ),
    "mirror without normal": Try(
        PLANE, f"{B}.place.mirror={{normal=[0, 0]}}", "not all zero", f"{B}.place.mirror={{normal=[1, 0]}}"
    ),
    "mirror in space": Try(
        PLANE, f"{B}.place.mirror={{normal=[0, 0, 1]}}", "2 components", f"{B}.place.mirror={{normal=[1, 0]}}"
    ),
    "place about a point in space": Try(
        PLANE, f"{B}.place.about=[0, 0, 1]", "2 components, or none", f"{B}.place.about=[0, 1]"
    ),
    "group in space": Try(
        PLANE, f"{B}.group=[{{about=[0, 0, 1]}}]", "2 components, or none", f"{B}.group=[{{about=[0, 1]}}]"
    ),
    "group on the floor": Call(
        lambda _: placed_together({}, Placement(bottom=0.0)),
        "a translation",
        lambda _: placed_together({}, Placement(translation=(0.0, 1.0))),
    ),
    "group about nothing": Call(
        lambda _: placed_together({}, Placement(rotations=(Rotation(angle=1.0),))),
        "a point",
        lambda _: placed_together({}, Placement(rotations=(Rotation(angle=1.0),), about=(0.0, 0.0))),
    ),
    "force of Explicit": Try(
        PLANE, f"solver=Explicit & {B}.force=EnergyMomentum", "the default force", f"{B}.force=Weighted"
    ),
    "name of a body": Call(
        lambda _: check(loads(PLANE.replace("bodies.w", 'bodies."w.x"'), units=UNITS)),
        "a dot stands between",
        lambda _: check(loads(PLANE, units=UNITS)),
    ),
    "no solid": Try(
        "bodies = {}\n[time]\nend = 1",
        "",
        "at least one body of kind",
        "bodies={b={kind='Solid', mesh={kind='Interval', length=1, cells=2}, density=1, "
        "material={kind='LinearElastic', E=1}}}",
    ),
    "two dimensions": Try(
        TWO,
        "bodies.c.mesh={kind='Box', size=[1, 1, 1], cells=[2, 2, 2]}",
        "the same space",
        "bodies.c.mesh={kind='Rectangle', size=[1, 1], cells=[2, 2], origin=[0, -1]}",
    ),
    "no density": Try(PLANE, f"{B}.density=0", "7850 kg/m^3", f"{B}.density=7850 kg/m^3"),
    "no stiffness": Try(
        BAR, f"{B}.material={{E=1e-300}} & {B}.material.kind=LinearElastic", "larger moduli", f"{B}.material.E=1"
    ),
    "signs in a name": Call(
        lambda _: loads(PLANE.replace("bodies.w", 'bodies."w\\n"'), units=UNITS),
        "letters and digits",
        lambda _: loads(PLANE, units=UNITS),
    ),
    "tiny density": Try(PLANE, f"{B}.density=1e-300", "1000 kg/m^3", f"{B}.density=1000 kg/m^3"),
    "section": Try(PLANE, f"{B}.section=Volume", "PlaneStrain", f"{B}.section=PlaneStrain"),
    "negative radius": Try(
        PLANE, f"{B}.section=Axisymmetric & {B}.mesh.origin=[-1, 0.01]", "x >= 0", f"{B}.mesh.origin=[0, 0.01]"
    ),
    "mean in plane stress": Try(
        PLANE, f"{B}.section=PlaneStress & {B}.dilatation=mean", "'point'", f"{B}.dilatation=point"
    ),
    "mean of quadratic cells": Try(
        PLANE, f"{B}.mesh.cell=quad9 & {B}.dilatation=mean", "'corner'", f"{B}.dilatation=corner"
    ),
    "incompressible": Try(
        PLANE, f"{B}.material={{kind='NeoHookean', E=1, nu=0.5}}", 'dilatation = "mean"', f"{B}.dilatation=mean"
    ),
    "incompressible, quadratic": Try(
        PLANE,
        f"{B}.material={{kind='NeoHookean', E=1, nu=0.5}}",
        '"corner" with quadratic cells',
        f"{B}.dilatation=corner & {B}.mesh.cell=quad9",
    ),
    "discrete gradient of means": Try(
        PLANE, f"{B}.force=DiscreteGradient & {B}.dilatation=mean", 'dilatation = "point"', f"{B}.dilatation=point"
    ),
    "discrete gradient of means, weighted": Try(
        PLANE, f"{B}.force=DiscreteGradient & {B}.dilatation=mean", "Weighted", f"{B}.force=Weighted"
    ),
    "force of a rate law": Try(
        PLANE,
        f"{B}.force=DiscreteGradient & {B}.material={{kind='Hypoelastic', E=1, nu=0.3}}",
        "Weighted",
        f"{B}.force=Weighted",
    ),
    "force of a rate law, other": Try(
        PLANE,
        f"{B}.force=DiscreteGradient & {B}.material={{kind='Hypoelastic', E=1, nu=0.3}}",
        "EnergyMomentum",
        f"{B}.force=EnergyMomentum",
    ),
    "spin of revolution": Try(
        PLANE, f"{B}.force=EnergyMomentum & {B}.section=Axisymmetric", "Weighted", f"{B}.force=Weighted"
    ),
    "Gauss points": Try(PLANE, f"{B}.force={{kind='AverageField', points=0}}", "1 or more", f"{B}.force.points=1"),
    "shock": Try(PLANE, f"{B}.shock={{linear=-1}}", "zero or more", f"{B}.shock.linear=0"),
    "factor": Try(PLANE, "inertia={kind='Scaled', factor=0}", "a positive number", "inertia.factor=2"),
    "factor, off": Try(
        PLANE, "inertia={kind='Scaled', factor=0}", 'inertia = "Off"', "inertia=Off", "sufficient supports"
    ),
    "inertia off with Impulse": Try(
        PLANE,
        f"inertia=Off & contacts[0].timing=Impulse & {B}.supports=[{{on='left'}}]",
        "the timing Energy",
        "contacts[0].timing=Energy",
    ),
    "no layers": Try(
        PLANE,
        f"{ONE} & contacts[0].between=['b', 'w'] & {B}.supports=[{{on='left'}}]",
        "two layers",
        f"{B}.mesh.cells=[2, 2]",
    ),
    "no layers, quadratic": Try(
        PLANE,
        f"{ONE} & contacts[0].between=['b', 'w'] & {B}.supports=[{{on='left'}}]",
        "quadratic",
        f"{B}.mesh.cell=quad9",
    ),
    "no layers, tag": Try(
        PLANE,
        f"{ONE} & contacts[0].between=['b', 'w'] & {B}.supports=[{{on='left'}}]",
        "tag",
        "contacts[0].between=['b.bottom', 'w']",
    ),
    "no inertia left": Try(
        SPACE, f"{B}.mesh.cells=[2, 2, 2] & contacts[0].between=['b', 'w']", "a finer mesh", f"{B}.mesh.cells=[3, 3, 3]"
    ),
    "no inertia left, tag": Try(
        SPACE,
        f"{B}.mesh.cells=[2, 2, 2] & contacts[0].between=['b', 'w']",
        "a smaller tag",
        "contacts[0].between=['b.bottom', 'w']",
    ),
    "axes": Try(
        PLANE, f"{B}.supports=[{{on='left', components='z'}}]", "letters of 'xy'", f"{B}.supports[0].components=y"
    ),
    "axes, all": Try(
        PLANE, f"{B}.supports=[{{on='left', components='z'}}]", "'all'", f"{B}.supports[0].components=all"
    ),
    "support of nothing": Try(PLANE, f"{B}.supports=[{{on='lft'}}]", "left", f"{B}.supports[0].on=left"),
    "driven values": Try(
        PLANE,
        f"{B}.supports=[{{on='left', velocity=[1, 2]}}]",
        "one for each of the times",
        f"{B}.supports[0].times=[0, 1]",
    ),
    "driven instants": Try(
        PLANE,
        f"{B}.supports=[{{on='left', velocity=[1, 2], times=[1, 1]}}]",
        "increasing instants",
        f"{B}.supports[0].times=[0, 1]",
    ),
    "held displacement": Try(
        PLANE,
        f"{B}.supports=[{{on='left'}}] & {B}.displacement={{kind='Uniform', value=[0, 0.1]}}",
        "zero on 'left'",
        f"{B}.displacement={{kind='Profile', at=[0, 1], values=[0, 0.1]}}",
    ),
    "held displacement, driven": Try(
        PLANE,
        f"{B}.supports=[{{on='left'}}] & {B}.displacement={{kind='Uniform', value=[0, 0.1]}}",
        'kind = "Driven"',
        f"{B}.supports=[{{kind='Driven', on='left', velocity=0}}]",
    ),
    "velocity of one number": Try(
        PLANE, f"{B}.velocity={{kind='Uniform', value=1}}", "2 components", f"{B}.velocity.value=[1, 0]"
    ),
    "velocity of three": Try(PLANE, f"{B}.velocity=[1, 0, 0]", "2 components", f"{B}.velocity=[1, 0]"),
    "gradient of unequal rows": Try(
        PLANE,
        f"{B}.velocity={{kind='Affine', gradient=[[1, 0], [1]]}}",
        "2 rows of 2",
        f"{B}.velocity.gradient=[[1, 0], [1, 0]]",
    ),
    "gradient of one row": Try(
        PLANE,
        f"{B}.velocity={{kind='Affine', gradient=[[1, 0]]}}",
        "2 rows of 2",
        f"{B}.velocity.gradient=[[1, 0], [1, 0]]",
    ),
    "axis of a profile": Try(
        PLANE, f"{B}.velocity={{kind='Profile', axis='z', at=[0, 1], values=[0, 1]}}", "x, y", f"{B}.velocity.axis=y"
    ),
    "knots of a profile": Try(
        PLANE,
        f"{B}.velocity={{kind='Profile', at=[1, 0], values=[0, 1]}}",
        "increasing coordinates",
        f"{B}.velocity.at=[0, 1]",
    ),
    "tag of a field": Try(
        PLANE, f"{B}.velocity={{kind='OnTag', tag='botom', value=[0, 1]}}", "bottom", f"{B}.velocity.tag=bottom"
    ),
    "load on nobody": Try(
        PLANE, "loads=[{kind='Traction', on='c.top', value=[0, 1]}]", "known: b", "loads[0].on=b.top"
    ),
    "load on a tool": Try(
        PLANE, "loads=[{kind='Traction', on='w.top', value=[0, 1]}]", "known: b", "loads[0].on=b.top"
    ),
    "load without components": Try(
        PLANE, "loads=[{kind='Traction', on='b.top', value=[1]}]", "2 components", "loads[0].value=[0, 1]"
    ),
    "load on a corner": Try(
        PLANE,
        f"{B}.mesh={{kind='MeshFile', path='tagged.inp'}} & {B}.place.bottom=0.01 & "
        "loads=[{kind='Traction', on='b.corner', value=[0, 1]}]",
        "a tag that covers a surface",
        "loads[0].on=b.bottom",
    ),
    "gravity": Try(
        PLANE, "loads=[{kind='Gravity', acceleration=[0, 0, -1]}]", "2 components", "loads[0].acceleration=[0, -1]"
    ),
    "ramp": Try(
        PLANE,
        "loads=[{kind='Gravity', acceleration=[0, -1], ramp={times=[0, 1], factors=[0]}}]",
        "one for each time",
        "loads[0].ramp.factors=[0, 1]",
    ),
    "ramp instants": Try(
        PLANE,
        "loads=[{kind='Gravity', acceleration=[0, -1], ramp={times=[1, 0], factors=[0, 1]}}]",
        "increasing instants",
        "loads[0].ramp.times=[0, 1]",
    ),
    "endless ramp": Try(
        PLANE,
        "loads=[{kind='Gravity', acceleration=[0, -1], ramp={times=[0, inf], factors=[0, 1]}}]",
        "",
        "loads[0].ramp.times=[0, 1]",
    ),
    "axis of a rotation": Try(
        SPACE,
        f"{B}.place.rotations=[{{axis=[0, 0, 0], angle=1}}]",
        "[0, 0, 1]",
        f"{B}.place.rotations[0].axis=[0, 0, 1]",
    ),
    "rotation out of the plane": Try(
        PLANE,
        f"{B}.place.rotations=[{{axis=[1, 0, 0], angle=1}}] & {B}.place.bottom=0.01",
        "[0, 0, 1] in 2D",
        f"{B}.place.rotations[0].axis=[0, 0, 1]",
    ),
    "rotation in 1D": Try(
        BAR, f"{B}.place.rotations=[{{axis=[0, 0, 1], angle=1}}]", "no rotation in 1D", f"{B}.place.rotations=[]"
    ),
    "shift": Try(PLANE, f"{B}.place.translation=[1]", "2 components", f"{B}.place.translation=[1, 0]"),
    "shift, none": Try(PLANE, f"{B}.place.translation=[1]", "or none", f"{B}.place.translation=[]"),
    "free at a static start": Try(PLANE, f"contacts=[] & {FALL}", 'on = "left"', f"{B}.supports=[{{on='left'}}]"),
    "free at a static start, contact": Try(
        PLANE,
        f"contacts=[] & {FALL}",
        "a contact",
        f"{B}.supports=[{{on='left', components='x'}}] & contacts=[{{between=['b.bottom', 'w']}}]",
    ),
    "free at a static start, as given": Try(PLANE, f"contacts=[] & {FALL}", '"AsGiven"', "start=AsGiven"),
    "free without inertia": Try(PLANE, "inertia=Off", 'on = "left"', f"{B}.supports=[{{on='left'}}]"),
    "free without inertia, full": Try(PLANE, "inertia=Off", '"Full"', "inertia={kind='Full'}"),
}
