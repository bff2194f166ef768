"""Nearly rigid blocks on a plane with friction: C01, C04, C09.

Gravity is rotated instead of the plane. The march starts from the equilibrium in the frame that moves with the block:
the static loads include the inertia force. This avoids the undamped vibrations of the block.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np

import softway as sw
from softway.laws.friction_law import FrictionLaw
from softway.marching.results.step import Step

GRAVITY = 9.81


def on_plane(
    *,
    friction: FrictionLaw,
    velocity: float,
    gravity: tuple[float, float],
    resisted: float,
    size: tuple[float, float] = (0.2, 0.1),
    cells: tuple[int, int] = (8, 4),
    E: float = 1e9,
    nu: float = 0.3,
    density: float = 1000.0,
) -> sw.Scene:
    """Scene of a block ``b`` with a ``velocity`` along the plane; ``resisted`` is the acceleration by friction."""
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=size, cells=cells),
        material=sw.LinearElastic(E=E, nu=nu),
        density=density,
        velocity=sw.bodies.Uniform(value=(velocity, 0.0)),
    )
    plane = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    still = sw.Gravity(acceleration=(-resisted, gravity[1]))
    return sw.Scene(
        bodies={"b": block, "plane": plane},
        contacts=(sw.Contact(between=("b.bottom", "plane"), name="plane", friction=friction),),
        loads=(sw.Gravity(acceleration=gravity),),
        start=sw.model.StaticStart(loads=(still,)),
    )


def incline(degrees: float, mu: float, speed: float, rest: bool = False, **given: Any) -> sw.Scene:
    """Scene of a block thrown up an incline, or at ``rest`` under its weight and held by friction."""
    slope = np.deg2rad(degrees)
    gravity = (-GRAVITY * np.sin(slope), -GRAVITY * np.cos(slope))
    resisted = -gravity[0] if rest else np.sign(speed) * mu * gravity[1]
    return on_plane(friction=sw.Coulomb(mu=mu), velocity=speed, gravity=gravity, resisted=resisted, **given)


def travelled(steps: Iterator[Step]) -> Iterator[tuple[float, float, Step]]:
    """Yield time, mean displacement along the plane, and step for each slab."""
    for step in steps:
        yield step.after.time, float(step.after.displacement["b"][:, 0].mean()), step
