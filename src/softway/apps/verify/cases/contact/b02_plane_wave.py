"""B02: plane wave through two blocks on lateral rollers with non-matching meshes, 5 and 8 elements across.

E = rho = 1, nu = 0.3; pressure waves with c = sqrt((lambda + 2 mu)/rho).
"""

from functools import cache
from math import sqrt
from typing import Any

import numpy as np

from softway.apps.verify.case import Outcome
from softway.apps.verify.scenes.colliding import Bar, Collision, collided, pair
from softway.record.view.plots.curves import Curve, Panel

WAVE = sqrt(0.7 / (1.3 * 0.4))
PRESSURE = 0.5 * WAVE
DURATION = 2.0 / WAVE
ALONG = {2: 50, 3: 25}


@cache
def crashed(dim: int) -> Collision:
    """March with 50 elements along each block, 25 in 3D."""
    along = ALONG[dim]
    left = Bar(poisson=0.3, width=0.5, along=along, speed=1.0, across=5)
    right = Bar(poisson=0.3, width=0.5, along=along, across=8)
    return collided(pair(left, right, dim, rollers=True), 2.0)


def uneven(march: Collision) -> float:
    """Greatest difference of nodal pressures across the interface during contact, relative to the mean pressure."""
    forces = np.array([s.after.pressure["middle"] for s in march.steps])
    line = np.concatenate([[0.5], np.ones(7), [0.5]]) / 8.0
    area = line if forces.shape[1] == 9 else np.kron(line, line)
    total = forces.sum(axis=1, keepdims=True)
    pressure = (forces / area)[total[:, 0] > 0.1 * total.max()] / total.max()
    return float(np.ptp(pressure, axis=1).max())


def compute() -> Outcome:
    """Compute the case in plane strain and in 3D."""
    found: dict[str, Any] = {}
    for dim, tail in ((2, ""), (3, ", 3D")):
        march = crashed(dim)
        found["mean interface pressure over contact" + tail] = march.mean_force(0.0, DURATION)
        found["transverse variation of pressure" + tail] = uneven(march)
        found["duration" + tail] = march.duration
        found["v_com" + tail] = march.velocity[:, 0].tolist()
    exact = Curve(
        x=[0.0, 0.0, DURATION, DURATION, 2.0],
        y=np.array([0.0, 1.0, 1.0, 0.0, 0.0]) * PRESSURE,
        kind="exact",
        label="d'Alembert",
    )
    ours = [Curve(x=crashed(d).time, y=crashed(d).force, label=n) for d, n in ((2, "plane strain"), (3, "3D"))]
    panel = Panel(title="Pressure at the interface", x="t", y="pressure / E", curves=(*ours, exact))
    return Outcome(values=found, panels=(panel,))
