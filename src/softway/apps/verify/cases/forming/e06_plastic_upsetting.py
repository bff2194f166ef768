"""E06: upsetting of a plastic cylinder with little Coulomb friction. E = 2000 times the yield stress; 10 x 6 cells."""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.scenes.forming import Press

MU = 0.05


@cache
def pressed(height: float) -> Press:
    """Press half of a cylinder of radius 1 by 1 percent of its height."""
    return Press(
        material=sw.J2(E=2000.0, nu=0.3, yield_stress=1.0),
        outer=1.0,
        height=0.5 * height,
        friction=sw.Coulomb(mu=MU),
        cells=(10, 6),
        stroke=0.01,
        slabs=10,
    )


def mean_pressure(height: float) -> float:
    """Final mean pressure relative to the yield stress."""
    press = pressed(height)
    radius = 0.5 * (press.radius("outer", "middle") + press.radius("outer", "platen"))
    return float(press.force[-1]) / (np.pi * radius**2)


def compute() -> Outcome:
    """Compute a cylinder as high as its radius."""
    return Outcome(values={"p_mean R/H=1": mean_pressure(1.0)})
