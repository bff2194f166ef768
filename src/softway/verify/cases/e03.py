"""E03: the ring test 6 : 3 : 2: the inner radius tells the friction.  16 x 8 linear cells."""

from functools import cache

import numpy as np

import softway as sw
from softway.record.view_curves import Curve, Panel
from softway.verify.case import Outcome, sheet
from softway.verify.scenes.forming import Press

ALPHAS = (0.05, 0.2, 0.5)


@cache
def ring(alpha: float, slabs: int = 12) -> Press:
    """Half of the ring, its height reduced by 30 per cent."""
    return Press(
        material=sw.NortonHoff(K=1.0, m=0.2),
        inner=1.5,
        outer=3.0,
        height=1.0,
        friction=sw.NortonHoffFriction(alpha=alpha, p=0.2, K=1.0),
        cells=(16, 8),
        slabs=slabs,
    )


def compute() -> Outcome:
    """Three frictions."""
    name = "inner radius (midplane) change at 30 percent, alpha={}"
    found = {name.format(alpha): ring(alpha).radius("inner", "middle") - 1.5 for alpha in ALPHAS}
    found["F at 30%, alpha=.2"] = ring(0.2).force_at(0.3)
    return Outcome(values=found, panels=(_calibration(), _forces()))


def _table(alpha: float) -> np.ndarray:
    return np.array(sheet("E03")["reference"]["table"][str(alpha)])


def _calibration() -> Panel:
    curves = []
    for alpha in ALPHAS:
        reduction, radius = ring(alpha).bore
        curves.append(Curve(x=100.0 * reduction, y=radius, label=f"alpha = {alpha}"))
        curves.append(Curve(x=100.0 * _table(alpha)[:, 0], y=_table(alpha)[:, 4], kind="dots"))
    return Panel(title="Inner radius of the ring", x="reduction [%]", y="radius", curves=tuple(curves))


def _forces() -> Panel:
    curves = []
    for alpha in ALPHAS:
        curves.append(Curve(x=100.0 * ring(alpha).reduction, y=ring(alpha).force, label=f"alpha = {alpha}"))
        curves.append(Curve(x=100.0 * _table(alpha)[:, 0], y=_table(alpha)[:, 1], kind="dots"))
    return Panel(title="Force of the platen", x="reduction [%]", y="force", curves=tuple(curves))
