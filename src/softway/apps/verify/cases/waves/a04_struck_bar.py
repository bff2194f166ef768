"""A04: fixed bar of two elements struck at its tip, without a stop."""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.exact import semidiscrete as discrete
from softway.apps.verify.scenes import bars
from softway.model.time_weight import TimeWeight
from softway.record.view.plots.curves import Curve, Panel


@cache
def free(
    step: float, weight: TimeWeight, mass: sw.bodies.Consistent | sw.bodies.Lumped = sw.bodies.Consistent()
) -> bars.Record:
    """March with a stop out of reach."""
    return bars.struck(2, sw.contact.Impulse(), step=step, weight=weight, mass=mass)


def compute() -> Outcome:
    """Compute with h = 0.02; displacements with the weight at the midpoint, energy with the default weight."""
    consistent, lumped = (free(0.02, bars.MIDDLE, m) for m in (sw.bodies.Consistent(), sw.bodies.Lumped()))
    default = free(0.02, sw.model.EndPeaks())
    found = {
        "u_tip(10) consistent": float(consistent.displacement[-1, 2]),
        "u_mid(10) consistent": float(consistent.displacement[-1, 1]),
        "u_tip(10) lumped": float(lumped.displacement[-1, 2]),
        "energy drift": float(np.abs(default.energy - default.energy[0]).max()),
    }
    return Outcome(values=found, panels=(_panel(consistent),))


def _panel(march: bars.Record) -> Panel:
    motion = discrete.solve(discrete.bar(2, fixed=True), np.zeros(2), np.array([0.0, 1.0]), gap=np.inf, until=10.0)
    t = np.linspace(0.0, 10.0, 401)
    exact = np.array([motion.at(x)[0] for x in t])
    ours = [Curve(x=march.times, y=march.displacement[:, k], label=name) for k, name in ((1, "middle"), (2, "tip"))]
    modes = [Curve(x=t, y=u, kind="exact", label="modes" if k == 0 else "") for k, u in enumerate(exact.T)]
    return Panel(title="Consistent mass, h = 0.02", x="t c / L", y="displacement", curves=(*ours, *modes))
