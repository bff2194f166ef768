"""Comparison of the thrown bar with classic schemes: 2 and 20 elements, default rule, automatic step."""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Beside, Outcome, sheet
from softway.apps.verify.exact.thrown import Thrown
from softway.apps.verify.scenes import bars
from softway.record.view.plots.curves import Curve, Panel

GAP = 0.25
EXACT = Thrown(gap=GAP)


@cache
def thrown(cells: int) -> bars.Record:
    """March the bar with the gap 0.25."""
    return bars.thrown(cells, sw.contact.Energy(), gap=GAP)


def compute() -> Outcome:
    """Compute the case with 20 elements; the comparison table also has 2 elements."""
    march = thrown(20)
    found = {
        "touch": march.first("touch"),
        "release": march.first("release"),
        "force rms error over contact": _rms(march),
        "force rms error over contact, without two element transits at its ends": march.force_error(0.35, 2.15, 1.0),
        "energy": float(march.energy[-1]) / EXACT.energy,
        "penetration": max(0.0, -float(march.gap.min())),
    }
    return Outcome(values=found, panels=(_panel(march),), tables=(_table(),))


def _rms(march: bars.Record) -> float:
    return march.force_error(EXACT.touch, EXACT.release, EXACT.force)


def _table() -> Beside:
    known = sheet("classic")["reference"]
    ours = [(-thrown(n).momentum[-1], thrown(n).energy[-1] / EXACT.energy, _rms(thrown(n))) for n in (2, 20)]
    mine = ("softway", *("{:.2f} / {:.2f} / {:.2f}".format(*numbers) for numbers in ours))
    return Beside(
        title=known["caption"],
        heads=tuple(known["heads"]),
        rows=(*(tuple(row) for row in known["others"]), mine),
        note=known["note"],
    )


def _panel(march: bars.Record) -> Panel:
    t = np.linspace(0.0, 4.0, 1601)
    curves = (
        Curve(x=march.times, y=march.force, kind="steps", label="20 elements"),
        Curve(x=thrown(2).times, y=thrown(2).force, kind="steps", label="2 elements"),
        Curve(x=t, y=EXACT.push(t), kind="exact", label="d'Alembert"),
    )
    return Panel(title="Force of the wall", x="t c / L", y="force / (rho c v A)", curves=curves)
