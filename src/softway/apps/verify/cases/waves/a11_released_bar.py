"""A11: bar released from uniform strain above a stop, three periods: 100 and 200 elements."""

from functools import cache

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.exact import bar as waves
from softway.apps.verify.scenes import bars
from softway.record.view.plots.curves import Curve, Panel

BAR = waves.Bar(strain=((0.0, 1.0, 0.5, 0.5),), tip=-0.5, gap=0.0, far="fixed")


@cache
def pulled(cells: int) -> bars.Record:
    """March the bar."""
    return bars.pulled(cells, sw.contact.Energy())


def compute() -> Outcome:
    """Compute event times with 100 elements, and the tip with 200."""
    coarse, fine = pulled(100).contacts(apart=0.5), pulled(200)
    exact = waves.solve(BAR, 9.5)
    found = {
        "impact times": [start for start, _ in coarse],
        "release times": [end for _, end in coarse],
        "L2 error of u_tip over [0,9]": fine.norm(fine.displacement[:, 0] + exact.tip(fine.times)),
    }
    curves = (
        Curve(x=fine.times, y=fine.displacement[:, 0], label="softway"),
        Curve(x=fine.times, y=-exact.tip(fine.times), kind="exact", label="characteristics"),
    )
    return Outcome(
        values=found, panels=(Panel(title="Tip, 200 elements", x="t c / L", y="displacement", curves=curves),)
    )
