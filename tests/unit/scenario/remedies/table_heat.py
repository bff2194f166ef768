"""Refusals of conductors, their laws and boundary conditions."""

from collections.abc import Callable
from dataclasses import replace
from math import inf

import numpy as np
from try_it import BAR as SOLIDS
from try_it import Call, Table, Try

import softway as sw
from softway.bodies.conductor import sample_temperature
from softway.meshes.generators.shapes import box, interval, rectangle
from softway.model.build import build as motion_alone

heat = sw.heat
LAW = heat.Conduction(conductivity=1.0, capacity=1.0)
MELTS = heat.Conduction(conductivity=1.0, capacity=1.0, latent=heat.Latent(heat=1.0, melting=300.0))
BAR = interval(1.0, cells=2)
REGIONS = BAR.with_region("a", lambda x: x[:, 0] < 0.5).with_region("c", lambda x: x[:, 0] > 0.5)
RISING = heat.TemperatureTable(temperatures=(200.0, 300.0), values=(1.0, 2.0))
SQUARE = rectangle((1.0, 1.0), (2, 2))
CORNER = SQUARE.with_tag("corner", lambda x: (x < 0.1).all(axis=1))
COLD = (2.0, 1.0)


def body(**given: object) -> sw.heat.Conductor:
    """A bar at 300 K."""
    return heat.Conductor(**{"mesh": BAR, "law": LAW, "density": 1.0, "temperature": 300.0, **given})  # type: ignore[arg-type]


def built(*loads: object, **given: object) -> object:
    """Model of a bar with loads."""
    return heat.build_heat(heat.HeatScene(bodies={"b": body(**given)}, loads=loads))  # type: ignore[arg-type]


def marched(**given: object) -> object:
    """March of a bar."""
    times = {"until": 1.0, "step": 0.5, **given}
    return heat.march_heat(heat.HeatScene(bodies={"b": body()}), **times)  # type: ignore[arg-type]


def call(wrong: Callable[[], object], remedy: str, right: Callable[[], object]) -> Call:
    """Call that is wrong, and one that is right."""
    return Call(lambda _: wrong(), remedy, lambda _: right())


def table(temperatures: tuple[float, ...], values: tuple[float, ...]) -> sw.heat.TemperatureTable:
    """Table of values."""
    return heat.TemperatureTable(temperatures=temperatures, values=values)


def profile(axis: str = "x", values: tuple[float, ...] = (300.0, 310.0)) -> sw.bodies.Profile:
    """Profile of temperatures."""
    return sw.bodies.Profile(axis=axis, at=(0.0, 1.0), values=values)


STATE = heat.HeatState(
    time=0.0,
    unknowns=np.full(4, 300.0),
    ledger=heat.HeatLedger(heat_content=0.0, heat_in=0.0, heat_out=0.0, error=0.0),
)
SCENE = """
[bodies.b]
kind = "Conductor"
mesh = { kind = "Interval", length = 1, cells = 2 }
law = { conductivity = 1, capacity = 1 }
density = 1
temperature = 300
[time]
end = 1
step = 0.5
"""
BODY = (
    "{kind='Conductor', mesh={kind='Interval', length=1, cells=2}, law={conductivity=1, capacity=1}, density=1, "
    "temperature=300}"
)
BOTH = f"bodies={{b={BODY}, w={{kind='Tool', shape={{kind='HalfSpace', point=2, normal=-1}}}}}}"
FLUX = "loads=[{kind='HeatFlux', on='b.left', value=1}]"
SOLID_PROBE = "output.probes=[{name='p', of='b', tag='left', quantity='temperature'}]"
PROBE = "output.probes=[{name='p', of='b', tag='left', quantity='temperature'}]"
TWO = f"bodies={{b={BODY}, c={BODY.replace('cells=2', 'cells=2, origin=1')}}}"
MEETS = "heat_contacts=[{between=['b.right', 'c.left'], conductance=1}]"


