"""E04: a slice of Newton's fluid in plane strain under a platen with linear friction.  24 x 10 linear cells."""

from functools import cache

import numpy as np

import softway as sw
from softway.record.view_curves import Curve, Panel
from softway.verify.case import Outcome, sheet
from softway.verify.scenes.forming import Press


@cache
def pressed() -> Press:
    """Half of the height reduced by 20 per cent in 20 slabs."""
    return Press(
        material=sw.NortonHoff(K=1.0, m=1.0),
        outer=2.0,
        height=0.5,
        friction=sw.NortonHoffFriction(alpha=0.4, p=1.0, K=1.0),
        section=sw.PlaneStrain(),
        cells=(24, 10),
        stroke=0.2,
        slabs=20,
    )


def compute() -> Outcome:
    """Forces at both ends of the stroke."""
    press = pressed()
    found = {"F0 per half width per unit depth": press.force_at(0.0), "F at 20%": press.force_at(0.2)}
    table = np.array(sheet("E04")["reference"]["table"])
    curves = (
        Curve(x=press.reduction, y=press.force, label="softway"),
        Curve(x=table[:, 0], y=table[:, 1], kind="dots", label="quadratic cells"),
    )
    return Outcome(values=found, panels=(Panel(title="Force of the platen", x="reduction", y="force", curves=curves),))
