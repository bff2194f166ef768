"""E01: upsetting of a Norton-Hoff cylinder without friction: it stays a cylinder. 4 x 3 linear cells."""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.exact import flow
from softway.apps.verify.scenes.forming import Press
from softway.record.view.plots.curves import Curve, Panel


@cache
def upset(m: float, slabs: int = 50) -> Press:
    """Press half of the cylinder to a reduction of 50 percent."""
    return Press(material=sw.laws.NortonHoff(K=1.0, m=m), outer=1.0, height=0.75, cells=(4, 3), stroke=0.5, slabs=slabs)


def compute() -> Outcome:
    """Compute m = 0.3 in 50 slabs."""
    press = upset(0.3)
    last = press.steps[-1].after
    assert last.memory is not None
    stress = last.memory["body"].stress[:, 1, 1]
    found = {
        "force at 50%": press.force_at(0.5),
        "volume": press.radius("outer", "middle") ** 2 * 0.5,
        "uniformity of stress": float(np.ptp(stress) / np.abs(stress).max()),
    }
    r = np.linspace(0.0, 0.5, 100)
    curves = (
        Curve(x=press.reduction, y=press.force, label="means of slabs"),
        Curve(x=r, y=flow.upsetting(r, 0.3), kind="exact", label="closed form"),
    )
    return Outcome(values=found, panels=(Panel(title="Force of the platen", x="reduction", y="force", curves=curves),))
