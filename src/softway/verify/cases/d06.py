"""D06: a stretched bar spins about a pin at its end: its length stays, and energy and angular momentum do.

20 x 2 cells, 60 slabs a turn.
"""

from functools import cache

import numpy as np

import softway as sw
from softway.record.view_curves import Curve, Panel
from softway.verify.case import Outcome, sheet
from softway.verify.scenes.spinning import Spin, bar

TURN = 60
"""Slabs of a turn."""


@cache
def spun(turns: float) -> Spin:
    """By the discrete gradient."""
    data = sheet("D06")["definition"]
    return bar(sw.StVenantKirchhoff(E=data["E"]), sw.DiscreteGradient(), data, turns=turns)


def quantities(spin: Spin) -> dict[str, float]:
    """Those of the case."""
    return {
        "mean tip elongation": float(np.mean(spin.length)) - 1.0,
        "angular momentum drift": spin.drift("momentum"),
        "energy drift": spin.drift("energy"),
    }


def compute() -> Outcome:
    """Ten turns."""
    spin = spun(10.0)
    static = sheet("D06")["reference"]["u_tip_static"]
    curves = (
        Curve(x=spin.time[:TURN], y=spin.length[:TURN] - 1.0, label="softway"),
        Curve(x=[0.0, float(spin.time[TURN])], y=[static, static], kind="exact", label="linear, at rest"),
    )
    panel = Panel(title="Elongation in the first turn", x="t [s]", y="elongation / L", curves=curves)
    return Outcome(values=quantities(spin), panels=(panel,))
