"""D05: a stiff bar swings about a pin; a slab force of the chord keeps energy and angular momentum."""

from functools import cache

import numpy as np

from softway.verify.case import Outcome, sheet
from softway.verify.scenes.spinning import Spin, pendulum

STEP = 0.0125
"""Slab [s]; the step control halves longer ones, whose momentum is known to the rounding of the strain only."""


@cache
def swing(turns: float) -> Spin:
    """So many turns."""
    d = sheet("D05")["definition"]
    return pendulum(d["length"], d["stiffness"], d["mass"], d["speed"], step=STEP, turns=turns)


def quantities(spin: Spin) -> dict[str, float]:
    """Those of the case."""
    return {
        "energy drift 10 rev": spin.drift("energy"),
        "period": spin.period,
        "length change": float(np.abs(spin.length / sheet("D05")["definition"]["length"] - 1.0).max()),
    }


def compute() -> Outcome:
    """Ten turns."""
    return Outcome(values=quantities(swing(10.0)))