def touching(between: tuple[str, str] = ("a.right", "b.left")) -> object:
    """Model of two squares side by side that exchange heat."""
    beside = sw.Mesh(points=CORNER.points + [1.0, 0.0], blocks=CORNER.blocks, tags=CORNER.tags)
    bodies = {"a": body(mesh=SQUARE), "b": body(mesh=beside)}
    contact = heat.HeatContact(between=between, conductance=1.0)
    return heat.build_heat(heat.HeatScene(bodies=bodies, contacts=(contact,)))


STEEL = sw.LinearElastic(E=1.0, nu=0.25)
FIBRES = sw.laws.LinearOrthotropic(E=(2.0, 1.0, 1.0), nu=(0.2, 0.2, 0.2), G=(0.5, 0.5, 0.5))
HALVES = SQUARE.with_region("a", lambda x: x[:, 0] < 0.5).with_region("c", lambda x: x[:, 0] > 0.5)


def thermal(**given: object) -> sw.bodies.Thermal:
    """Heat of a solid that expands."""
    return sw.bodies.Thermal(**{"law": LAW, "temperature": 300.0, "expansion": 1e-5, **given})  # type: ignore[arg-type]


def solids(**given: object) -> object:
    """Model of a square with heat, and a flux on it."""
    parts = {"mesh": SQUARE, "material": STEEL, "density": 1.0, "thermal": thermal(), **given}
    load = heat.HeatFlux(on="b.left", value=1.0)
    return sw.build(sw.Scene(bodies={"b": sw.Solid(**parts)}, loads=(load,)))  # type: ignore[arg-type]


def freezing(mesh: sw.Mesh) -> object:
    """Model of a solid that melts, on a mesh."""
    part = sw.Solid(mesh=mesh, material=STEEL, density=1.0, thermal=thermal(law=MELTS, expansion=0.0))
    return sw.build(sw.Scene(bodies={"b": part}))


PLASTIC = sw.J2(E=1.0, nu=0.3, yield_stress=0.1)
FALLS = sw.J2(E=1.0, nu=0.3, yield_stress=0.1, hardening=sw.laws.LinearHardening(modulus=-0.6))
DAMPED = sw.laws.NortonHoff(K=1.0, m=0.2)
SOFTER = heat.StiffnessTable(temperatures=(300.0, 900.0), values=(1.0, 0.5))
FINE = rectangle((1.0, 1.0), (4, 4))
CONDUCTS = heat.ContactHeat(conductance=1.0)


def resting(given: object = CONDUCTS, thermals: tuple[bool, bool] = (True, True), **contact: object) -> object:
    """Model of two squares side by side, with or without a temperature, and a contact with heat."""
    beside = sw.Mesh(points=FINE.points + [1.0, 0.0], blocks=FINE.blocks, tags=FINE.tags)
    bodies = {
        name: sw.Solid(mesh=mesh, material=STEEL, density=1.0, thermal=thermal() if hot else None)
        for name, mesh, hot in zip("ab", (FINE, beside), thermals, strict=True)
    }
    meets = sw.Contact(**{"between": ("a.right", "b.left"), "heat": given, **contact})  # type: ignore[arg-type]
    return sw.build(sw.Scene(bodies=bodies, contacts=(meets,)))


def moving(heated: sw.bodies.Thermal | None) -> object:
    """Model of the motion of a square alone."""
    solid = sw.Solid(mesh=SQUARE, material=STEEL, density=1.0, thermal=heated)
    return motion_alone(sw.Scene(bodies={"b": solid}))


def halves(*laws: sw.heat.Conduction, cell: str = "quad4", **given: object) -> object:
    """Model of a conductor with two laws."""
    whole = rectangle((1.0, 1.0), (2, 2)) if cell == "quad4" else box((1.0,) * 3, (2, 1, 1), cell=cell)
    mesh = whole.with_region("a", lambda x: x[:, 0] < 0.5).with_region("c", lambda x: x[:, 0] > 0.5)
    return built(mesh=mesh, law=dict(zip("ac", laws, strict=False)), **given)


def melting(at: float = 300.0, half_range: float = 0.0) -> sw.heat.Conduction:
    """Law that melts."""
    latent = heat.Latent(heat=1.0, melting=at, half_range=half_range)
    return heat.Conduction(conductivity=1.0, capacity=1.0, latent=latent)


