"""G02: adiabatic compression, rate-independent and of Norton and Hoff: all work, or a share of it, heats.

A cylinder of one cell without friction at its ends, without inertia.  The steel is elastic: it is compressed by the
elastic strain on top.
"""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome, sheet
from softway.record.view.plots.curves import Curve, Panel

GIVEN = sheet("G02")["definition"]
START, SLABS, E, NU = 300.0, 10, 210e9, 0.3
INSULATING = 1e-9
"""Conductivity [W/(m K)] without effect: all nodes are heated alike."""


@cache
def pressed(name: str) -> tuple[sw.Step, ...]:
    """Compression of the ``plastic`` or ``viscous`` cylinder, of radius and height 1 m, at a constant true rate."""
    given, strain = GIVEN[name], GIVEN["strain"]
    material: sw.J2 | sw.laws.NortonHoff
    if name == "plastic":
        rate, strain = 1.0, strain + given["yield_stress"] / E
        material = sw.J2(E=E, nu=NU, yield_stress=given["yield_stress"])
    else:
        rate = given["rate"]
        material = sw.laws.NortonHoff(K=given["K"], m=given["m"])
    times = np.linspace(0.0, strain / rate, SLABS + 1)
    speed = tuple((-rate * np.exp(-rate * times)).tolist())
    push = sw.Driven(on="top", components="y", velocity=speed, times=tuple(times.tolist()))
    law = sw.heat.Conduction(conductivity=INSULATING, capacity=GIVEN["c"])
    body = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(1, 1)),
        material=material,
        density=GIVEN["rho"],
        section=sw.bodies.Axisymmetric(),
        supports=(sw.Fixed(on="left", components="x"), sw.Fixed(on="bottom", components="y"), push),
        dilatation="mean",
        thermal=sw.bodies.Thermal(law=law, temperature=START, heating=given["share"]),
    )
    scene = sw.Scene(bodies={"cylinder": body}, inertia=sw.bodies.Off())
    return tuple(sw.march(scene, until=float(times[-1]), step=float(times[1])))


def compute() -> Outcome:
    """Compute both cylinders."""
    rises, curves = {}, []
    for name in ("plastic", "viscous"):
        steps = pressed(name)
        strain = [-np.log1p(step.after.displacement["cylinder"][:, 1].min()) for step in steps]
        rise = [float(step.after.fields["temperature"]["cylinder"].mean()) - START for step in steps]
        rises[f"rise, {name}"] = rise[-1]
        curves.append(Curve(x=np.array([0.0, *strain]), y=np.array([0.0, *rise]), label=name))
    panel = Panel(title="Heating", x="logarithmic strain", y="rise [K]", curves=tuple(curves))
    return Outcome(values=rises, panels=(panel,))
