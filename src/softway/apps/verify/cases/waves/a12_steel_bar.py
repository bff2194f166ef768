"""A12: steel bar thrown at a wall, 100 elements, SI units."""

import softway as sw
from softway.apps.verify.case import Outcome, sheet
from softway.apps.verify.scenes import bars
from softway.record.view.plots.curves import Curve, Panel


def compute() -> Outcome:
    """Compute the case; the mean force is the impulse divided by the duration of contact."""
    d = sheet("A12")["definition"]
    march = bars.thrown(
        100,
        sw.contact.Energy(),
        gap=d["gap"],
        until=1e-3,
        material=sw.LinearElastic(E=d["youngs"]),
        density=d["density"],
        area=d["area"],
        speed=d["speed"],
    )
    ((start, end),) = march.contacts(apart=1e-4)
    found = {"t_contact": start, "t_release": end, "mean force": march.impulse / (end - start)}
    level = sheet("A12")["qoi"][2]["value"]
    curves = (
        Curve(x=1e3 * march.times, y=march.force, kind="steps", label="softway"),
        Curve(x=[1e3 * start, 1e3 * end], y=[level, level], kind="exact", label="rho c v A"),
    )
    return Outcome(values=found, panels=(Panel(title="Force of the wall", x="t [ms]", y="force [N]", curves=curves),))
