"""F12: Bricard's mechanism has 30 joint rows for 30 unknowns, of which 29 are independent: it moves."""

from functools import cache

import numpy as np

from softway.apps.verify.case import Outcome
from softway.apps.verify.cases.mechanisms import linkages
from softway.arrays import Array
from softway.mechanisms import MechanismStep, march
from softway.record.view.plots.curves import Curve, Panel


@cache
def moved() -> tuple[MechanismStep, ...]:
    """Steps of 10 s."""
    return tuple(march(linkages.bricard(), until=10.0, step=0.005, every=2))


def compute() -> Outcome:
    """Compute the case."""
    steps = moved()
    found = {
        "independent rows of 30": float(max(s.independent for s in steps)),
        "A04 energy drift 10 s": max(abs(s.energy_error) for s in steps),
        "joints [m]": max(s.joints for s in steps),
    }
    time: Array = np.array([s.time for s in steps])
    way: Array = np.array([s.bodies["rod2"].centre for s in steps])
    curves = tuple(Curve(x=time, y=way[:, k], label=name) for k, name in enumerate("xyz"))
    return Outcome(values=found, panels=(Panel(title="Centre of the middle rod", x="t [s]", y="[m]", curves=curves),))
