"""A05: struck bar of two elements with a stop and the rule that stops the node."""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.exact import semidiscrete as discrete
from softway.apps.verify.scenes import bars
from softway.record.view.plots.curves import Curve, Panel

GAP = 0.2


@cache
def struck(
    step: float, until: float = 10.0, mass: sw.bodies.Consistent | sw.bodies.Lumped = sw.bodies.Consistent()
) -> bars.Record:
    """March with the gap 0.2."""
    return bars.struck(2, sw.contact.Impulse(), gap=GAP, step=step, until=until, mass=mass)


def compute() -> Outcome:
    """Compute with h = 0.01; first impact times with h = 0.0002 (consistent mass) and 0.005 (lumped mass)."""
    march = struck(0.01)
    found = {
        "first impact time consistent gap .2": struck(2e-4, until=0.24).first("touch"),
        "first impact time lumped gap .2": struck(0.005, until=0.24, mass=sw.bodies.Lumped()).first("touch"),
        "all event times to t=10": march.instants.tolist(),
        "energy after last event": float(march.energy[-1]),
    }
    return Outcome(values=found, panels=(_panel(march),))


def _panel(march: bars.Record) -> Panel:
    motion = discrete.solve(discrete.bar(2, fixed=True), np.zeros(2), np.array([0.0, 1.0]), gap=GAP, until=10.0)
    t = np.linspace(0.0, 10.0, 401)
    curves = (
        Curve(x=march.times, y=march.displacement[:, 2], label="tip"),
        Curve(x=march.instants, y=np.full(len(march.instants), GAP), kind="dots", label="touches, releases"),
        Curve(x=t, y=[motion.at(x)[0][-1] for x in t], kind="exact", label="modes"),
    )
    return Panel(title="Stop at 0.2, h = 0.01", x="t c / L", y="displacement", curves=curves)
