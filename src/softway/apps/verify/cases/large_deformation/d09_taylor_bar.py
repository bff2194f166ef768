"""D09: Taylor bar, a copper cylinder thrown at a rigid wall, as a body of revolution (``scenes/taylor.py``).

The corner folds, so the flank of the bar is also a contact surface.
"""

from functools import cache

import numpy as np

from softway.apps.verify.case import Outcome
from softway.apps.verify.scenes import taylor
from softway.arrays import Array
from softway.record.view.plots.curves import Curve, Panel

COARSE, FINE = (5, 25), (10, 50)
STEPS = {COARSE: 0.78e-6, FINE: 0.39e-6}
"""Slab length [s], 8 times the automatic one."""


@cache
def bar(cells: tuple[int, int], step: float) -> tuple[taylor.Crushed, Array]:
    """Final measurements of the bar, and final positions (n, 2) [mm] of its flank from the foot to the rear end."""
    model, steps = taylor.marched(cells, step)
    mesh = model.parts[0].mesh
    flank = mesh.nodes("right")
    flank = flank[np.argsort(mesh.points[flank, 1])]
    return taylor.measured(model, steps), 1e3 * (mesh.points + steps[-1].after.displacement["bar"])[flank]


def quantities(crushed: taylor.Crushed) -> dict[str, float]:
    """Quantities of the case; the plastic strain is the greatest cell mean."""
    return {
        "final length mm": crushed.length,
        "mushroom radius mm": crushed.radius,
        "max equivalent plastic strain": crushed.strain,
        "volume change": crushed.growth,
    }


def compute() -> Outcome:
    """Compute 5 by 25 cells, and the quantities that differ with 10 by 50."""
    coarse, fine = (bar(cells, STEPS[cells]) for cells in (COARSE, FINE))
    found = quantities(coarse[0])
    found["max equivalent plastic strain, at a point"] = coarse[0].peak
    found["final length mm, 10 x 50"] = fine[0].length
    found["mushroom radius mm, 10 x 50"] = fine[0].radius
    curves = (
        *(Curve(x=p[:, 0], y=p[:, 1], label=name) for (_, p), name in ((coarse, "5 x 25 cells"), (fine, "10 x 50"))),
        Curve(x=[7.12, 0.0], y=[0.0, 21.48], kind="dots", label="published, mean"),
    )
    panel = Panel(title="Flank of the bar at 80 us", x="radius [mm]", y="height [mm]", curves=curves)
    return Outcome(values=found, panels=(panel,))
