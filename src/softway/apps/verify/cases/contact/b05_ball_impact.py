"""B05: steel ball, as a body of revolution, hits a rigid plane at 1 m/s; quasi-static Hertz impact.

A ball is slightly stiffer than a half-space (case B04), so the remaining differences decrease with the contact size.
"""

from dataclasses import dataclass
from functools import cache
from math import pi

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.exact.contact import Impact, contact_modulus
from softway.arrays import Array
from softway.meshes.generators.recipes import GradedDisc
from softway.record.view.plots.curves import Curve, Panel

RADIUS, DENSITY, YOUNGS, POISSON = 0.01, 7850.0, 210e9, 0.3
STIFFNESS = 4.0 / 3.0 * contact_modulus(YOUNGS, POISSON) * RADIUS**0.5
MASS = 4.0 / 3.0 * pi * RADIUS**3 * DENSITY
GAP = 0.02
"""Initial gap relative to the greatest approach."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Course:
    """Course of the impact.

    Midpoints ``time`` of the slabs, first ``touch`` and ``duration`` of contact, ``force`` of the plane in each slab,
    greatest relative energy ``error``, smallest ``gap``, ``approach`` of the centre of mass after the touch,
    ``restitution`` (final / initial velocity), and elements ``across`` the greatest contact radius.
    """

    time: Array
    touch: float
    duration: float
    force: Array
    error: float
    gap: float
    approach: float
    restitution: float
    iterations: Array
    across: int


def exact(speed: float) -> Impact:
    """Impact of the rigid mass on the Hertz spring."""
    return Impact(mass=MASS, speed=speed, stiffness=STIFFNESS)


@cache
def thrown(speed: float, slabs: int = 50) -> Course:
    """March with eight elements across the greatest contact radius and ``slabs`` slabs per contact duration."""
    hertz = exact(speed)
    gap, width = GAP * hertz.approach, (RADIUS * hertz.approach) ** 0.5
    mesh = GradedDisc(radius=RADIUS, focus=1.25 * width, cells=10, part="right").build()
    ball = sw.Solid(
        mesh=mesh,
        material=sw.LinearElastic(E=YOUNGS, nu=POISSON),
        density=DENSITY,
        section=sw.bodies.Axisymmetric(),
        velocity=sw.bodies.Uniform(value=(0.0, -speed)),
        supports=(sw.Fixed(on="axis", components="x"),),
    )
    plane = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -RADIUS - gap), normal=(0.0, 1.0)))
    contacts = (sw.Contact(between=("ball.focus", "plane"), name="plane"),)
    model = sw.build(sw.Scene(bodies={"ball": ball, "plane": plane}, contacts=contacts))
    until = gap / speed + 1.2 * hertz.duration
    steps = list(sw.march(model, until=until, step=hertz.duration / slabs))
    share = np.asarray(model.mass.sum(axis=1)).ravel() / model.mass.sum()
    heights = [share @ s.after.displacement["ball"][:, 1] for s in steps]
    instants = [e.time for s in steps for e in s.events]
    ledgers = [s.ledger.contacts["plane"] for s in steps]
    return Course(
        time=np.array([0.5 * (s.slab.start + s.slab.end) for s in steps]),
        touch=min(instants),
        duration=max(instants) - min(instants),
        force=np.array([c.force_n for c in ledgers]),
        error=max(abs(s.ledger.energy_error) for s in steps) / (0.5 * model.mass.sum() * speed**2),
        gap=min(c.min_gap for c in ledgers) / hertz.approach,
        approach=-min(heights) - gap,
        restitution=float(steps[-1].ledger.momentum[1] / model.mass.sum()) / speed,
        iterations=np.array([s.report.iterations for s in steps]),
        across=max(c.count for c in ledgers) - 1,
    )


def compute() -> Outcome:
    """Compute with eight elements across the greatest contact radius and 50 slabs per contact duration."""
    course, hertz = thrown(1.0), exact(1.0)
    found = {
        "contact duration": course.duration,
        "F_max": float(course.force.max()),
        "delta_max": course.approach,
        "restitution": course.restitution,
    }
    t = course.time - course.touch
    curves = (
        Curve(x=1e6 * t, y=1e-3 * course.force, label="softway"),
        Curve(x=1e6 * t, y=1e-3 * _quasi_static(hertz, t), kind="exact", label="Hertz"),
    )
    return Outcome(values=found, panels=(Panel(title="Force of the plane", x="t [us]", y="force [kN]", curves=curves),))


def _quasi_static(hertz: Impact, times: Array) -> Array:
    """Force of the Hertz spring on a mass that hits it at t = 0, from the times at approaches d (1 - s^2)."""
    s = np.linspace(1.0, 0.0, 2001)
    middle = 0.5 * (s[1:] + s[:-1])
    since = np.concatenate([[0.0], np.cumsum(middle / np.sqrt(1.0 - (1.0 - middle**2) ** 2.5))])
    half = 0.5 * hertz.duration
    inside = np.clip(half - np.abs(times - half), 0.0, half)
    return np.asarray(hertz.force * np.interp(inside, since * half / since[-1], 1.0 - s**2) ** 1.5)
