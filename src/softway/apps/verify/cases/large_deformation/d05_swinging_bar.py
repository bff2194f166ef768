"""D05: stiff bar rotates about a pin; the discrete gradient conserves energy and angular momentum."""

from functools import cache

import numpy as np

from softway.apps.verify.case import Outcome, sheet
from softway.apps.verify.scenes.spinning import Spin, pendulum

STEP = 0.0125
"""Slab length [s]; step control halves longer slabs, whose momentum is limited by rounding of the strain."""


@cache
def swing(turns: float) -> Spin:
    """March a number of turns."""
    d = sheet("D05")["definition"]
    return pendulum(d["length"], d["stiffness"], d["mass"], d["speed"], step=STEP, turns=turns)


def quantities(spin: Spin) -> dict[str, float]:
    """Quantities of the case."""
    return {
        "energy drift 10 rev": spin.drift("energy"),
        "period": spin.period,
        "length change": float(np.abs(spin.length / sheet("D05")["definition"]["length"] - 1.0).max()),
    }


def compute() -> Outcome:
    """Compute ten turns."""
    return Outcome(values=quantities(swing(10.0)))
