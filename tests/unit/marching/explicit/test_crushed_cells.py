"""Central differences take shorter slabs as cells get shorter."""

import numpy as np
import pytest

import softway as sw
from softway.marching.state.step_control import crushing


def bar(law: object, speed: float) -> sw.Scene:
    """A bar of ten cells thrown at a wall."""
    solid = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=10),
        material=law,
        density=1.0,
        velocity=sw.bodies.Uniform(value=speed),
        mass=sw.bodies.Lumped(),
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.0001, normal=-1.0))
    return sw.Scene(bodies={"bar": solid, "wall": wall}, contacts=(sw.Contact(between=("bar.right", "wall")),))


def test_the_ratio_is_that_of_the_shortest_edges() -> None:
    model = sw.build(bar(sw.NeoHookean(E=1.0), 0.0))
    u = np.zeros(model.shape)
    u[5:] = -0.04
    assert crushing(model, sw.Explicit()).shortest_ratio(u) == pytest.approx(0.6)
    assert crushing(model, sw.Explicit()).shortest_ratio(-u) == 1.0
    assert crushing(model, sw.FixedPoint()).shortest_ratio(u) == 1.0
    assert crushing(sw.build(bar(sw.LinearElastic(E=1.0), 0.0)), sw.Explicit()).shortest_ratio(u) == 1.0


def test_a_plastic_bar_is_crushed_to_the_end() -> None:
    law = sw.J2(E=1.0, nu=0.3, yield_stress=0.06)
    steps = list(sw.march(bar(law, 0.35), until=1.0, method=sw.Explicit()))
    spans = [s.slab.span for s in steps]
    assert min(spans) < 0.7 * spans[0]
    ledger = steps[-1].ledger
    assert ledger.dissipation > 0.5 * 0.5 * 0.35**2
    assert abs(ledger.energy_error) < 1e-2 * 0.5 * 0.35**2
