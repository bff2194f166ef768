"""F03: loops of four equal bars turn through the positions where all of them lie in a line."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from softway.apps.verify.case import Outcome
from softway.apps.verify.cases.mechanisms import linkages
from softway.arrays import Array
from softway.mechanisms import march
from softway.record.view.plots.curves import Curve, Panel


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Turned:
    """Times, angles from the upright, and the greatest errors of energy [J], joints [m], and equal heights [m]."""

    time: Array
    angle: Array
    energy: float
    joints: float
    tops: float


@cache
def turned(loops: int, h: float) -> Turned:
    """March for 10 s."""
    time, angle, energy, joints, tops = [], [], 0.0, 0.0, 0.0
    steps = march(linkages.four_bars(loops), until=10.0, step=h, every=10)
    for step, total in linkages.angles(steps, "crank0"):
        time.append(step.time)
        angle.append(-total)
        energy, joints = max(energy, abs(step.energy_error)), max(joints, step.joints)
        cranks = np.array([step.bodies[f"crank{k}"].centre for k in range(loops + 1)])
        tops = max(tops, float(np.abs(np.diff(cranks, axis=0) - [1.0, 0.0]).max()))
    return Turned(time=np.array(time), angle=np.array(angle), energy=energy, joints=joints, tops=tops)


def compute() -> Outcome:
    """Compute the case."""
    few, many = turned(2, 1e-3), turned(40, 2e-3)
    found = {
        "q(10), N=2": float(few.angle[-1]),
        "q(10), N=40": float(many.angle[-1]),
        "remains a parallelogram: error of the tops [m]": max(few.tops, many.tops),
        "energy drift": max(few.energy, many.energy),
        "joints, N=40 [m]": many.joints,
    }
    curves = tuple(Curve(x=m.time, y=m.angle, label=f"{n} loops") for m, n in ((few, 2), (many, 40)))
    return Outcome(values=found, panels=(Panel(title="Cranks", x="t [s]", y="angle [rad]", curves=curves),))
