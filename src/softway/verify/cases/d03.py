"""D03: a closed cycle of a hypoelastic cell leaves the stress that its differential equation leaves.

Both constants of Lame are 1; 100 slabs a leg.
"""

from functools import cache
from typing import Any

import numpy as np

import softway as sw
from softway.bodies.memory import Memory
from softway.record.view_curves import Curve, Panel
from softway.verify.case import Outcome, sheet
from softway.verify.scenes.driving import RATES, cycle, square

SLABS = 100


@cache
def cycled(rate: str, height: float = 0.2, shift: float = 0.3, slabs: int = SLABS) -> tuple[Memory, ...]:
    """Memories at the start and after each slab: stretched in y, sheared, and both taken back."""
    body = square(sw.Hypoelastic(E=2.5, nu=0.25, rate=RATES[rate]))
    return tuple(body.history(cycle(height, shift, slabs)))


def compute() -> Outcome:
    """The cycle of the case with the rates of Jaumann and Truesdell."""
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
