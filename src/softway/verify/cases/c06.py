"""C06: a ball that is thrown along a rough floor without spin slides until it rolls.

It hops from facet to facet: the velocities stand while it flies, and change in jumps.  The time until it rolls is where
the line through the slip, from nine tenths of the first one down to one tenth, comes to zero.
"""

from functools import cache

import numpy as np

import softway as sw
from softway.record.view_curves import Curve, Panel
from softway.verify.case import Outcome
from softway.verify.scenes.rolling import Course, rolled

RADIUS, SPEED, MU = 0.1, 5.0, 0.3


@cache
def thrown(until: float = 0.56, step: float = 2e-3) -> Course:
    """The ball until a time [s]."""
    return rolled(
        source=sw.Ball(radius=RADIUS, cells=16),
        radius=RADIUS,
        slope=0.0,
        mu=MU,
        until=until,
        step=step,
        speed=SPEED,
        youngs=1e7,
    )


def rolls(course: Course) -> tuple[float, float]:
    """The time from which the ball rolls [s], and its mean velocity from then on [m/s]."""
    slip = (course.velocity - RADIUS * course.spin) / SPEED
    sliding = (slip < 0.9) & (slip > 0.1)
    slope, first = np.polyfit(course.time[sliding], slip[sliding], 1)
    instant = float(-first / slope)
    return instant, float(course.velocity[course.time > instant].mean())


def compute() -> Outcome:
    """Slabs of two milliseconds."""
    course = thrown()
    instant, velocity = rolls(course)
    curves = (
        Curve(x=course.time, y=course.velocity, label="velocity"),
        Curve(x=course.time, y=RADIUS * course.spin, label="radius times spin"),
    )
    panel = Panel(title="A ball slides, then rolls", x="t [s]", y="[m/s]", curves=curves)
    return Outcome(values={"time until it rolls": instant, "velocity when it rolls": velocity}, panels=(panel,))
