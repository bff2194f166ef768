"""C03: a mass on a spring that a belt carries along sticks and slips, static friction twice the kinetic one.

A stiff block on two feet, see ``scenes/sprung.py``: both have the same share of the weight and of the spring, so that
they break away together.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

import softway as sw
from softway.record.view_curves import Curve, Panel
from softway.typing import Array
from softway.verify.case import Outcome
from softway.verify.scenes.sprung import Sprung

BELT, START = 0.1, 0.03923
HEAVIER = 10.0
"""Times the weight of the case, with as many times less friction: the block stays level."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Course:
    """Times and places at the ends of slabs; instants at which both feet slip, and stick."""

    time: Array
    place: Array
    slips: tuple[float, ...]
    sticks: tuple[float, ...]


@cache
def carried(step: float = 1e-3) -> Course:
    """From just before the block breaks away until it has done so again."""
    it = Sprung(dim=2, mass=1.0, stiffness=100.0, weight=HEAVIER * 9.81, touching="feet")
    law = sw.StaticKinetic(mu_s=0.4 / HEAVIER, mu_k=0.2 / HEAVIER)
    steps = list(sw.march(it.scene((BELT, 0.0), (START,), law, speed=BELT), until=0.83, step=step))
    events = {kind: [e.time for s in steps for e in s.events if e.kind == kind] for kind in ("slip", "stick")}
    return Course(
        time=np.array([s.after.time for s in steps]),
        place=np.array([it.mean(s.after.displacement["b"])[0] for s in steps]),
        slips=tuple(events["slip"][1::2]),
        sticks=tuple(events["stick"][1::2]),
    )


def compute() -> Outcome:
    """Slabs of a millisecond."""
    course = carried()
    found = {
        "x_max": float(course.place.max()),
        "time of slip": course.sticks[0] - course.slips[0],
        "period": course.slips[1] - course.slips[0],
    }
    curve = Curve(x=course.time, y=1e3 * course.place, label="softway")
    return Outcome(values=found, panels=(Panel(title="Place of the block", x="t [s]", y="x [mm]", curves=(curve,)),))
