"""C04: block slowed down by viscoplastic friction, F = -alpha |v|^(p-1) v.

Block of length 1 and mass 1.3, E = 1e6, pressed on the floor; K = 1 over its length gives the traction.
"""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.scenes import sliding
from softway.arrays import Array
from softway.record.view.plots.curves import Curve, Panel

MASS, ALPHA, START, STEP = 1.3, 0.9, 2.0, 0.02


@cache
def slowed(p: float, step: float = STEP, until: float = 1.0) -> tuple[Array, Array, Array]:
    """Time, place and velocity at the ends of the slabs."""
    scene = sliding.on_plane(
        friction=sw.laws.NortonHoffFriction(alpha=ALPHA, p=p),
        velocity=START,
        gravity=(0.0, -100.0),
        resisted=-ALPHA * START**p / MASS,
        size=(1.0, 0.2),
        cells=(4, 4),
        E=1e6,
        nu=0.0,
        density=MASS / 0.2,
    )
    march = sliding.travelled(sw.march(scene, until=until, step=step))
    time, place, speed = np.array([(t, x, s.ledger.momentum[0] / MASS) for t, x, s in march]).T
    return time, place, speed


def stop(time: Array, speed: Array) -> float:
    """Time at which the block stops.

    It is the end of the first slab after which the speed stays below 1/1000 of the initial speed, plus the remaining
    time to zero: the square root of the speed decreases linearly.
    """
    moving = np.flatnonzero(np.abs(speed) > 1e-3 * START)
    last = int(moving[-1])
    return float(time[last] + np.sqrt(speed[last]) * 2.0 * MASS / ALPHA)


def compute() -> Outcome:
    """Compute the speed after 1 s for p = 1 and 2, and the time at which the block stops for p = 1/2."""
    found = {f"v(1), p={p:g}": float(slowed(p)[2][-1]) for p in (1.0, 2.0)}
    time, _, speed = slowed(0.5, until=4.5)
    found["p=.5 stops at finite time"] = stop(time, speed)
    t = np.linspace(0.0, 4.5, 200)
    exact = (np.sqrt(START) - 0.5 * ALPHA * t / MASS).clip(0.0) ** 2
    curves = (
        *(Curve(x=slowed(p)[0], y=slowed(p)[2], label=f"p = {p:g}") for p in (1.0, 2.0)),
        Curve(x=time, y=speed, label="p = 1/2"),
        Curve(x=t, y=exact, kind="exact", label="closed form, p = 1/2"),
    )
    return Outcome(values=found, panels=(Panel(title="Slowing down", x="t [s]", y="speed [m/s]", curves=curves),))
