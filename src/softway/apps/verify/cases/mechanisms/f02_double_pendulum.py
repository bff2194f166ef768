"""F02: two point masses on massless rods, released horizontally."""

from functools import cache

import numpy as np

from softway.apps.verify.case import Outcome
from softway.apps.verify.cases.mechanisms import linkages
from softway.mechanisms import MechanismStep, march
from softway.record.view.plots.curves import Curve, Panel


def both(step: MechanismStep) -> tuple[float, float]:
    """Angles of the rods from the downward direction."""
    upper, lower = (step.bodies[name].centre for name in ("upper", "lower"))
    return float(np.arctan2(upper[0], -upper[1])), float(np.arctan2(*((lower - upper) * [1.0, -1.0])))


@cache
def swung() -> tuple[MechanismStep, ...]:
    """Steps of 10 s."""
    return tuple(march(linkages.double_pendulum(), until=10.0, step=1e-3, every=10))


def compute() -> Outcome:
    """Compute the case."""
    steps = swung()
    found = {
        "theta at t=3": list(both(steps[300])),
        "energy drift 10 s": max(abs(s.energy_error) for s in steps),
    }
    ways = [np.array([s.bodies[name].centre for s in steps]) for name in ("upper", "lower")]
    curves = tuple(Curve(x=w[:, 0], y=w[:, 1], label=n) for w, n in zip(ways, ("upper", "lower"), strict=True))
    return Outcome(values=found, panels=(Panel(title="Paths over 10 s", x="x [m]", y="y [m]", curves=curves),))
