"""E03: ring test 6 : 3 : 2, in which the inner radius depends on friction. 16 x 8 linear cells."""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome, sheet
from softway.apps.verify.scenes.forming import Press
from softway.arrays import Array
from softway.record.view.plots.curves import Curve, Panel

ALPHAS = (0.05, 0.2, 0.5)


@cache
def ring(alpha: float, slabs: int = 12) -> Press:
    """Press half of the ring to a reduction of 30 percent."""
    return Press(
        material=sw.laws.NortonHoff(K=1.0, m=0.2),
        inner=1.5,
        outer=3.0,
        height=1.0,
        friction=sw.laws.NortonHoffFriction(alpha=alpha, p=0.2, K=1.0),
        cells=(16, 8),
        slabs=slabs,
    )


def compute() -> Outcome:
    """Compute three friction coefficients."""
    name = "inner radius (midplane) change at 30 percent, alpha={}"
    found = {name.format(alpha): ring(alpha).radius("inner", "middle") - 1.5 for alpha in ALPHAS}
    found["F at 30%, alpha=.2"] = ring(0.2).force_at(0.3)
    return Outcome(values=found, panels=(_calibration(), _forces()))


def _calibration() -> Panel:
    ours = [(100.0 * ring(alpha).bore[0], ring(alpha).bore[1]) for alpha in ALPHAS]
    return _panel("Inner radius of the ring", "radius", ours, 4)


def _forces() -> Panel:
    ours = [(100.0 * ring(alpha).reduction, ring(alpha).force) for alpha in ALPHAS]
    return _panel("Force of the platen", "force", ours, 1)


def _panel(title: str, name: str, ours: list[tuple[Array, Array]], column: int) -> Panel:
    """Panel of computed curves with a column of the reference table."""
    lines = [Curve(x=x, y=y, label=f"alpha = {alpha}") for (x, y), alpha in zip(ours, ALPHAS, strict=True)]
    tables = [np.array(sheet("E03")["reference"]["table"][str(alpha)]) for alpha in ALPHAS]
    known = [
        Curve(x=100.0 * t[:, 0], y=t[:, column], kind="exact", label="quadratic cells" * (k == 0))
        for k, t in enumerate(tables)
    ]
    return Panel(title=title, x="reduction [%]", y=name, curves=(*lines, *known))
