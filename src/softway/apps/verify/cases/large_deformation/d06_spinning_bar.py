"""D06: stretched bar spins about a pin at its end: length, energy and angular momentum stay constant.

20 x 2 cells, 60 slabs per turn.
"""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome, sheet
from softway.apps.verify.scenes.spinning import Spin, bar
from softway.record.view.plots.curves import Curve, Panel

TURN = 60
"""Slabs per turn."""


@cache
def spun(turns: float) -> Spin:
    """March a number of turns with the discrete gradient."""
    data = sheet("D06")["definition"]
    return bar(sw.laws.StVenantKirchhoff(E=data["E"]), sw.bodies.DiscreteGradient(), data, turns=turns)


def quantities(spin: Spin) -> dict[str, float]:
    """Quantities of the case."""
    return {
        "mean tip elongation": float(np.mean(spin.length)) - 1.0,
        "angular momentum drift": spin.drift("momentum"),
        "energy drift": spin.drift("energy"),
    }


def compute() -> Outcome:
    """Compute ten turns."""
    spin = spun(10.0)
    static = sheet("D06")["reference"]["u_tip_static"]
    curves = (
        Curve(x=spin.time[:TURN], y=spin.length[:TURN] - 1.0, label="softway"),
        Curve(x=[0.0, float(spin.time[TURN])], y=[static, static], kind="exact", label="linear, at rest"),
    )
    panel = Panel(title="Elongation in the first turn", x="t [s]", y="elongation / L", curves=curves)
    return Outcome(values=quantities(spin), panels=(panel,))
