"""I01: order of the contact times of a struck bar with a stop, located inside time steps (slabs)."""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.exact import semidiscrete as discrete
from softway.apps.verify.scenes import bars
from softway.arrays import Array
from softway.bodies.inertia.mass_matrix import MassRule
from softway.record.view.plots.curves import Curve, Panel

GAP, UNTIL = 0.2, 9.0
STEPS = (0.08, 0.04, 0.02, 0.01)
MASSES: dict[str, MassRule] = {"consistent": sw.bodies.Consistent(), "lumped": sw.bodies.Lumped()}
NAMES = {"1st, consistent mass": ("consistent", 0), "3rd, consistent mass": ("consistent", 2)}
NAMES |= {"1st, lumped mass": ("lumped", 0), "2nd, lumped mass": ("lumped", 1)}
"""Contacts by the names of their orders: kind of mass, and number of the touch."""


@cache
def touches(mass: str, step: float) -> tuple[float, ...]:
    """Times of the touches of the tip."""
    march = bars.struck(2, sw.contact.Impulse(), gap=GAP, step=step, until=UNTIL, mass=MASSES[mass])
    return tuple(event.time for event in march.events if event.kind == "touch")


def errors(mass: str, number: int) -> Array:
    """Errors of the time of a touch with each of ``STEPS``."""
    motion = discrete.solve(
        discrete.bar(2, fixed=True, lumped=mass == "lumped"), np.zeros(2), np.array([0.0, 1.0]), gap=GAP, until=UNTIL
    )
    exact = [event.time for event in motion.events if event.kind == "touch"][number]
    return np.array([abs(touches(mass, step)[number] - exact) for step in STEPS])


def order(error: Array) -> float:
    """Slope of the errors over the steps in logarithms, by least squares."""
    return float(np.polyfit(np.log(STEPS), np.log(error), 1)[0])


def compute() -> Outcome:
    """Compute with h = 0.08, 0.04, 0.02 and 0.01, which divide none of the times."""
    found = {name: errors(*which) for name, which in NAMES.items()}
    curves = tuple(Curve(x=STEPS, y=error, label=name) for name, error in found.items())
    panel = Panel(title="Error of the time of a touch", x="h", y="error", log="xy", curves=curves)
    return Outcome(values={f"order, {name}": order(error) for name, error in found.items()}, panels=(panel,))
