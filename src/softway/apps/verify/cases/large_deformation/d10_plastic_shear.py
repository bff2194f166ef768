"""D10: simple shear of an elastic, perfectly plastic material with the Jaumann rate: steady state in closed form.

Radial return is of first order in the slab length. The flow direction is that at the midpoint, rotated by half the spin
of the slab.
"""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.exact import shear
from softway.apps.verify.scenes.driving import RATES, sheared, square
from softway.arrays import Array
from softway.record.view.plots.curves import Curve, Panel

GAMMA, STEPS = 5.0, 1600


@cache
def path(k: float, steps: int = STEPS, gamma: float = GAMMA, rate: str = "jaumann") -> Array:
    """Stresses s11, s12, s22 (steps + 1, 3) of one element with shear modulus 1."""
    law = sw.J2(E=2.6, nu=0.3, yield_stress=float(np.sqrt(3.0) * k), rate=RATES[rate])
    memories = square(law).history(sheared(gamma, steps))
    return np.array([m.stress[0][[0, 0, 1], [0, 1, 1]] for m in memories])


def compute() -> Outcome:
    """Compute k = 0.1; the panel shows both values of k."""
    s11, s12, _ = path(0.1)[-1]
    gamma = np.linspace(0.0, GAMMA, STEPS + 1)
    curves = []
    for k in (0.1, 0.5):
        curves.append(Curve(x=gamma, y=path(k)[:, 1], label=f"k = {k}"))
        curves.append(Curve(x=gamma, y=shear.plastic(k, gamma)[1], kind="exact"))
    panel = Panel(title="Shear stress", x="gamma", y="s12 / G", curves=tuple(curves))
    return Outcome(values={"s12 at gamma=5, k=.1": s12, "s11 at gamma=5,k=.1": s11}, panels=(panel,))
