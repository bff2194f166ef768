"""F04: slider-crank of uniform rods, released at 150 rad/s."""

from functools import cache

import numpy as np

from softway.apps.verify.case import Outcome
from softway.apps.verify.cases.mechanisms import linkages
from softway.arrays import Array
from softway.mechanisms import MechanismStep, march
from softway.record.view.plots.curves import Curve, Panel


@cache
def cranked(h: float) -> tuple[Array, Array, float]:
    """Times and angles of the crank up to 0.1 s, and its angular velocity there."""
    steps = list(linkages.angles(march(linkages.slider_crank(), until=0.1, step=h, every=5), "crank"))
    spin = float(steps[-1][0].bodies["crank"].spin[0])
    return np.array([s.time for s, _ in steps]), np.array([angle for _, angle in steps]), spin


@cache
def long() -> tuple[MechanismStep, float]:
    """Last step of 1e5 slabs, and the greatest error of the energy relative to it."""
    return linkages.last(linkages.slider_crank(), until=10.0, step=1e-4)


def compute() -> Outcome:
    """Compute the case."""
    time, angle, spin = cranked(1e-4)
    step, energy = long()
    found = {
        "theta(.1)": float(angle[-1]),
        "omega(.1)": spin,
        "energy drift, 1e5 slabs": energy,
        "joints after 1e5 slabs [m]": step.joints,
        "velocities in the joints after 1e5 slabs [m/s]": step.joint_velocity,
    }
    curve = Curve(x=time, y=angle, label="h = 0.1 ms")
    return Outcome(values=found, panels=(Panel(title="Crank", x="t [s]", y="angle [rad]", curves=(curve,)),))