ALONE = "a scenario of conductors only"
TABLE: Table = {
    "a tool beside a conductor": Try(SCENE, BOTH, ALONE, f"bodies={{b={BODY}}}"),
    "a difference in degrees Celsius": Try(
        SCENE,
        "bodies.b.law.latent={heat=1, melting=300, half_range='1 degC'}",
        'a difference of temperatures such as "0.5 K"',
        "bodies.b.law.latent.half_range=0.5 K",
    ),
    "a temperature below absolute zero": Try(
        SCENE, "bodies.b.temperature=-300 degC", "a temperature above -273.15 degC", "bodies.b.temperature=-200 degC"
    ),
    "conduction of no material": Try(
        SCENE, "bodies.b.law=cooper OFHC", "did you mean 'copper OFHC'", "bodies.b.law=copper OFHC"
    ),
    "conduction of a number": Try(
        SCENE, "bodies.b.law={library=3}", '"steel S235"', "bodies.b.law={library='steel S235'}"
    ),
    "conduction that is not known": Try(
        SCENE,
        "bodies.b.law=nylon",
        "conductivity = ..., capacity = ...",
        "bodies.b.law={conductivity=0.25, capacity=1670}",
    ),
    "latent heat of a number": Try(
        SCENE, "bodies.b.law={library='copper', latent=3}", "true", "bodies.b.law={library='copper', latent=true}"
    ),
    "heat on a solid": Try(SOLIDS, FLUX, "a solid with the key thermal", "loads=[]"),
    "heat on a solid without": call(lambda: solids(thermal=None), "the heat of the solid, thermal", solids),
    "temperature of a solid without": Try(SOLIDS, SOLID_PROBE, "displacement", "output.probes=[]"),
    "heat across a contact with a cold body": call(
        lambda: resting(thermals=(True, False)), "bodies.b.thermal", resting
    ),
    "heat across a contact of cold bodies": call(
        lambda: resting(thermals=(False, False)), "a contact without heat", lambda: resting(None, (False, False))
    ),
    "heat of an impulse": call(lambda: resting(timing=sw.contact.Impulse()), "the timing Energy", resting),
    "temperature of no tool": call(
        lambda: resting(heat.ContactHeat(tool_temperature=300.0)), "a contact with a tool", resting
    ),
    "a share without a first body": call(
        lambda: resting(heat.ContactHeat(share=0.3), between="all"),
        "no share, or contacts of two bodies",
        lambda: resting(heat.ContactHeat(share=0.3)),
    ),
    "a negative conductance": call(
        lambda: heat.ContactHeat(conductance=-1.0), "zero or a positive number", lambda: heat.ContactHeat()
    ),
    "more than the whole heat": call(
        lambda: heat.ContactHeat(share=2.0), "a number from 0 to 1", lambda: heat.ContactHeat(share=0.2)
    ),
    "a gas between smooth surfaces": call(
        lambda: heat.ContactHeat(gas=0.03),
        "the depth of the roughness",
        lambda: heat.ContactHeat(gas=0.03, roughness=1e-6),
    ),
    "expansion of fibres": call(lambda: solids(material=FIBRES), "an isotropic law", solids),
    "moduli of a law that knows no factor": call(
        lambda: solids(material=DAMPED, thermal=thermal(stiffness=SOFTER)),
        "J2, Maxwell, Kelvin, Hypoelastic",
        lambda: solids(material=PLASTIC, thermal=thermal(stiffness=SOFTER)),
    ),
    "a yield stress that falls faster than soft moduli allow": call(
        lambda: solids(material=FALLS, thermal=thermal(stiffness=SOFTER)),
        "a slope above -3 mu",
        lambda: solids(material=PLASTIC, thermal=thermal(stiffness=SOFTER)),
    ),
    "a share above one": call(lambda: thermal(heating=2.0), "a share from 0 to 1", thermal),
    "a melting strain of what does not melt": call(
        lambda: thermal(melting_strain=0.02), "law.latent", lambda: thermal(law=MELTS, melting_strain=0.02)
    ),
    "a sharp front in hex20": call(
        lambda: freezing(box((1.0,) * 3, (1, 1, 1), cell="hex20")),
        "hex27",
        lambda: freezing(box((1.0,) * 3, (1, 1, 1), cell="hex27")),
    ),
    "a force on a conductor": Try(SCENE, "loads=[{kind='Gravity', acceleration=-1}]", ALONE, FLUX),
    "a contact of solids": Try(SOLIDS, MEETS, ALONE, "heat_contacts=[]"),
    "a contact apart": Try(SCENE, f"{TWO} & {MEETS.replace('left', 'right')}", "surfaces that touch", MEETS),
    "a contact with itself": call(
        lambda: heat.HeatContact(between=("b.left", "b.right"), conductance=1.0),
        "two surfaces",
        lambda: heat.HeatContact(between=("b.left", "c.right"), conductance=1.0),
    ),
    "a contact with nobody": call(lambda: touching(("a.left", "c.right")), "'a', 'b'", lambda: touching()),
    "a contact of surfaces apart": call(
        lambda: touching(("a.left", "b.right")), "surfaces that touch", lambda: touching()
    ),
    "a contact on a corner": call(
        lambda: touching(("a.right", "b.corner")), "a tag of a side", lambda: touching(("a.right", "b.left"))
    ),
    "a probe of nobody": Try(SCENE, PROBE.replace("of='b'", "of='c'"), "one of ['b']", PROBE),
    "a velocity of a conductor": Try(SCENE, PROBE.replace("temperature", "velocity"), "temperature", PROBE),
    "values of a table": call(lambda: table(COLD, (1.0,)), "one value for each", lambda: table((1.0,), (1.0,))),
    "falling temperatures": call(lambda: table(COLD, (1.0, 1.0)), "in kelvin", lambda: table((1.0, 2.0), (1.0, 1.0))),
    "zero of a table": call(lambda: table((1.0,), (0.0,)), "positive values", lambda: table((1.0,), (1.0,))),
    "mushy down to zero": call(
        lambda: heat.Latent(heat=1.0, melting=300.0, half_range=400.0),
        "less than the temperature of melting",
        lambda: heat.Latent(heat=1.0, melting=300.0, half_range=1.0),
    ),
    "a liquid that melts": call(
        lambda: heat.Latent(heat=1.0, melting=300.0, liquid=MELTS),
        "omit it",
        lambda: heat.Latent(heat=1.0, melting=300.0, liquid=LAW),
    ),
    "four axes": call(
        lambda: heat.Conduction(conductivity=(1.0,) * 4, capacity=1.0),
        "each axis of space",
        lambda: heat.Conduction(conductivity=(1.0,) * 3, capacity=1.0),
    ),
    "no capacity": call(
        lambda: heat.Conduction(conductivity=1.0, capacity=0.0),
        "a positive number",
        lambda: heat.Conduction(conductivity=1.0, capacity=1.0),
    ),
    "a bar along two axes": call(
        lambda: built(law=heat.Conduction(conductivity=(1.0, 2.0), capacity=1.0)),
        "one number in bars",
        lambda: built(law=heat.Conduction(conductivity=(1.0, 2.0), capacity=1.0), mesh=SQUARE),
    ),
    "elsewhere": call(lambda: body(latent="edge"), "'cell', 'node' or, in bars, 'front'", lambda: body(latent="node")),
    "temperatures of two nodes": call(
        lambda: sample_temperature(np.full(2, 300.0), BAR),
        "shape (3,)",
        lambda: sample_temperature(np.full(3, 300.0), BAR),
    ),
    "degrees below zero": call(
        lambda: built(temperature=-10.0), "273.15 K above those in Celsius", lambda: built(temperature=263.15)
    ),
    "a profile along y": call(
        lambda: built(temperature=profile("y")), "an axis of the mesh", lambda: built(temperature=profile())
    ),
    "whiter than black": call(
        lambda: heat.Radiation(on="b", emissivity=2.0, ambient=300.0),
        "1 for a black surface",
        lambda: heat.Radiation(on="b", emissivity=1.0, ambient=300.0),
    ),
    "a cold wall": call(
        lambda: heat.Temperature(on="b", value=-10.0),
        "in kelvin",
        lambda: heat.Temperature(on="b", value=263.15),
    ),
    "two temperatures of an end": call(
        lambda: built(heat.Temperature(on="b.left", value=300.0), heat.Temperature(on="b.left", value=310.0)),
        "one temperature for each surface",
        lambda: built(heat.Temperature(on="b.left", value=310.0)),
    ),
    "endless flux": call(
        lambda: heat.HeatFlux(on="b", value=inf), "a finite number", lambda: heat.HeatFlux(on="b", value=1.0)
    ),
    "flux on a corner": call(
        lambda: built(heat.HeatFlux(on="b.corner", value=1.0), mesh=CORNER),
        "a tag of a side",
        lambda: built(heat.HeatFlux(on="b.left", value=1.0), mesh=CORNER),
    ),
    "flux on nobody": call(
        lambda: built(heat.HeatFlux(on="c", value=1.0)), "'b'", lambda: built(heat.HeatFlux(on="b", value=1.0))
    ),
    "no conductor": call(lambda: heat.build_heat(heat.HeatScene(bodies={})), "at least one Conductor", built),
    "latent heat of hex20": call(
        lambda: built(law=MELTS, mesh=box((1.0,) * 3, (1, 1, 1), cell="hex20")),
        "'node', or hex27",
        lambda: built(law=MELTS, mesh=box((1.0,) * 3, (1, 1, 1), cell="hex20"), latent="node"),
    ),
    "heat in a model of the motion": call(lambda: moving(thermal()), "a scene without heat", lambda: moving(None)),
    "no law of conduction": call(lambda: halves(), "a law for each region", lambda: halves(LAW, LAW)),
    "half a law of conduction": call(lambda: halves(LAW), "a law for c", lambda: halves(LAW, LAW)),
    "no density of a region": call(
        lambda: halves(LAW, LAW, density={"a": 1.0, "c": 0.0}),
        "a positive number",
        lambda: halves(LAW, LAW, density={"a": 1.0, "c": 1.0}),
    ),
    "half a density": call(
        lambda: halves(LAW, LAW, density={"a": 1.0}),
        "a density for c",
        lambda: halves(LAW, LAW, density={"a": 1.0, "c": 1.0}),
    ),
    "mush beside others": call(lambda: halves(LAW, melting(half_range=1.0)), "zero", lambda: halves(LAW, melting())),
    "melting at two temperatures": call(
        lambda: halves(melting(), melting(310.0)), "one temperature", lambda: halves(melting(), melting())
    ),
    "front in quadratic bars": call(
        lambda: built(law=MELTS, mesh=interval(1.0, cells=2, cell="bar3"), latent="front"),
        "'cell'",
        lambda: built(law=MELTS, mesh=interval(1.0, cells=2), latent="front"),
    ),
    "front in several materials": call(
        lambda: built(law={"a": LAW, "c": MELTS}, mesh=REGIONS, latent="front"),
        "'cell'",
        lambda: built(law={"a": LAW, "c": MELTS}, mesh=REGIONS, latent="cell"),
    ),
    "front in a mushy range": call(
        lambda: built(law=melting(300.0, 1.0), mesh=interval(1.0, cells=2), latent="front"),
        "'node'",
        lambda: built(law=melting(300.0, 1.0), mesh=interval(1.0, cells=2), latent="node"),
    ),
    "front beside a table": call(
        lambda: built(law=replace(MELTS, conductivity=RISING), mesh=interval(1.0, cells=2), latent="front"),
        "'cell'",
        lambda: built(law=replace(MELTS, conductivity=RISING), mesh=interval(1.0, cells=2), latent="cell"),
    ),
    "latent heat of shared nodes": call(
        lambda: halves(LAW, MELTS, latent="node"), "'cell'", lambda: halves(LAW, MELTS, latent="cell")
    ),
    "latent heat of shared hex20": call(
        lambda: halves(LAW, MELTS, cell="hex20"), "hex27", lambda: halves(LAW, MELTS, cell="hex27")
    ),
    "a state of another scene": call(lambda: marched(state=STATE), "a state of the same scene", marched),
    "until the start": call(lambda: marched(until=0.0), "a later time", marched),
    "no step": call(lambda: marched(step=0.0), "a positive time", marched),
}
