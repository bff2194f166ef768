"""D03: residual stress of a hypoelastic cell after a closed cycle, compared with its differential equation.

Both Lame constants are 1; 100 slabs per leg.
"""

from functools import cache
from typing import Any

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome, sheet
from softway.apps.verify.scenes.driving import RATES, cycle, square
from softway.bodies.internal_force.material_state import MaterialState
from softway.record.view.plots.curves import Curve, Panel

SLABS = 100


@cache
def cycled(rate: str, height: float = 0.2, shift: float = 0.3, slabs: int = SLABS) -> tuple[MaterialState, ...]:
    """History variables at the start and after each slab: stretch in y, shear, and both reversed."""
    body = square(sw.Hypoelastic(E=2.5, nu=0.25, rate=RATES[rate]))
    return tuple(body.history(cycle(height, shift, slabs)))


def compute() -> Outcome:
    """Compute the cycle of the case with the Jaumann and Truesdell rates."""
    found: dict[str, Any] = {}
    curves: list[Curve] = []
    known = []
    for rate in ("jaumann", "truesdell"):
        stress = np.array([m.stress[0] for m in cycled(rate)])
        found |= {f"residual s{c} {rate.capitalize()}": float(stress[-1, 0, c % 10 - 1]) for c in (11, 12)}
        known.append(np.array(sheet("D03")["reference"]["stress_after_each_step"][rate])[:, 0, 1])
        curves.append(Curve(x=np.arange(len(stress)) / SLABS, y=stress[:, 0, 1], label=rate.capitalize()))
    dots = Curve(x=[1.0, 2.0, 3.0, 4.0] * 2, y=np.concatenate(known), kind="dots", label="Runge and Kutta")
    panel = Panel(title="Shear stress around the cycle", x="leg", y="s12 / G", curves=(*curves, dots))
    return Outcome(values=found, panels=(panel,))
