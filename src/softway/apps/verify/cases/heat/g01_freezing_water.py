"""G01: water freezes from its surface: front and temperatures of Neumann's solution, latent heat in cut cells."""

from functools import cache

import numpy as np
from scipy.special import erf, erfc

import softway as sw
from softway.apps.verify.case import Outcome, sheet
from softway.arrays import Array
from softway.meshes.generators.graded import geometric
from softway.record.view.plots.curves import Curve, Panel

GIVEN = sheet("G01")["definition"]
ROOT = float(sheet("G01")["reference"]["root"])
ZERO, HOUR = 273.15, 3600.0
ICE, WATER = (GIVEN[f"k{phase}"] / (GIVEN["rho"] * GIVEN[f"c{phase}"]) for phase in "sl")
"""Diffusivities [m^2/s]."""


def places() -> Array:
    """Nodes [m]: cells of 1 mm in the first 10 cm, growing ones to 1 m."""
    return np.array([*np.linspace(0.0, 0.1, 101), *geometric(0.1, 1.0, 40, 50.0)[1:]])


@cache
def frozen() -> tuple[sw.heat.HeatStep, ...]:
    """March an hour in slabs of 10 s."""
    x = places()
    cells = np.column_stack([np.arange(len(x) - 1), np.arange(1, len(x))])
    mesh = sw.Mesh(points=x[:, None], blocks={"bar2": cells}).with_tag("surface", lambda p: p[:, 0] == 0.0)
    water = sw.heat.Conduction(conductivity=GIVEN["kl"], capacity=GIVEN["cl"])
    melts = sw.heat.Latent(heat=GIVEN["L"], melting=ZERO + GIVEN["Tm"], liquid=water)
    law = sw.heat.Conduction(conductivity=GIVEN["ks"], capacity=GIVEN["cs"], latent=melts)
    body = sw.heat.Conductor(mesh=mesh, law=law, density=GIVEN["rho"], temperature=ZERO + GIVEN["Ti"])
    cold = sw.heat.Temperature(on="water.surface", value=ZERO + GIVEN["Tw"])
    return tuple(sw.heat.march_heat(sw.heat.HeatScene(bodies={"water": body}, loads=(cold,)), until=HOUR, step=10.0))


def front(time: Array | float) -> Array:
    """Depth of the front [m] at times [s]."""
    return np.asarray(2.0 * ROOT * np.sqrt(ICE * np.asarray(time)))


def temperature(x: Array, time: float) -> Array:
    """Temperature [degrees Celsius] at depths x [m] and a time [s]."""
    wall, melting, start = (GIVEN[name] for name in ("Tw", "Tm", "Ti"))
    solid = wall + (melting - wall) * erf(x / (2.0 * np.sqrt(ICE * time))) / erf(ROOT)
    far = erfc(x / (2.0 * np.sqrt(WATER * time))) / erfc(ROOT * np.sqrt(ICE / WATER))
    return np.where(x < front(time), solid, start + (melting - start) * far)


def compute() -> Outcome:
    """Compute the front from the volume of the ice."""
    steps = frozen()
    last, celsius = steps[-1], steps[-1].temperature["water"] - ZERO
    found = {
        "front at 1 h": 1.0 - last.liquid_volume["water"],
        "T(1 cm, 1 h)": float(celsius[10]),
        "T(5 cm, 1 h)": float(celsius[50]),
        "error of the heat, relative to the heat that left": last.ledger.relative_error,
    }
    return Outcome(values=found, panels=_panels(steps))


def _panels(steps: tuple[sw.heat.HeatStep, ...]) -> tuple[Panel, ...]:
    times, x = np.array([step.time for step in steps]), places()[:101]
    depth = [1.0 - step.liquid_volume["water"] for step in steps]
    fine = np.linspace(0.0, 0.1, 401)
    return (
        Panel(
            title="Front",
            x="t [s]",
            y="depth [m]",
            curves=(
                Curve(x=times, y=depth, label="softway"),
                Curve(x=times, y=front(times), kind="exact", label="Neumann"),
            ),
        ),
        Panel(
            title="Temperature after an hour",
            x="depth [m]",
            y="degrees Celsius",
            curves=(
                Curve(x=x, y=steps[-1].temperature["water"][:101] - ZERO, kind="dots", label="softway"),
                Curve(x=fine, y=temperature(fine, HOUR), kind="exact", label="Neumann"),
            ),
        ),
    )
