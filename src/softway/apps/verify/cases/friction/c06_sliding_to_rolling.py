"""C06: ball thrown along a rough floor without spin slides until it rolls.

The elastic ball hops from facet to facet: its velocities are constant in flight and change in jumps. The time until it
rolls is the zero of the line fitted to the slip between 9/10 and 1/10 of its initial value. The rigid ball is round.
"""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.cases.friction.rigid_bodies import Rolling, rolled_down
from softway.apps.verify.scenes.rolling import Course, rolled
from softway.record.view.plots.curves import Curve, Panel

RADIUS, SPEED, MU = 0.1, 5.0, 0.3


@cache
def thrown(until: float = 0.56, step: float = 2e-3) -> Course:
    """March the ball until a time [s]."""
    return rolled(
        source=sw.meshes.Ball(radius=RADIUS, cells=16),
        radius=RADIUS,
        slope=0.0,
        mu=MU,
        until=until,
        step=step,
        speed=SPEED,
        youngs=1e7,
    )


@cache
def thrown_rigid(until: float = 0.56, step: float = 2e-3) -> Rolling:
    """March the rigid ball until a time [s]."""
    return rolled_down(radius=RADIUS, beta=0.4, slope=0.0, mu=MU, speed=SPEED, until=until, step=step)


def rolls(course: Course | Rolling) -> tuple[float, float]:
    """Time from which the ball rolls [s], and its mean velocity after it [m/s]."""
    slip = (course.velocity - RADIUS * course.spin) / SPEED
    sliding = (slip < 0.9) & (slip > 0.1)
    slope, first = np.polyfit(course.time[sliding], slip[sliding], 1)
    instant = float(-first / slope)
    return instant, float(course.velocity[course.time > instant].mean())


def compute() -> Outcome:
    """Compute with slabs of 2 ms."""
    course = thrown()
    found = {}
    for name, one in (("", course), (", rigid", thrown_rigid())):
        found[f"time until it rolls{name}"], found[f"velocity when it rolls{name}"] = rolls(one)
    curves = (
        Curve(x=course.time, y=course.velocity, label="velocity"),
        Curve(x=course.time, y=RADIUS * course.spin, label="radius times spin"),
    )
    panel = Panel(title="A ball slides, then rolls", x="t [s]", y="[m/s]", curves=curves)
    return Outcome(values=found, panels=(panel,))
