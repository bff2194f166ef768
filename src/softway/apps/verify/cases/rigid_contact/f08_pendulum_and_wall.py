"""F08: a pendulum hits a wall again and again."""

from functools import cache

import numpy as np

from softway.apps.verify.case import Outcome
from softway.arrays import Array
from softway.mechanisms import Mechanism, PlaneStop, Rigid, Rod, march
from softway.record.view.plots.curves import Curve, Panel

FIRST = 0.4822081787148347
"""First touch [s]."""


@cache
def hit(h: float) -> tuple[Array, Array, Array]:
    """Times and angles, and the touches (n, 2): instant and speed before."""
    start, (x, y) = _at(60.0), _at(10.0)
    wall = PlaneStop(between=("ground", "mass"), point=start, plane=(0.0, 0.0), normal=(-y, x), restitution=0.7)
    rod = Rod(between=("ground", "mass"), ends=((0.0, 0.0), start))
    mechanism = Mechanism(
        bodies={"mass": Rigid(mass=1.0, centre=start)}, joints={"rod": rod}, stops={"wall": wall}, gravity=(0.0, -9.81)
    )
    steps = list(march(mechanism, until=3.6, step=h))
    touches = [(event.time, -event.velocity_before) for step in steps for event in step.events]
    angles = [float(np.arctan2(s.bodies["mass"].centre[0], -s.bodies["mass"].centre[1])) for s in steps]
    return np.array([s.time for s in steps]), np.array(angles), np.array(touches)


def _at(degrees: float) -> tuple[float, float]:
    angle = np.deg2rad(degrees)
    return float(np.sin(angle)), float(-np.cos(angle))


def compute() -> Outcome:
    """Compute the case."""
    time, angle, touches = hit(1.5e-3)
    finer = hit(0.75e-3)[2]
    found = {
        "touches 1 to 5": touches[:5, 0].tolist(),
        "order": float(np.log2((touches[0, 0] - FIRST) / (finer[0, 0] - FIRST))),
        "speeds before them": touches[:5, 1].tolist(),
    }
    curve = Curve(x=time, y=np.rad2deg(angle), label="h = 1.5 ms")
    return Outcome(values=found, panels=(Panel(title="Pendulum", x="t [s]", y="angle [deg]", curves=(curve,)),))
