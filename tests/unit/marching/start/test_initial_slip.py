"""Friction at the start: what slips there has the force of slip, what moves along with its floor has none."""

import numpy as np
import pytest

import softway as sw

LAW = sw.NeoHookean(E=1.0, nu=0.3)
SQUEEZED = sw.bodies.Affine(gradient=((0.0, 0.0), (0.0, -0.01)), origin=(0.0, 1.0))


@pytest.mark.parametrize(("slip", "mean"), [(0.05, -0.2), (-0.05, 0.2), (1e-5, -0.2), (1e-9, 0.0), (0.0, 0.0)])
def test_slow_slip_beside_a_fast_body_is_slip_and_its_rounding_is_not(slip: float, mean: float) -> None:
    """A block pressed on a belt; both go at 0.3, but for a slip, and another body flies by at 1."""
    meshes = {"block": (0.0, 0.0), "flyer": (5.0, 3.0)}
    speeds = {"block": 0.3 + slip, "flyer": 1.0}
    bodies = {
        name: sw.Solid(
            mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(4, 4), origin=origin), material=LAW, density=1.0,
            velocity=sw.bodies.Uniform(value=(speeds[name], 0.0)),
            displacement=SQUEEZED if name == "block" else sw.bodies.Uniform(),
        )
        for name, origin in meshes.items()
    }  # fmt: skip
    belt = sw.Tool(
        shape=sw.obstacles.HalfSpace(point=(0.0, 0.01), normal=(0.0, 1.0)),
        motion=sw.bodies.Translation(velocity=(0.3, 0.0)),
    )
    contact = sw.Contact(between=("block.bottom", "belt"), name="belt", friction=sw.Coulomb(mu=0.2))
    steps = sw.march(sw.Scene(bodies={**bodies, "belt": belt}, contacts=(contact,)), until=0.01, step=0.01)
    before = next(iter(steps)).before
    pressure, traction = before.pressure["belt"], before.traction["belt"]
    assert pressure.sum() > 1e-3
    assert traction[:, 0].sum() == pytest.approx(mean * pressure.sum(), abs=1e-9)
    assert np.abs(traction[:, 1]).max() == 0.0
