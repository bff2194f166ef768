"""Rigid bodies in the cases of friction: a block on a belt, a ball on a slope, a thrown ball, and the end of a rod."""

from dataclasses import dataclass
from math import cos, sin

import numpy as np

from softway.arrays import Array
from softway.mechanisms import Mechanism, MechanismStep, PlaneStop, Rigid, Spring, march

G = 9.81


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Rolling:
    """Course (n,) of a round body of a radius [m]: time [s], velocity along the slope [m/s], and spin [rad/s]."""

    radius: float
    time: Array
    velocity: Array
    spin: Array

    @property
    def slip(self) -> Array:
        """Velocity (n,) of its lowest point along the slope [m/s]."""
        return self.velocity - self.radius * self.spin


def on_belt(*, belt: float, stiffness: float, static: float, kinetic: float, step: float) -> list[MechanismStep]:
    """Steps of a block of 1 kg on a belt, held by a spring, over two periods (C03)."""
    at, wall = (0.0, 0.05), (-1.0, 0.05)
    block = Rigid(mass=1.0, centre=at, velocity=(belt, 0.0), inertia=0.01)
    floor = PlaneStop(
        between=("ground", "b"),
        point=at,
        plane=at,
        normal=(0.0, 1.0),
        friction=kinetic,
        mu_s=static,
        velocity=(belt, 0.0),
    )
    spring = Spring(between=("ground", "b"), ends=(wall, at), stiffness=stiffness, rest=1.0)
    mechanism = Mechanism(bodies={"b": block}, stops={"belt": floor}, springs=(spring,), gravity=(0.0, -G))
    return list(march(mechanism, until=1.3, step=step))


def rolled_down(
    *, radius: float, beta: float, slope: float, mu: float, speed: float, until: float, step: float
) -> Rolling:
    """Course of a body of the inertia ``beta m r^2`` down a slope [rad] from a speed without spin (C05, C06)."""
    normal, along = np.array([sin(slope), cos(slope), 0.0]), np.array([cos(slope), -sin(slope), 0.0])
    centre, velocity = (tuple(x.tolist()) for x in (radius * normal, speed * along))
    body = Rigid(mass=1.0, centre=centre, inertia=(beta * radius**2,) * 3, velocity=velocity)
    floor = PlaneStop(
        between=("ground", "b"),
        point=centre,
        plane=(0.0, 0.0, 0.0),
        normal=tuple(normal.tolist()),
        radius=radius,
        friction=mu,
    )
    mechanism = Mechanism(bodies={"b": body}, stops={"floor": floor}, gravity=(0.0, -G, 0.0))
    steps = list(march(mechanism, until=until, step=step))
    speeds = np.array([s.bodies["b"].velocity @ along for s in steps])
    spin = -np.array([s.bodies["b"].spin[2] for s in steps])
    return Rolling(radius=radius, time=np.array([s.time for s in steps]), velocity=speeds, spin=spin)


def fallen(*, speed: float, mu: float, length: float, angle: float, restitution: float) -> list[float]:
    """Velocity (vx, vy, omega) and impulse (normal, tangential) of a rod of 1 kg after an impact at 1 m/s (C07)."""
    end = (-0.5 * length * cos(angle), -0.5 * length * sin(angle))
    rod = Rigid(mass=1.0, centre=(0.0, 0.0), inertia=length**2 / 12.0, velocity=(speed, -1.0))
    floor = PlaneStop(
        between=("ground", "rod"), point=end, plane=end, normal=(0.0, 1.0), friction=mu, restitution=restitution
    )
    mechanism = Mechanism(bodies={"rod": rod}, stops={"floor": floor}, restitution="Poisson")
    step = next(iter(march(mechanism, until=1e-3, step=1e-3)))
    body = step.bodies["rod"]
    return [*body.velocity.tolist(), float(body.spin[-1]), step.events[0].impulse, float(body.velocity[0]) - speed]
