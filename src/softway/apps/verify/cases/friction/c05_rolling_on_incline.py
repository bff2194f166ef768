"""C05: round bodies roll or slip down an incline from rest.

The accelerations of elastic bodies are averaged over many facets; rigid bodies are round.
"""

from collections.abc import Mapping
from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.cases.friction.rigid_bodies import Rolling, rolled_down
from softway.apps.verify.scenes.rolling import Course, rolled
from softway.meshes.generators.recipes import MeshSource, Ring
from softway.record.view.plots.curves import Curve, Panel

RADIUS = 0.1
SOURCES: Mapping[str, MeshSource] = {
    "ball": sw.meshes.Ball(radius=RADIUS, cells=16),
    "cylinder": sw.meshes.Disc(radius=RADIUS, cells=16),
    "ring": Ring(inner=0.09, outer=RADIUS, cells=(2, 64)),
}

BETA = {"ball": 0.4, "cylinder": 0.5, "ring": 1.0}
"""Moment of inertia of round bodies over m r^2; the ring is thin."""


@cache
def gone(body: str, slope: float, mu: float, until: float, step: float) -> Course:
    """March a body on an incline with a ``slope`` [rad] until a time [s]."""
    return rolled(source=SOURCES[body], radius=RADIUS, slope=slope, mu=mu, until=until, step=step)


def acceleration(course: Course) -> float:
    """Acceleration from the distance travelled [m/s^2], over the last fifth of the time, where facets average out."""
    late = course.time > 0.8 * course.time[-1]
    return float(np.mean(2.0 * course.place[late] / course.time[late] ** 2))


def torque(course: Course) -> float:
    """Friction torque / (mass radius) [m/s^2]: ``beta r alpha``."""
    return float(np.polyfit(course.time, course.spin, 1)[0]) * RADIUS * course.beta


def gone_rigid(body: str, slope: float, mu: float, until: float, step: float) -> Rolling:
    """March a rigid body on an incline until a time [s]."""
    return rolled_down(radius=RADIUS, beta=BETA[body], slope=slope, mu=mu, speed=0.0, until=until, step=step)


def compute() -> Outcome:
    """Compute the four bodies, elastic and rigid."""
    asked = {
        "cylinder rolls": ("cylinder", 0.4, 0.5, 0.4, 1e-3),
        "ball rolls": ("ball", 0.4, 0.5, 0.4, 2e-3),
        "ball slips": ("ball", 0.8, 0.1, 0.2, 2e-3),
        "ring slips": ("ring", 0.6, 0.15, 0.4, 1e-3),
    }
    courses = {name: gone(*words) for name, words in asked.items()}
    rigid = {name: gone_rigid(*words) for name, words in asked.items()}
    found = {f"acceleration, {name}": acceleration(course) for name, course in courses.items()}
    found["beta times r alpha, ring slips"] = torque(courses["ring slips"])
    creep = [c.creep[~c.slides].max(initial=0.0) for name, c in courses.items() if name.endswith("rolls")]
    found["slip velocity where they roll"] = float(max(creep))
    found |= {f"acceleration, {name}, rigid": float(c.velocity[-1] / c.time[-1]) for name, c in rigid.items()}
    found["slip velocity where they roll, rigid"] = max(
        float(np.abs(c.slip).max()) for name, c in rigid.items() if name.endswith("rolls")
    )
    curves = tuple(Curve(x=c.time, y=c.velocity, label=name) for name, c in courses.items())
    return Outcome(values=found, panels=(Panel(title="Down the incline", x="t [s]", y="v [m/s]", curves=curves),))
