"""A06: struck bar as a continuum, with a stop: 100 and 200 elements."""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.exact import bar as waves
from softway.apps.verify.scenes import bars
from softway.record.view.plots.curves import Curve, Panel

HAT = ((0.0, 0.5, 1.0, 0.0), (0.5, 1.0, 0.0, 0.0))
STOPPED = waves.Bar(velocity=HAT, gap=0.2, far="fixed")


def departure(march: bars.Record, gap: float) -> float:
    """First time after the first touch at which the tip is further from the stop than 1/1000 of the gap."""
    away = (gap - march.displacement[:, -1]) > 1e-3 * gap
    return float(march.times[np.flatnonzero(away & (march.times > march.first("touch")))[0]])


@cache
def stopped(cells: int, until: float) -> bars.Record:
    """March the bar with its stop.

    The tip starts at the peak of the hat and rests without force at the stop. Its mass moves to the nearest nodes only.
    """
    return bars.struck(cells, sw.contact.Energy(spread=1), gap=0.2, velocity=bars.HAT, until=until)


def compute() -> Outcome:
    """Compute the case. Its release is the departure of the tip, measured at 1/1000 of the gap.

    The exact force is zero from t = 0.5 on, although the tip stays at the stop until 1.5.
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
