"""F01: a point mass on a massless rod, released horizontally."""

from functools import cache

import numpy as np

from softway.apps.verify.case import Outcome
from softway.apps.verify.cases.mechanisms import linkages
from softway.arrays import Array
from softway.mechanisms import MechanismStep, march
from softway.record.view.plots.curves import Curve, Panel

EXACT = 0.2786806735699831


def angle(step: MechanismStep) -> float:
    """Angle from the downward direction."""
    x, y = step.bodies["mass"].centre
    return float(np.arctan2(x, -y))


@cache
def swung(h: float) -> tuple[float, float, float]:
    """Angle at 10 s, greatest error of the energy [J], and that of the length [m]."""
    steps = list(march(linkages.pendulum(), until=10.0, step=h))
    lengths = [float(np.hypot(*s.bodies["mass"].centre)) - 1.0 for s in steps]
    return angle(steps[-1]), max(abs(s.energy_error) for s in steps), float(np.abs(lengths).max())


@cache
def long() -> tuple[float, float]:
    """Errors of the energy [J] and of the length [m] over 1e5 slabs of 10 ms."""
    steps = list(march(linkages.pendulum(), until=1000.0, step=0.01, every=1000))
    return max(abs(s.energy_error) for s in steps), max(s.joints for s in steps)


def compute() -> Outcome:
    """Compute the case."""
    fine, energy, length = swung(0.004)
    finer = swung(0.002)[0]
    found = {
        "theta(10)": fine,
        "energy drift": energy,
        "|r| - L": length,
        "order of theta(10)": float(np.log2((fine - EXACT) / (finer - EXACT))),
        "energy drift, 1e5 slabs of 10 ms": long()[0],
        "|r| - L after them": long()[1],
    }
    time, turned = _curve()
    curve = Curve(x=time, y=turned, label="h = 4 ms")
    return Outcome(values=found, panels=(Panel(title="Pendulum", x="t [s]", y="angle [rad]", curves=(curve,)),))


def _curve() -> tuple[Array, Array]:
    """Times and angles."""
    steps = list(march(linkages.pendulum(), until=10.0, step=0.004, every=5))
    return np.array([s.time for s in steps]), np.array([angle(s) for s in steps])
