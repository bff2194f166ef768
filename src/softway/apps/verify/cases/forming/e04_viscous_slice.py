"""E04: slice of a Newtonian fluid in plane strain under a platen with linear friction. 24 x 10 linear cells."""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome, sheet
from softway.apps.verify.scenes.forming import Press
from softway.record.view.plots.curves import Curve, Panel


@cache
def pressed() -> Press:
    """Press half of the slice to a reduction of 20 percent in 20 slabs."""
    return Press(
        material=sw.laws.NortonHoff(K=1.0, m=1.0),
        outer=2.0,
        height=0.5,
        friction=sw.laws.NortonHoffFriction(alpha=0.4, p=1.0, K=1.0),
        section=sw.bodies.PlaneStrain(),
        cells=(24, 10),
        stroke=0.2,
        slabs=20,
    )


def compute() -> Outcome:
    """Compute the forces at both ends of the stroke."""
    press = pressed()
    found = {"F0 per half width per unit depth": press.force_at(0.0), "F at 20%": press.force_at(0.2)}
    table = np.array(sheet("E04")["reference"]["table"])
    curves = (
        Curve(x=press.reduction, y=press.force, label="softway"),
        Curve(x=table[:, 0], y=table[:, 1], kind="dots", label="quadratic cells"),
    )
    return Outcome(values=found, panels=(Panel(title="Force of the platen", x="reduction", y="force", curves=curves),))
