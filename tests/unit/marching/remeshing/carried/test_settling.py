"""Material states after massless nodes have settled on a new mesh."""

import numpy as np
import pytest

import softway as sw
from softway.bodies.assembled.material_states import committed
from softway.marching.remeshing.carried.settling import Unsettled
from softway.marching.start.preparation import prepare
from softway.marching.state.march_state import Settings
from softway.marching.state.model_state import split_states
from softway.marching.state.step_control import StepControl
from softway.model.build import build
from softway.solve.methods.fixed_point import FixedPoint

RISE = 1e-3
J2 = sw.J2(E=1.0, nu=0.3, yield_stress=0.01)


@pytest.mark.parametrize(("dilatation", "rings"), [("point", 1), ("corner", 2)])
def test_stress_follows_the_nodes_as_far_as_it_depends_on_them(dilatation: str, rings: int) -> None:
    """The state is that of the displacement in equilibrium in all cells, and the given one beyond the reach."""
    body = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(5, 5), cell="tri3"),
        material=J2,
        density=1.0,
        dilatation=dilatation,
    )
    rises = sw.bodies.Translation(velocity=(0.0, 1.0))
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)), motion=rises)
    scene = sw.Scene(bodies={"body": body, "floor": floor}, contacts=(sw.Contact(between=("body.bottom", "floor")),))
    settings = Settings(until=1.0, step=0.01, weight=sw.model.EndPeaks(), method=FixedPoint(), control=StepControl())
    prepared = prepare(build(scene), settings)
    model, memory = prepared.stepper.model, split_states(prepared.stepper.model, prepared.march_state.state).memory
    light = ~model.massive
    assert light.any()
    u = np.zeros(model.shape)
    given = committed(model.during((memory["body"],), 0.01).parts, u)
    change = Unsettled(model=model, displacement=u, states=given, friction=None, kept=None, time=RISE, span=0.01)
    rest, (found,) = change.settled()
    np.testing.assert_allclose(rest.displacement[light, 1], RISE, rtol=1e-9)
    (part,) = model.parts
    whole = part.internal.during(given[0], 1e-8).committed(rest.displacement)
    np.testing.assert_allclose(found.stress, whole.stress, atol=1e-14)
    changed = np.abs(found.stress - given[0].stress).max(axis=(1, 2)) > 1e-12
    cells = part.mesh.blocks["tri3"]
    reach = (rest.displacement != 0.0).any(axis=1)
    for _ in range(rings):
        near = reach[cells].any(axis=1)
        reach = np.isin(np.arange(len(reach)), cells[near])
    assert (changed == near).all() and not near.all()
