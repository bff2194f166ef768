"""A12: a steel bar thrown at a wall, 100 elements in SI units."""

import softway as sw
from softway.record.view_curves import Curve, Panel
from softway.verify.case import Outcome, sheet
from softway.verify.scenes import bars


def compute() -> Outcome:
    """Mean force: the impulse over the duration of the contact."""
    d = sheet("A12")["definition"]
    march = bars.thrown(
        100,
        sw.Energy(),
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
