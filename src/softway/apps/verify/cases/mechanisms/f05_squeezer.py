"""F05: Andrews' squeezer mechanism, seven bodies driven by a torque from rest."""

from functools import cache

import numpy as np

from softway.apps.verify.case import Outcome
from softway.apps.verify.cases.mechanisms import linkages
from softway.arrays import Array
from softway.mechanisms import march
from softway.record.view.plots.curves import Curve, Panel

EXACT = 15.810771195154118
"""beta at the end."""
END = 0.03


@cache
def squeezed(h: float) -> tuple[Array, Array]:
    """Times (n,) and the angles beta, Theta, gamma (n, 3)."""
    start = np.array(linkages.ANGLES[:3])
    time, found, turned = [], [], np.zeros(3)
    before = np.zeros(3)
    for step in march(linkages.squeezer(), until=END, step=h, every=10):
        now = np.array([linkages.heading(step.bodies[name]) for name in ("k1", "k2", "k3")])
        turned = turned + (now - before + np.pi) % (2.0 * np.pi) - np.pi
        before = now
        time.append(step.time)
        found.append(start + [turned[0], turned[1] - turned[0], turned[2]])
    return np.array(time), np.array(found)


def compute() -> Outcome:
    """Compute the case."""
    (time, all_angles), (_, finer) = squeezed(1e-5), squeezed(5e-6)
    coarse, fine = all_angles[-1], finer[-1]
    found = {
        "beta, Theta at 30 ms": coarse[:2].tolist(),
        "gamma": float(coarse[2]),
        "beta, Theta, gamma extrapolated": ((4.0 * fine - coarse) / 3.0).tolist(),
        "order of beta": float(np.log2((coarse[0] - EXACT) / (fine[0] - EXACT))),
    }
    names = ("beta", "Theta", "gamma")
    curves = tuple(Curve(x=time, y=all_angles[:, k], label=name) for k, name in enumerate(names))
    return Outcome(values=found, panels=(Panel(title="Angles", x="t [s]", y="angle [rad]", curves=curves),))
