"""C06: a ball that is thrown along a rough floor without spin slides until it rolls.

It hops from facet to facet: the velocities stand while it flies.  It rolls from where its slip has come down to one
hundredth of the speed.
"""

from functools import cache

import numpy as np

import softway as sw
from softway.record.view_curves import Curve, Panel
from softway.verify.case import Outcome
from softway.verify.scenes.rolling import Course, rolled

RADIUS, SPEED, MU = 0.1, 5.0, 0.3
ROLLS = 0.01
"""Slip over the speed at the start at which it rolls."""


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
    slip = np.abs(course.velocity - RADIUS * course.spin)
    late = np.flatnonzero(slip > ROLLS * SPEED)[-1] + 1
    return float(course.time[late]), float(course.velocity[late:].mean())


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
