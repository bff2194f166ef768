"""F06: a ball bounces infinitely often in a finite time, and rests."""

from functools import cache

import numpy as np

from softway.apps.verify.case import Outcome
from softway.mechanisms import Mechanism, MechanismStep, PlaneStop, Rigid, march
from softway.record.view.plots.curves import Curve, Panel


@cache
def bounced() -> tuple[MechanismStep, ...]:
    """Steps of 6 s."""
    floor = PlaneStop(
        between=("ground", "ball"), point=(0.0, 1.0), plane=(0.0, 0.0), normal=(0.0, 1.0), restitution=0.8
    )
    ball = Rigid(mass=1.0, centre=(0.0, 1.0))
    mechanism = Mechanism(bodies={"ball": ball}, stops={"floor": floor}, gravity=(0.0, -9.81))
    return tuple(march(mechanism, until=6.0, step=0.01))


def compute() -> Outcome:
    """Compute the case."""
    steps = bounced()
    events = [event for step in steps for event in step.events]
    heights = np.array([float(step.bodies["ball"].centre[1]) for step in steps])
    found = {
        "touches 1 to 12": [event.time for event in events[:12]],
        "end of the touches": next(event.time for event in events if event.kind == "rest"),
        "height after it [m]": float(np.abs(heights[-100:]).max()),
        "depth below the floor [m]": float(max(0.0, -heights.min())),
    }
    curve = Curve(x=np.array([step.time for step in steps]), y=heights, label="h = 10 ms")
    return Outcome(values=found, panels=(Panel(title="Ball", x="t [s]", y="height [m]", curves=(curve,)),))
