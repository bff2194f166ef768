"""C09: unit block on a slope of tan = 0.5 slides with mu = 0.49 and sticks with mu = 0.50; E = 1e9, rho = 1000."""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.scenes import sliding
from softway.arrays import Array
from softway.record.view.plots.curves import Curve, Panel

SLOPE = float(np.rad2deg(np.arctan(0.5)))


@cache
def let_go(mu: float) -> tuple[Array, Array, float]:
    """Time, distance down the slope, and greatest error of the energy balance.

    With mu = 0.49 the block starts in slip, at 1e-9 m/s.
    """
    rest = mu >= 0.5
    scene = sliding.incline(SLOPE, mu, 0.0 if rest else -1e-9, rest=rest, size=(1.0, 1.0), cells=(4, 4))
    steps = list(sw.march(scene, until=2.0, step=0.01))
    start = float(steps[0].before.displacement["b"][:, 0].mean())
    time, place = np.array([(t, x) for t, x, _ in sliding.travelled(iter(steps))]).T
    return time, start - place, max(abs(s.ledger.energy_error) for s in steps)


def compute() -> Outcome:
    """Compute both sides of the limit."""
    time, way, _ = let_go(0.49)
    found = {
        "x(2s) mu=.49": float(way[-1]),
        "|x|(2s) mu=.50 (allow .5001)": abs(float(let_go(0.5)[1][-1])),
    }
    fall = 9.81 * (0.5 - 0.49) / np.sqrt(1.25)
    curves = (
        Curve(x=time, y=way, label="mu = 0.49"),
        Curve(x=let_go(0.5)[0], y=let_go(0.5)[1], label="mu = 0.50"),
        Curve(x=time, y=0.5 * fall * time**2, kind="exact", label="closed form"),
    )
    return Outcome(values=found, panels=(Panel(title="Down the slope", x="t [s]", y="way [m]", curves=curves),))
