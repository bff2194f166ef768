"""B05: a steel ball meets a rigid plane at 1 m/s, as a body of revolution; quasi-static impact by Hertz.

A ball is a little stiffer than a half-space (case B04): the remaining differences fall with the size of the contact.
"""

from dataclasses import dataclass
from math import pi

import numpy as np
import pytest

import softway as sw
from softway.space.sources import GradedDisc
from softway.typing import Array
from softway.verify.exact.contact import Impact, contact_modulus

RADIUS, DENSITY, YOUNGS, POISSON = 0.01, 7850.0, 210e9, 0.3
STIFFNESS = 4.0 / 3.0 * contact_modulus(YOUNGS, POISSON) * RADIUS**0.5
MASS = 4.0 / 3.0 * pi * RADIUS**3 * DENSITY
GAP = 0.02
"""Before the impact, over the greatest approach."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Course:
    """The impact: instants of the first touch and the last release, and slab by slab the force of the plane, the
    greatest error of the energy over it, least gap, approach of the centre of mass after the touch, and velocity at the
    end over that at the start; elements across the greatest contact radius.
    """

    duration: float
    force: Array
    error: float
    gap: float
    approach: float
    restitution: float
    iterations: Array
    across: int


def exact(speed: float) -> Impact:
    """The impact of the rigid mass on the spring of Hertz."""
    return Impact(mass=MASS, speed=speed, stiffness=STIFFNESS)


def thrown(speed: float, slabs: int = 50) -> Course:
    """A section with eight elements across the greatest contact radius, in slabs of 1/``slabs`` of the duration."""
    hertz = exact(speed)
    gap, width = GAP * hertz.approach, (RADIUS * hertz.approach) ** 0.5
    mesh = GradedDisc(radius=RADIUS, focus=1.25 * width, cells=10, part="right").build()
    ball = sw.Solid(
        mesh=mesh,
        material=sw.LinearElastic(E=YOUNGS, nu=POISSON),
        density=DENSITY,
        section=sw.Axisymmetric(),
        velocity=sw.Uniform(value=(0.0, -speed)),
        supports=(sw.Fixed(on="axis", components="x"),),
    )
    plane = sw.Tool(shape=sw.HalfSpace(point=(0.0, -RADIUS - gap), normal=(0.0, 1.0)))
    contacts = (sw.Contact(between=("ball.focus", "plane"), name="plane"),)
    model = sw.build(sw.Scene(bodies={"ball": ball, "plane": plane}, contacts=contacts))
    until = gap / speed + 1.2 * hertz.duration
    steps = list(sw.march(model, until=until, step=hertz.duration / slabs))
    share = np.asarray(model.mass.sum(axis=1)).ravel() / model.mass.sum()
    heights = [share @ s.after.displacement["ball"][:, 1] for s in steps]
    instants = [e.time for s in steps for e in s.events]
    ledgers = [s.ledger.contacts["plane"] for s in steps]
    return Course(
        duration=max(instants) - min(instants),
        force=np.array([c.force_n for c in ledgers]),
        error=max(abs(s.ledger.energy_error) for s in steps) / (0.5 * model.mass.sum() * speed**2),
        gap=min(c.min_gap for c in ledgers) / hertz.approach,
        approach=-min(heights) - gap,
        restitution=float(steps[-1].ledger.momentum[1] / model.mass.sum()) / speed,
        iterations=np.array([s.report.iterations for s in steps]),
        across=max(c.count for c in ledgers) - 1,
    )


@pytest.fixture(scope="module")
def course() -> Course:
    """The case."""
    return thrown(1.0)


def test_duration_force_and_approach(course):
    """The case allows 3, 3 and 4 percent."""
    assert course.duration == pytest.approx(exact(1.0).duration, rel=0.02)
    assert course.force.max() == pytest.approx(exact(1.0).force, rel=0.025)
    assert course.approach == pytest.approx(exact(1.0).approach, rel=0.02)
    assert course.across >= 8


def test_the_ball_leaves_with_its_speed(course):
    """The case allows 2 percent; hardly any energy is left in vibrations."""
    assert course.restitution == pytest.approx(1.0, abs=1e-4)


def test_the_energy_is_kept_and_nothing_is_below_the_plane(course):
    assert course.error <= 1e-9
    assert course.gap >= -1e-12


def test_the_force_is_one_hump(course):
    """Rising to its maximum and falling from it, but for what one node more in contact makes of a slab."""
    variation = np.abs(np.diff(np.concatenate([[0.0], course.force, [0.0]]))).sum()
    assert variation / (2.0 * course.force.max()) < 1.01


def test_few_iterations(course):
    """Linear elasticity: one solves and one confirms, what is more finds the contact and the scalar."""
    assert course.iterations.mean() < 8


def test_a_slower_ball_is_nearer_to_hertz(course):
    """At a hundredth of the speed the contact is 6.3 times smaller."""
    slow = thrown(0.01)
    for name in ("duration", "approach"):
        fast_error, slow_error = (
            abs(getattr(c, name) / getattr(exact(v), name) - 1.0) for c, v in ((course, 1.0), (slow, 0.01))
        )
        assert slow_error < 0.5 * fast_error
    assert slow.force.max() == pytest.approx(exact(0.01).force, rel=0.005)
