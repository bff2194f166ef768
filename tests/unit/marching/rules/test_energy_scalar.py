"""The scalar of the Energy rule in marches: bounded by itself where the law is linear and obstacles are flat."""

import numpy as np
import pytest

import softway as sw
from softway.solve.equations import energy_balance

WALL = sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0))
STILL, RISING = (
    sw.bodies.Still(),
    sw.bodies.Table(times=(0.0, 2.0, 4.0), displacements=((0.0, 0.0), (0.0, 0.1), (0.0, -0.1))),
)


@pytest.mark.parametrize("friction", [sw.laws.Frictionless(), sw.Coulomb(mu=0.3)], ids=lambda f: type(f).__name__)
@pytest.mark.parametrize("motion", [STILL, RISING], ids=lambda m: type(m).__name__)
def test_without_its_bound_it_stays_below_one_half(friction, motion, monkeypatch):
    """A tilted block of small strain on a floor that rests or rises, in slabs in which several nodes touch."""
    monkeypatch.setattr(energy_balance, "BOUND", np.inf)
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(4, 4)),
        material=sw.LinearElastic(E=1.0, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.02, -0.1)),
        place=sw.bodies.Placement(rotations=(sw.bodies.Rotation(angle=0.1),), bottom=0.02),
    )
    scene = sw.Scene(
        bodies={"block": block, "floor": sw.Tool(shape=WALL, motion=motion)},
        contacts=(sw.Contact(between=("block.surface", "floor"), friction=friction),),
        loads=(sw.Gravity(acceleration=(0.0, -0.02)),),
    )
    steps = list(sw.march(scene, until=4.0, step=0.2, control=sw.StepControl(scalar=10.0)))
    greatest = max(abs(a) for s in steps for a in s.report.scalars.values())
    assert 0.05 < greatest <= 0.5 + 1e-9
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-12


def test_a_linear_body_that_nothing_touches_has_no_scalar_however_far_it_flies() -> None:
    """A stiff plate, strained by 1e-6, flies by twelve of its edges in slabs that all take two iterations.

    The forces at the two ends balance the energy of linear forces.  Displacements are rounded by more the farther a
    body flies, so that massless nodes are in equilibrium up to ``eps * stiffness * way``: no scalar closes that work.
    With one, which each iterate rounds otherwise, slabs took 2 to 100 iterations.
    """
    stiffness, way = 1e6, 3.0
    plate = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(4, 4)),
        material=sw.LinearElastic(E=stiffness, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0, way)),
        supports=(sw.Fixed(on="left", components="x"),),
    )
    ball = sw.Tool(shape=sw.obstacles.Sphere(centre=(0.5, -9.0), radius=0.2))
    scene = sw.Scene(
        bodies={"plate": plate, "ball": ball},
        contacts=(sw.Contact(between=("plate.bottom", "ball")),),
        loads=(sw.Traction(on="plate.right", value=(1.0, 0.0)), sw.Gravity(acceleration=(0.0, -0.1))),
    )
    steps = list(sw.march(scene, until=1.0, step=0.01))
    assert all(a == 0.0 for s in steps for a in s.report.scalars.values())  # exactly
    assert {s.report.iterations for s in steps} <= {1, 2}
    assert max(abs(s.ledger.energy_error) for s in steps) < np.finfo(float).eps * stiffness * way**2
