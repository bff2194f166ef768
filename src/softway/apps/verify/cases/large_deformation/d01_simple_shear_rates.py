"""D01: simple shear of a hypoelastic cell with four objective rates. Shear modulus 1, nu = 0.3."""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.exact import shear
from softway.apps.verify.scenes.driving import RATES, sheared, square
from softway.arrays import Array
from softway.record.view.plots.curves import Curve, Panel

NAMES = {"jaumann": "Jaumann", "green_naghdi": "Green-Naghdi", "log": "logarithmic", "truesdell": "Truesdell"}
SLABS = 200


@cache
def stresses(rate: str, gamma: float, slabs: int = SLABS) -> Array:
    """Stress (slabs + 1, 3, 3) of one element sheared up to ``gamma``."""
    memories = square(sw.Hypoelastic(E=2.6, nu=0.3, rate=RATES[rate])).history(sheared(gamma, slabs))
    return np.array([m.stress.mean(axis=0) for m in memories])


def compute() -> Outcome:
    """Compute the stresses at gamma = 5."""
    ends = {name: stresses(rate, 5.0)[-1] for rate, name in NAMES.items()}
    found = {f"{name} s11, s12 at gamma=5": [s[0, 0], s[0, 1]] for name, s in ends.items()}
    found["s33"] = max(abs(s[2, 2]) for s in ends.values())
    gamma = np.linspace(0.0, 5.0, SLABS + 1)
    ours = [Curve(x=gamma, y=stresses(rate, 5.0)[:, 0, 1], label=name) for rate, name in NAMES.items()]
    exact = [Curve(x=gamma, y=shear.elastic(rate, gamma)[1], kind="exact") for rate in NAMES]
    panel = Panel(title="Shear stress of four rates", x="gamma", y="s12 / G", curves=(*ours, *exact))
    return Outcome(values=found, panels=(panel,))
