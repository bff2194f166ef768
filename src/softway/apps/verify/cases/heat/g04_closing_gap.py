"""G04: a bar that is heated at one end expands until it closes a gap; the instant lies inside a slab."""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome, sheet
from softway.arrays import Array
from softway.record.view.plots.curves import Curve, Panel

GIVEN = sheet("G04")["definition"]
CELLS, START, WEAK = 50, 300.0, 1.0
"""Number of cells, temperature at the start [K], and Young's modulus [Pa]: so little that strain takes no heat."""
TERMS = 200
"""Number of terms of the series."""
LONG, STRIDE = 6e5, 1e4
"""Time until the bar has one temperature, and its slabs [s]."""


def mean_rise(time: Array) -> Array:
    """Mean rise (...,) of the temperature of the bar at times (...) [s], by Fourier's series [K]."""
    odd = (np.arange(TERMS) + 0.5) * np.pi
    decay = np.exp(-np.multiply.outer(time, odd**2) * GIVEN["diffusivity"] / GIVEN["length"] ** 2)
    return np.asarray(GIVEN["rise"] * (1.0 - 2.0 * (decay / odd**2).sum(axis=-1)))


@cache
def heated(until: float, step: float) -> tuple[sw.Step, ...]:
    """Steps of the bar, of one square metre, with an expansion so small that the gap is a thousandth of a cell."""
    length = GIVEN["length"]
    law = sw.heat.Conduction(conductivity=GIVEN["diffusivity"], capacity=1.0)
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=length, cells=CELLS),
        material=sw.LinearElastic(E=WEAK, nu=0.0),
        density=1.0,
        supports=(sw.Fixed(on="left"),),
        thermal=sw.bodies.Thermal(law=law, temperature=START, expansion=GIVEN["expansion"]),
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=length + GIVEN["gap"], normal=-1.0))
    scene = sw.Scene(
        bodies={"bar": bar, "wall": wall},
        contacts=(sw.Contact(between=("bar.right", "wall")),),
        loads=(sw.heat.Temperature(on="bar.left", value=START + GIVEN["rise"]),),
        inertia=sw.bodies.Off(),
    )
    return tuple(sw.march(scene, until=until, step=step))


def touched(step: float) -> float:
    """Instant of the touch with slabs of this length [s]."""
    return next(e.time for s in heated(560.0, step) for e in s.events if e.kind == "touch")


def compute() -> Outcome:
    """Compute the instant of contact with short and long slabs, and the stress at the end."""
    values = {f"contact, slabs of {step:g} s": touched(step) for step in (5.0, 20.0)}
    last = heated(LONG, STRIDE)[-1]
    values["stress over E at the end"] = -last.ledger.contacts["bar.right-wall"].force_n / WEAK
    steps = heated(560.0, 20.0)
    time = np.array([step.after.time for step in steps])
    tip = np.array([step.after.displacement["bar"][-1, 0] for step in steps])
    exact = np.minimum(GIVEN["expansion"] * GIVEN["length"] * mean_rise(time), GIVEN["gap"])
    curves = (Curve(x=time, y=tip, label="softway"), Curve(x=time, y=exact, label="series"))
    panel = Panel(title="Displacement of the free end", x="time [s]", y="displacement [m]", curves=curves)
    return Outcome(values=values, panels=(panel,))
