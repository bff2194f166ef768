"""D04: uniaxial stress of a hypoelastic cell is Young's modulus times the logarithm of the stretch.

E = 1, nu = 0.3.
"""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.scenes.driving import RATES, equilibria
from softway.bodies.elements.section import free_axes
from softway.bodies.internal_force.inelastic.material_points import RatePoints

YOUNGS, POISSON, STEPS = 1.0, 0.3, 50


@cache
def cell(stretch: float, rate: str, plane: bool, steps: int = STEPS) -> tuple[float, float, float]:
    """Stress, area ratio and axial force of a cell with free sides: a cube, or a square in plane stress."""
    dim = 2 if plane else 3
    mesh = (
        sw.meshes.Rectangle(size=(1.0, 1.0), cells=(1, 1))
        if plane
        else sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(1, 1, 1))
    ).build()
    axes = [("left", "x"), ("bottom", "y")] if plane else [("left", "x"), ("front", "y"), ("bottom", "z")]
    law = sw.Hypoelastic(E=YOUNGS, nu=POISSON, rate=RATES[rate])
    solid = sw.Solid(
        mesh=mesh,
        material=law,
        density=1.0,
        section=sw.bodies.PlaneStress() if plane else None,
        supports=(*(sw.Fixed(on=tag, components=c) for tag, c in axes), sw.Fixed(on="right", components="x")),
    )
    model = sw.build(sw.Scene(bodies={"cell": solid}))
    stretches = [1.0 + (stretch - 1.0) * k / steps for k in range(1, steps + 1)]
    path = [(mesh.points * ([s, *[s**-POISSON] * (dim - 1)] - np.ones(dim)), 0.0) for s in stretches]
    *_, (_, (memory,)) = equilibria(model, path)
    assert memory is not None
    body, u = model.parts[0].internal, memory.displacement
    points = RatePoints(law=law, free=free_axes(body.section), directions=body.directions)
    F = points.gradient(body.sampling.derivatives(u), memory.lateral)[0]
    force = body.stored_force(memory, u)[1][mesh.nodes("right"), 0].sum()
    return float(memory.stress[0, 0, 0]), float(F[1, 1] * F[2, 2]), float(force)


def compute() -> Outcome:
    """Compute a cube stretched to twice its length in 50 slabs."""
    return Outcome(values={"sigma(2)": cell(2.0, "jaumann", plane=False)[0]})
