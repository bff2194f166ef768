"""A02: elastic bar thrown at a rigid wall: 20, 50 and 100 elements, default rule, automatic step."""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.exact.thrown import Thrown
from softway.apps.verify.scenes import bars
from softway.record.view.plots.curves import Curve, Panel

EXACT = Thrown(gap=0.3)


@cache
def thrown(cells: int) -> bars.Record:
    """March the bar with the gap 0.3."""
    return bars.thrown(cells, sw.contact.Energy())


def compute() -> Outcome:
    """Compute each quantity on the mesh given in the case."""
    middle, fine = thrown(50), thrown(100)
    ((start, end),) = middle.contacts(apart=0.5)
    found = {
        "contact start (gap .3)": thrown(20).first("touch"),
        "contact duration": end - start,
        "impulse": middle.impulse,
        "rms error of force/(rho c v0) over contact, excluding 2 el transit at ends": fine.force_error(0.32, 2.28, 1.0),
        "overshoot of contact force": float(fine.force.max()) - 1.0,
        "COM rebound velocity": float(middle.momentum[-1]),
        "total energy after release": float(fine.energy[-1]),
        "penetration": max(0.0, *(-float(thrown(n).gap.min()) for n in (20, 50, 100))),
    }
    return Outcome(values=found, panels=_panels(fine))


def _panels(march: bars.Record) -> tuple[Panel, ...]:
    t = np.linspace(0.0, march.times[-1], 801)
    return (
        Panel(
            title="Force of the wall, 100 elements",
            x="t c / L",
            y="force / (rho c v A)",
            curves=(
                Curve(x=march.times, y=march.force, kind="steps", label="softway"),
                Curve(x=t, y=EXACT.push(t), kind="exact", label="d'Alembert"),
            ),
        ),
        Panel(
            title="Ends of the bar",
            x="t c / L",
            y="displacement",
            curves=(
                Curve(x=march.times, y=march.displacement[:, -1], label="tip"),
                Curve(x=march.times, y=march.displacement[:, 0], label="rear"),
                Curve(x=t, y=EXACT.tip(t), kind="exact", label="d'Alembert"),
                Curve(x=t, y=EXACT.rear(t), kind="exact"),
            ),
        ),
    )
