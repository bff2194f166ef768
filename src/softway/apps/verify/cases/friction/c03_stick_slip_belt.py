"""C03: stick-slip of a sprung mass on a moving belt; static friction is twice kinetic friction.

Stiff elastic block on two feet, see ``scenes/sprung.py``. Both feet carry the same part of the weight and of the spring
force, so they break away together. Beside it a rigid block.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.cases.friction.rigid_bodies import on_belt
from softway.apps.verify.scenes.sprung import Sprung
from softway.arrays import Array
from softway.record.view.plots.curves import Curve, Panel

BELT, START = 0.1, 0.03923
HEAVIER = 10.0
"""Factor on the weight of the case, and divisor of its friction: the block stays level."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Course:
    """Times and places at the ends of slabs; times at which both feet have started to slip and to stick."""

    time: Array
    place: Array
    slips: tuple[float, ...]
    sticks: tuple[float, ...]


@cache
def carried(step: float = 1e-3) -> Course:
    """March from just before the block breaks away until it has broken away again."""
    it = Sprung(dim=2, mass=1.0, stiffness=100.0, weight=HEAVIER * 9.81, touching="feet")
    law = sw.laws.StaticKinetic(mu_s=0.4 / HEAVIER, mu_k=0.2 / HEAVIER)
    steps = list(sw.march(it.scene((BELT, 0.0), (START,), law, speed=BELT), until=0.83, step=step))
    events = {kind: [e.time for s in steps for e in s.events if e.kind == kind] for kind in ("slip", "stick")}
    return Course(
        time=np.array([s.after.time for s in steps]),
        place=np.array([it.mean(s.after.displacement["b"])[0] for s in steps]),
        slips=tuple(events["slip"][1::2]),
        sticks=tuple(events["stick"][1::2]),
    )


@cache
def carried_rigid(step: float = 1e-3) -> Course:
    """March of a rigid block from rest on the belt, with the weight and the friction of the case."""
    steps = on_belt(belt=BELT, stiffness=100.0, static=0.4, kinetic=0.2, step=step)
    events = {kind: tuple(e.time for s in steps for e in s.events if e.kind == kind) for kind in ("slip", "stick")}
    return Course(
        time=np.array([s.time for s in steps]),
        place=np.array([s.bodies["b"].centre[0] for s in steps]),
        slips=events["slip"],
        sticks=events["stick"],
    )


def compute() -> Outcome:
    """Compute with slabs of 1 ms."""
    courses = {"": carried(), ", rigid": carried_rigid()}
    found = {}
    for name, course in courses.items():
        found[f"x_max{name}"] = float(course.place.max())
        found[f"time of slip{name}"] = course.sticks[0] - course.slips[0]
        found[f"period{name}"] = course.slips[1] - course.slips[0]
    # the elastic block starts just before it breaks away
    late = {"": 0.0, ", rigid": courses[""].slips[0] - courses[", rigid"].slips[0]}
    curves = tuple(
        Curve(x=course.time + late[name], y=1e3 * course.place, label=f"softway{name}")
        for name, course in courses.items()
    )
    return Outcome(values=found, panels=(Panel(title="Place of the block", x="t [s]", y="x [mm]", curves=curves),))
