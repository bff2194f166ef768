"""A06: the struck bar as a continuum, with a stop: 100 and 200 elements."""

from functools import cache

import numpy as np

import softway as sw
from softway.record.view_curves import Curve, Panel
from softway.verify.case import Outcome
from softway.verify.exact import bar as waves
from softway.verify.scenes import bars

HAT = ((0.0, 0.5, 1.0, 0.0), (0.5, 1.0, 0.0, 0.0))
STOPPED = waves.Bar(velocity=HAT, gap=0.2, far="fixed")


def departure(march: bars.Record, gap: float) -> float:
    """First instant after the first touch at which the tip is further from the stop than a thousandth of the gap."""
    away = (gap - march.displacement[:, -1]) > 1e-3 * gap
    return float(march.times[np.flatnonzero(away & (march.times > march.first("touch")))[0]])


@cache
def stopped(cells: int, until: float) -> bars.Record:
    """The bar with its stop.

    The tip starts as the peak of a hat and rests without force at the stop: its inertia is kept as near as can be.
    """
    return bars.struck(cells, sw.Energy(spread=1), gap=0.2, velocity=bars.HAT, until=until)


def compute() -> Outcome:
    """The exact force is zero from 0.5 on, though the tip stays at the stop until 1.5: the release of the case is the
    departure, measured where the tip has gone a thousandth of the gap.
    """
    coarse, fine = stopped(100, 2.0), stopped(200, 10.0)
    exact = waves.solve(STOPPED, 10.5)
    found = {
        "1st contact time": coarse.first("touch"),
        "1st release time": departure(coarse, 0.2),
        "2nd contact time": fine.contacts(apart=1.0)[1][0],
        "L2(0,10) error u_tip": fine.norm(fine.displacement[:, -1] - exact.tip(fine.times)),
    }
    force = np.array([exact.force(t) for t in fine.middles])
    panels = (
        Panel(
            title="Tip, 200 elements",
            x="t c / L",
            y="displacement",
            curves=(
                Curve(x=fine.times, y=fine.displacement[:, -1], label="softway"),
                Curve(x=fine.times, y=exact.tip(fine.times), kind="exact", label="characteristics"),
            ),
        ),
        Panel(
            title="Force of the stop",
            x="t c / L",
            y="force / (rho c v A)",
            curves=(
                Curve(x=fine.times, y=fine.force, kind="steps", label="softway"),
                Curve(x=fine.middles, y=force, kind="exact", label="characteristics"),
            ),
        ),
    )
    return Outcome(values=found, panels=panels)
