"""E02: upsetting of a cylinder with the friction of Norton and Hoff: force and barrelling.  12 x 10 linear cells."""

from functools import cache

import numpy as np

import softway as sw
from softway.record.view_curves import Curve, Panel
from softway.verify.case import Outcome, sheet
from softway.verify.exact import flow
from softway.verify.scenes.forming import Press


@cache
def upset() -> Press:
    """Half of the height reduced by 30 per cent in 20 slabs."""
    friction = sw.NortonHoffFriction(alpha=0.3, p=0.3, K=1.0)
    return Press(material=sw.NortonHoff(K=1.0, m=0.3), outer=1.0, height=0.75, friction=friction, slabs=20)


def compute() -> Outcome:
    """Forces at both ends of the stroke and the shape at the last."""
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
