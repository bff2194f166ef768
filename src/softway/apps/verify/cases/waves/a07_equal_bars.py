"""A07: collision of two equal bars in 1D, 2D and 3D, with meshes that do not match across the bars.

The left bar of the case moves at the wave speed. In 2D and 3D the speed is a hundredth of it, and results are scaled
by it: bars compressed to half their length end to end, without friction or lateral support, would buckle; rounding
errors grow by about exp(13 t) there.
"""

from functools import cache
from typing import Any

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.scenes.colliding import Bar, Collision, collided, pair
from softway.record.view.plots.curves import Curve, Panel

SPEED = {1: 1.0, 2: 0.01, 3: 0.01}
SCENES: dict[str, tuple[int, dict[str, Any]]] = {
    "1D": (1, {}),
    "plane strain": (2, {}),
    "plane stress": (2, {"section": sw.bodies.PlaneStress()}),
    "nodes on faces": (2, {"method": sw.contact.NodeToSurface()}),
    "3D": (3, {}),
}


@cache
def crashed(name: str) -> Collision:
    """March with 50 elements along each bar, and 3 and 4 or 2 and 3 across them."""
    dim, given = SCENES[name]
    across = 5 - dim
    return collided(pair(Bar(speed=SPEED[dim], across=across), Bar(across=across + 1), dim, **given), 2.2)


def speed(name: str) -> float:
    """Speed of the left bar."""
    return SPEED[SCENES[name][0]]


def compute() -> Outcome:
    """Compute velocities and momentum relative to those of the left bar, and half of the relative energy."""
    found: dict[str, Any] = {}
    for name in ("1D", "plane strain", "3D"):
        march, tail = crashed(name), "" if name == "1D" else f", {name}"
        found["duration" + tail] = march.duration
        found["v_com after" + tail] = (march.velocity[:, 0] / speed(name)).tolist()
        found["total momentum" + tail] = 1.0 + march.momentum
        found["energy" + tail] = 0.5 * march.energy
    return Outcome(values=found, panels=(_panel(),))


def _panel() -> Panel:
    ours = [Curve(x=crashed(n).time, y=crashed(n).force / speed(n), label=n) for n in ("1D", "plane strain", "3D")]
    exact = Curve(x=[0.0, 0.0, 2.0, 2.0, 2.2], y=np.array([0.0, 0.5, 0.5, 0.0, 0.0]), kind="exact", label="d'Alembert")
    return Panel(title="Force between the bars", x="t c / L", y="force / (rho c v A)", curves=(*ours, exact))
