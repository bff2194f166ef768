"""C07: end of a rod hits the ground: the collision of ``softway.apps.verify.exact.rigid_impact``, and a rigid body."""

from math import cos, sin

import numpy as np

from softway.apps.verify.case import Outcome
from softway.apps.verify.cases.friction import rigid_bodies
from softway.apps.verify.exact.rigid_impact import Collision, collide
from softway.arrays import Array

LENGTH, MASS, ANGLE, RESTITUTION = 1.0, 1.0, 0.7, 0.5
SPEEDS, FRICTION = (0.0, 0.5), (0.0, 0.3, 1.3)


def fallen(along: float, mu: float) -> tuple[Array, Collision]:
    """Velocity (vx, vy, omega) after the impact of a rod that moves ``along`` the ground and falls at 1 m/s."""
    x, y = -0.5 * LENGTH * cos(ANGLE), -0.5 * LENGTH * sin(ANGLE)
    end = np.array([[1.0, 0.0, -y], [0.0, 1.0, x]])  # velocity of the end from the velocity of the rod
    light = np.diag([1.0 / MASS, 1.0 / MASS, 12.0 / (MASS * LENGTH**2)])
    before = np.array([along, -1.0, 0.0])
    met = collide(end @ light @ end.T, end @ before, mu=mu, restitution=RESTITUTION)
    return before + light @ end.T @ met.impulse, met


def compute() -> Outcome:
    """Compute both velocities with the three friction coefficients."""
    rows, marched = [], []
    for along in SPEEDS:
        for mu in FRICTION:
            after, met = fallen(along, mu)
            rows.append([*after.tolist(), float(met.impulse[1]), float(met.impulse[0])])
            marched.append(rigid_bodies.fallen(speed=along, mu=mu, length=LENGTH, angle=ANGLE, restitution=RESTITUTION))
    return Outcome(values={"after the impact": rows, "after the impact, marched": marched})
