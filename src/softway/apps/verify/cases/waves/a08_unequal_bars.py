"""A08: collision of two bars that differ in length (a) or impedance (b, c), with non-matching meshes across them.

As in A07 the speed is the wave speed in 1D and a hundredth of it in 2D and 3D.
"""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from softway.apps.verify.case import Outcome
from softway.apps.verify.scenes.colliding import Bar, Collision, collided, pair
from softway.record.view.plots.curves import Curve, Panel

CASES = {
    "a": (Bar(), Bar(length=2.0, along=100)),
    "b": (Bar(), Bar(youngs=4.0)),
    "c": (Bar(youngs=4.0), Bar()),
}
VELOCITY = {"a": (0.0, 0.5), "b": (1.0 / 9.0, 8.0 / 9.0), "c": (1.0 / 9.0, 8.0 / 9.0)}
FORCE = {"a": (0.5, 0.5), "b": (2.0 / 3.0, 2.0 / 9.0), "c": (2.0 / 3.0, 2.0 / 9.0)}
"""Forces up to t = 1 and up to t = 2."""
VIBRATION = {"a": (0.0, 1.0 / 2.0), "b": (16.0 / 81.0, 0.0), "c": (0.0, 16.0 / 81.0)}
"""Fraction of the energy in the vibration of each bar about its centre of mass."""


@cache
def thrown(case: str, dim: int, refined: int = 1) -> tuple[Collision, float]:
    """Collision and its speed: 50 elements per unit length; in 3D a stiff bar has half of them."""
    speed, across = (1.0, 1) if dim == 1 else (0.01, 5 - dim)
    bars = [replace(b, along=refined * b.along) for b in CASES[case]]
    if dim == 3:
        bars = [replace(b, along=round(b.along / b.youngs**0.5)) for b in bars]
    left, right = replace(bars[0], speed=speed, across=across), replace(bars[1], across=across + 1)
    return collided(pair(left, right, dim), 2.2), speed


def compute() -> Outcome:
    """Compute with 50 elements per unit length, and 100 for the end of contact of a, as given in the case."""
    found: dict[str, Any] = {}
    for dim, tail in ((1, ""), (2, ", plane strain")):
        a, speed = thrown("a", dim)
        b, _ = thrown("b", dim)
        found["a: v_after" + tail] = (a.velocity[:, 0] / speed).tolist()
        found["b: force" + tail] = b.mean_force(0.1, 0.95) / speed
    found["a: v_after, 3D"] = (thrown("a", 3)[0].velocity[:, 0] / thrown("a", 3)[1]).tolist()
    found["a: end of contact"] = thrown("a", 1, 2)[0].release
    found["c: v_after"] = thrown("c", 1)[0].velocity[:, 0].tolist()
    return Outcome(values=found, panels=tuple(_panel(case) for case in CASES))


def _panel(case: str) -> Panel:
    march, _ = thrown(case, 1)
    first, second = FORCE[case]
    exact = np.array([0.0, first, first, second, second, 0.0, 0.0])
    curves = (
        Curve(x=march.time, y=march.force, label="softway, 1D"),
        Curve(x=[0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.2], y=exact, kind="exact", label="characteristics"),
    )
    return Panel(title=f"Force, bars {case}", x="t", y="force", curves=curves)
