"""F11: a free body turns over and over about its middle axis."""

from functools import cache

import numpy as np

from softway.apps.verify.case import Outcome
from softway.apps.verify.cases.mechanisms import linkages
from softway.arrays import Array
from softway.mechanisms import march
from softway.record.view.plots.curves import Curve, Panel

END, H = 10.0, 0.005


@cache
def tumbled() -> tuple[Array, Array, float]:
    """Times, angular velocities (n, 3) in the axes of the body, greatest relative error of energy and |L|."""
    time, spins, worst, start = [], [], 0.0, 0.0
    for step in march(linkages.top(), until=END, step=H, every=4):
        size = float(np.linalg.norm(step.spin))
        start = start or size
        worst = max(worst, abs(step.energy_error) / step.energy_kinetic, abs(size / start - 1.0))
        time.append(step.time)
        spins.append(step.bodies["top"].rotation.T @ step.bodies["top"].spin)
    return np.array(time), np.array(spins), worst


def compute() -> Outcome:
    """Compute the case."""
    time, spins, worst = tumbled()
    found = {"w at t=10": spins[-1].tolist(), "energy, |L| drift": worst}
    curves = tuple(Curve(x=time, y=spins[:, k], label=f"axis {k + 1}") for k in range(3))
    panel = Panel(title="Angular velocity along the axes of the body", x="t [s]", y="w [rad/s]", curves=curves)
    return Outcome(values=found, panels=(panel,))
