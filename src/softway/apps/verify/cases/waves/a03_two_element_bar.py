"""A03: thrown bar of two elements, exact in time, with the rule that stops the node."""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome, sheet
from softway.apps.verify.exact import semidiscrete as discrete
from softway.apps.verify.scenes import bars
from softway.record.view.plots.curves import Curve, Panel


@cache
def at_the_wall(
    rule: sw.contact.Impulse | sw.contact.Paper | sw.contact.Energy,
    step: float,
    mass: sw.bodies.Consistent | sw.bodies.Lumped = sw.bodies.Consistent(),
    until: float = 3.0,
    weight: sw.model.EndPeaks | sw.model.Collocation = sw.model.EndPeaks(),
) -> bars.Record:
    """March two elements that are at the wall at t = 0."""
    return bars.thrown(2, rule, gap=0.0, until=until, step=step, mass=mass, weight=weight)


def compute() -> Outcome:
    """Compute with the impulse rule: releases extrapolated from h = 0.004 and 0.002, table with fourth-order weight."""
    times = sheet("A03")["definition"]["times"]
    march = at_the_wall(sw.contact.Impulse(), 0.01, until=times[-1], weight=bars.FOURTH)
    found = {
        "release time, ne=2 consistent": _release(sw.bodies.Consistent(), 1.9),
        "release time, ne=2 lumped": _release(sw.bodies.Lumped(), 2.2),
        "u(t) table csv": march.at(times).tolist(),
    }
    return Outcome(values=found, panels=(_panel(march),))


def _release(mass: sw.bodies.Consistent | sw.bodies.Lumped, until: float) -> float:
    coarse, fine = (at_the_wall(sw.contact.Impulse(), h, mass, until).first("release") for h in (0.004, 0.002))
    return (4.0 * fine - coarse) / 3.0


def _panel(march: bars.Record) -> Panel:
    motion = discrete.solve(discrete.bar(2), np.zeros(3), np.ones(3), gap=0.0, until=7.0)
    t = np.linspace(0.0, march.times[-1], 261)
    exact = np.array([motion.at(x)[0] for x in t])
    names = ("rear", "middle", "tip")
    ours = [Curve(x=march.times, y=u, label=name) for name, u in zip(names, march.displacement.T, strict=True)]
    modes = [Curve(x=t, y=u, kind="exact", label="modes" if k == 0 else "") for k, u in enumerate(exact.T)]
    return Panel(title="Two elements, h = 0.01", x="t c / L", y="displacement", curves=(*ours, *modes))
