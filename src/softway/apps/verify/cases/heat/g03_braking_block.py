"""G03: surface temperature of a half space under the heat of a braking block, by Duhamel's integral."""

from functools import cache
from math import pi

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome, sheet
from softway.arrays import Array
from softway.meshes.generators.graded import geometric
from softway.record.view.plots.curves import Curve, Panel

GIVEN = sheet("G03")["definition"]
START = 300.0
STEP = 0.02


@cache
def braked() -> tuple[sw.heat.HeatStep, ...]:
    """March until the block stands, cells of 0.2 mm at the surface."""
    x = np.array([*np.linspace(0.0, 6e-3, 31), *geometric(6e-3, 0.1, 40, 30.0)[1:]])
    cells = np.column_stack([np.arange(len(x) - 1), np.arange(1, len(x))])
    mesh = sw.Mesh(points=x[:, None], blocks={"bar2": cells}).with_tag("surface", lambda p: p[:, 0] == 0.0)
    law = sw.heat.Conduction(conductivity=GIVEN["k"], capacity=GIVEN["c"])
    body = sw.heat.Conductor(mesh=mesh, law=law, density=GIVEN["rho"], temperature=START)
    falls = sw.bodies.Ramp(times=(0.0, GIVEN["ts"]), factors=(1.0, 0.0))
    flux = sw.heat.HeatFlux(on="disc.surface", value=GIVEN["q0"], ramp=falls)
    scene = sw.heat.HeatScene(bodies={"disc": body}, loads=(flux,))
    return tuple(sw.heat.march_heat(scene, until=GIVEN["ts"], step=STEP))


def rise(time: Array) -> Array:
    """Rise of the surface [K] at times [s]: 2 q0 / e sqrt(t/pi) (1 - 2 t / (3 ts)), with the effusivity e."""
    effusivity = np.sqrt(GIVEN["k"] * GIVEN["rho"] * GIVEN["c"])
    return np.asarray(2.0 * GIVEN["q0"] / effusivity * np.sqrt(time / pi) * (1.0 - 2.0 * time / (3.0 * GIVEN["ts"])))


def compute() -> Outcome:
    """Compute the surface, and the heat against half of q0 ts, the kinetic energy per area of the block."""
    steps = braked()
    times = np.array([step.time for step in steps])
    surface = np.array([step.temperature["disc"][0] - START for step in steps])
    found = {
        "greatest rise of the surface": float(surface.max()),
        "rise of the surface at 2 s": float(surface[-1]),
        "heat, over the kinetic energy lost": steps[-1].ledger.heat_in / (0.5 * GIVEN["q0"] * GIVEN["ts"]),
    }
    curves = (
        Curve(x=times, y=surface, label="softway"),
        Curve(x=times, y=rise(times), kind="exact", label="Duhamel"),
    )
    return Outcome(values=found, panels=(Panel(title="Surface", x="t [s]", y="rise [K]", curves=curves),))
