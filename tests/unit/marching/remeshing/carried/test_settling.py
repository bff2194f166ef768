"""Material states after massless nodes have settled on a new mesh."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.bodies.assembled.material_states import committed
from softway.marching.remeshing.carried.settling import Unsettled
from softway.marching.remeshing.carried.surface_forces import surface_forces
from softway.marching.start.preparation import prepare
from softway.marching.state.march_state import Settings
from softway.marching.state.model_state import ModelState, split_states
from softway.marching.state.step_control import StepControl
from softway.meshes.generators.shapes import rectangle
from softway.model.build import build
from softway.model.model import Model
from softway.solve.methods.fixed_point import FixedPoint

RISE = 1e-3
J2 = sw.J2(E=1.0, nu=0.3, yield_stress=0.01)


def begun(body: sw.Solid, law: object) -> tuple[Model, ModelState]:
    """A body on a floor that rises: its model, and the state at the start."""
    rises = sw.bodies.Translation(velocity=(0.0, 1.0))
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)), motion=rises)
    contact = sw.Contact(between=("body.bottom", "floor"), friction=law)
    scene = sw.Scene(bodies={"body": body, "floor": floor}, contacts=(contact,))
    settings = Settings(until=1.0, step=0.01, weight=sw.model.EndPeaks(), method=FixedPoint(), control=StepControl())
    prepared = prepare(build(scene), settings)
    return prepared.stepper.model, prepared.march_state.state


def square(dilatation: str) -> sw.Solid:
    mesh = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(5, 5), cell="tri3")
    return sw.Solid(mesh=mesh, material=J2, density=1.0, dilatation=dilatation)


@pytest.mark.parametrize(("dilatation", "rings"), [("point", 1), ("corner", 2)])
def test_stress_follows_the_nodes_as_far_as_it_depends_on_them(dilatation: str, rings: int) -> None:
    """The state is that of the displacement in equilibrium in all cells, and the given one beyond the reach."""
    model, state = begun(square(dilatation), sw.laws.Frictionless())
    memory = split_states(model, state).memory
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


def test_rows_stick_where_the_friction_of_their_places_has_no_equilibrium() -> None:
    """Tractions far above what a plastic layer bears: rows then stick within the limit of the law."""
    mu = 0.3
    model, state = begun(square("point"), sw.laws.Coulomb(mu=mu))
    carried = surface_forces(model, state)
    pulled = replace(carried, traction=np.full_like(carried.traction, 5.0), closed=np.ones_like(carried.closed))
    given = committed(model.during((split_states(model, state).memory["body"],), 0.01).parts, np.zeros(model.shape))
    u = np.zeros(model.shape)
    change = Unsettled(model=model, displacement=u, states=given, friction=pulled, kept=None, time=RISE, span=0.01)
    rest, (found,) = change.settled()
    closed, size = rest.pressure > 0.0, np.linalg.norm(rest.traction, axis=1)
    assert closed.sum() == 6
    assert (size <= mu * rest.pressure * (1.0 + 1e-9)).all()
    sticks = closed & ~rest.sliding
    assert sticks.any()
    rows = model.rows(rest.displacement, RISE)
    assert rest.displacement[rows.node[sticks], 0] == pytest.approx(0.0, abs=1e-12)
    (part,) = model.parts
    there = part.internal.during(given[0], 1e-8).committed(rest.displacement)
    assert found.stress == pytest.approx(there.stress, abs=1e-14)
    force = replace(part, internal=part.internal.during(given[0], 1e-8)).internal.force(rest.displacement)
    pushed = rows.spread(rest.pressure, model.shape) + rows.shear.spread(rest.traction)
    assert (force - pushed)[~model.massive] == pytest.approx(0.0, abs=1e-10 * float(rest.pressure.max()))


def test_a_corner_without_a_surface_of_its_own_has_no_traction() -> None:
    """Its area is a token; its force, over this area, would be spread over areas of other nodes."""
    turn = np.sqrt(0.5) * np.array([[1.0, 1.0], [-1.0, 1.0]])
    mesh = rectangle((1.0, 1.0), (4, 4), cell="tri3")
    mesh = replace(mesh, points=mesh.points @ turn + [0.1, 0.001])
    tip = sw.Solid(mesh=mesh, material=J2, density=1.0, velocity=sw.bodies.Uniform(value=(0.02, -0.1)))
    block = sw.Solid(mesh=rectangle((2.0, 1.0), (4, 4), cell="tri3", origin=(-1.0, -1.0)), material=J2, density=1.0)
    contact = sw.Contact(between=("tip", "block.top"), friction=sw.laws.Coulomb(mu=0.3))
    scene = sw.Scene(bodies={"tip": tip, "block": block}, contacts=(contact,))
    step = list(sw.march(scene, until=0.1, step=0.02))[-1]
    now = step.march_state.state
    assert now.closed.sum() == 1 and step.model.friction.at(now.start.displacement).pointed[now.closed].all()
    carried = surface_forces(step.model, now)
    assert not carried.traction.any()
    assert carried.total[0] == pytest.approx(now.traction.sum(axis=0), rel=1e-12)
    assert np.linalg.norm(carried.total[0]) > 0.0
