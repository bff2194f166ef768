"""F07: a block rocks from corner to corner on a rough floor (Housner)."""

from functools import cache

import numpy as np

from softway.apps.verify.case import Outcome
from softway.mechanisms import Mechanism, MechanismStep, PlaneStop, Rigid, march
from softway.record.view.plots.curves import Curve, Panel

HALF = (0.1, 0.3)
"""Half width and half height [m]."""
STEP = 0.002
"""Length of a slab [s]."""


def tilted_block(friction: float = 10.0) -> Mechanism:
    """Block of 1 kg on its right corner, tilted by half of the angle at which it would fall over."""
    tilt = -0.5 * float(np.arctan2(*HALF))
    turn = np.array([[np.cos(tilt), -np.sin(tilt)], [np.sin(tilt), np.cos(tilt)]])
    centre = -turn @ np.array([HALF[0], -HALF[1]])
    corners = {
        side: centre + turn @ np.array([sign * HALF[0], -HALF[1]]) for side, sign in (("left", -1), ("right", 1))
    }
    stops = {
        side: PlaneStop(
            between=("ground", "block"),
            point=(float(at[0]), 0.0 if side == "right" else float(at[1])),
            plane=(0.0, 0.0),
            normal=(0.0, 1.0),
            friction=friction,
        )
        for side, at in corners.items()
    }
    block = Rigid(mass=1.0, centre=(float(centre[0]), float(centre[1])), inertia=(HALF[0] ** 2 + HALF[1] ** 2) / 3.0)
    return Mechanism(bodies={"block": block}, stops=stops, gravity=(0.0, -9.81))


@cache
def rocked() -> tuple[MechanismStep, ...]:
    """Steps of 1.3 s."""
    return tuple(march(tilted_block(), until=1.3, step=STEP))


def compute() -> Outcome:
    """Compute the case."""
    steps = rocked()
    hits = [event for step in steps for event in step.events if event.kind == "touch"]
    speeds = [-event.velocity_before for event in hits]
    turned = np.array([float(np.arctan2(*step.bodies["block"].rotation[:, 0][::-1])) for step in steps])
    scale = 9.81 * float(np.hypot(*HALF))
    found = {
        "omega ratio": [b / a for a, b in zip(speeds[:3], speeds[1:4], strict=True)],
        "impact times 1..4": [event.time for event in hits[:4]],
        "energy, relative to m g R": max(abs(step.energy_error) for step in steps) / scale,
    }
    curve = Curve(x=np.array([step.time for step in steps]), y=np.degrees(turned), label="h = 2 ms")
    return Outcome(values=found, panels=(Panel(title="Block", x="t [s]", y="rotation [deg]", curves=(curve,)),))
