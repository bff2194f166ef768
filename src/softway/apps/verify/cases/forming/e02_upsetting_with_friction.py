"""E02: upsetting of a cylinder with Norton-Hoff friction: force and barrelling. 12 x 10 linear cells."""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome, sheet
from softway.apps.verify.exact import flow
from softway.apps.verify.scenes.forming import Press
from softway.record.view.plots.curves import Curve, Panel


@cache
def upset() -> Press:
    """Press half of the cylinder to a reduction of 30 percent in 20 slabs."""
    friction = sw.laws.NortonHoffFriction(alpha=0.3, p=0.3, K=1.0)
    return Press(material=sw.laws.NortonHoff(K=1.0, m=0.3), outer=1.0, height=0.75, friction=friction, slabs=20)


def compute() -> Outcome:
    """Compute the forces at both ends of the stroke, and the final shape."""
    press = upset()
    found = {
        "F at reduction 0": press.force_at(0.0),
        "F at 30%": press.force_at(0.3),
        "barrelling r_mid - r_platen at 30%": press.radius("outer", "middle") - press.radius("outer", "platen"),
    }
    table = np.array(sheet("E02")["reference"]["fine_12x10x24"])
    r = np.linspace(0.0, 0.3, 100)
    curves = (
        Curve(x=press.reduction, y=press.force, label="softway"),
        Curve(x=table[:, 0], y=table[:, 1], kind="dots", label="quadratic cells"),
        Curve(x=r, y=flow.upsetting(r, 0.3), kind="exact", label="without friction"),
    )
    return Outcome(values=found, panels=(Panel(title="Force of the platen", x="reduction", y="force", curves=curves),))
