"""Friction on meshes that change: totals of each contact, sticking and slip, and the way of a block that stops."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from adapting import adaptive_march
from passing import finest, keeps_its_balances

import softway as sw
from softway.bodies.assembled.material_states import MaterialStates
from softway.heat.coupled.build import build
from softway.marching.remeshing.adapted_scene import adapted_scene
from softway.marching.remeshing.carried.carrying import carried_over
from softway.marching.remeshing.carried.settling import Unsettled
from softway.marching.remeshing.carried.surface_forces import SurfaceForces
from softway.meshes.adaptive.adapt import Adapt
from softway.meshes.adaptive.refinement import refined
from softway.meshes.generators.shapes import disc, rectangle
from softway.solve.static.static_equilibrium import StaticState

LEVELS = 4
ADAPT = Adapt(levels=LEVELS, smooth=0.0, tolerance=1.0, buffer=2, contact_cells=4)


def ball(velocity: tuple[float, float], spin: float = 0.0) -> sw.Solid:
    turning = sw.bodies.Affine(value=velocity, gradient=((0.0, -spin), (spin, 0.0)))
    return sw.Solid(
        mesh=disc(0.5, 4, cell="tri3"), material=sw.NeoHookean(E=1.0, nu=0.3), density=1.0, velocity=turning
    )


def dropped(law: object, velocity: tuple[float, float] = (0.05, -0.1), spin: float = 0.0) -> sw.Scene:
    """A ball that falls obliquely on a floor."""
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.505), normal=(0.0, 1.0)))
    contact = sw.Contact(between=("ball.boundary", "floor"), friction=law)
    return sw.Scene(bodies={"ball": ball(velocity, spin), "floor": floor}, contacts=(contact,))


def impulses(steps: list[sw.Step]) -> np.ndarray:
    """Normal impulse, and the sum of the magnitudes of the tangential ones."""
    (label,) = steps[0].ledger.contacts
    forces = [(s.ledger.contacts[label].force_n, s.ledger.contacts[label].force_t) for s in steps]
    spans = [s.after.time - s.before.time for s in steps]
    return np.array(spans) @ np.array(forces)


FRICTIONS = {
    "slides": sw.laws.Coulomb(mu=0.1),
    "grips": sw.laws.Coulomb(mu=0.5),
    "falls": sw.laws.StaticKinetic(mu_s=0.3, mu_k=0.2),
    "Tresca": sw.laws.Tresca(shear=0.01),
}


@pytest.mark.slow
@pytest.mark.parametrize("law", FRICTIONS.values(), ids=FRICTIONS)
def test_a_ball_that_bounces_with_spin(law: object) -> None:
    scene = dropped(law, spin=-0.02)
    steps = list(adaptive_march(scene, {"ball": ADAPT}, until=2.8, step=0.05))
    assert keeps_its_balances(steps) > 4
    fine = list(sw.march(finest(scene, LEVELS, "ball"), until=2.8, step=0.05))
    assert impulses(steps) == pytest.approx(impulses(fine), rel=0.02)
    one, other = steps[-1].ledger, fine[-1].ledger
    assert one.spin[2] == pytest.approx(other.spin[2], abs=0.02 * 0.5 * impulses(fine)[1])
    assert one.dissipation == pytest.approx(other.dissipation, rel=0.1)
    assert abs(one.remeshing) < 1e-10 * 0.005


@pytest.mark.slow
@pytest.mark.parametrize("law", [FRICTIONS["slides"], FRICTIONS["grips"]], ids=["slides", "grips"])
def test_forces_and_states_of_the_rows_pass_over(law: object) -> None:
    steps = list(adaptive_march(dropped(law), {"ball": ADAPT}, until=2.8, step=0.05))
    (label,) = steps[0].model.contacts.labels
    for last, taken in zip(steps[:-1], steps[1:], strict=True):
        old, new = last.after, taken.before
        pressed = float(old.pressure[label].sum())
        assert new.pressure[label].sum() == pytest.approx(pressed, rel=1e-3)
        assert new.traction[label].sum(axis=0) == pytest.approx(old.traction[label].sum(axis=0), abs=1e-3 * pressed)
        assert new.closed[label].sum() == old.closed[label].sum()
        assert (new.sliding[label] & new.closed[label]).sum() == (old.sliding[label] & old.closed[label]).sum()
        size = np.linalg.norm(new.traction[label], axis=1)
        assert (size <= law.mu * new.pressure[label] * (1.0 + 1e-9)).all()


@pytest.mark.slow
def test_a_block_slides_to_rest() -> None:
    mu, g, v = 0.3, 0.01, 0.05
    block = sw.Solid(
        mesh=rectangle((1.0, 0.5), (4, 2), cell="tri3"), material=sw.NeoHookean(E=10.0, nu=0.3), density=1.0,
        velocity=sw.bodies.Uniform(value=(v, 0.0)),
    )  # fmt: skip
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    contact = sw.Contact(between=("block.bottom", "floor"), friction=sw.laws.Coulomb(mu=mu))
    weight = sw.Gravity(acceleration=(0.0, -g))
    scene = sw.Scene(bodies={"block": block, "floor": floor}, contacts=(contact,), loads=(weight,))
    adapt = {"block": Adapt(levels=3, smooth=0.0, tolerance=0.5, buffer=1, contact_cells=1)}
    steps = list(adaptive_march(scene, adapt, until=1.3 * v / (mu * g), step=0.2))
    last = steps[-1]
    way = last.model.weight @ last.after.displacement["block"] / last.model.weight.sum()
    assert way[0] == pytest.approx(v**2 / (2.0 * mu * g), rel=1e-3)
    assert abs(last.ledger.momentum[0]) < 5e-3 * 0.5 * v
    assert keeps_its_balances(steps) > 8
    assert abs(last.ledger.remeshing) < 1e-3 * 0.25 * v**2


@pytest.mark.slow
@pytest.mark.parametrize(
    ("cell", "names"), [("tri3", ("ball", "block")), ("tri3", ("block",)), ("quad4", ("ball",))]
)  # fmt: skip
def test_two_solids_of_which_some_change(cell: str, names: tuple[str, ...]) -> None:
    mesh = rectangle((1.0, 0.5), (6, 3), cell=cell, origin=(-0.5, -1.005))
    block = sw.Solid(mesh=mesh, material=sw.NeoHookean(E=2.0, nu=0.3), density=2.0)
    contact = sw.Contact(between=("ball.boundary", "block.top"), friction=sw.laws.Coulomb(mu=0.3))
    scene = sw.Scene(bodies={"ball": ball((0.03, -0.1)), "block": block}, contacts=(contact,))
    steps = list(adaptive_march(scene, dict.fromkeys(names, ADAPT), until=1.6, step=0.05))
    assert keeps_its_balances(steps) > 4
    first, last = steps[0].ledger, steps[-1].ledger
    assert last.momentum == pytest.approx(first.momentum, abs=1e-14)
    fine = list(sw.march(finest(scene, LEVELS, *names), until=1.6, step=0.05))
    assert impulses(steps) == pytest.approx(impulses(fine), rel=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("levels", [(1, 2), (2, 1), (2, 3)])
def test_a_block_on_a_slope_stays(levels: tuple[int, int]) -> None:
    law = sw.laws.Kelvin(E=1.0, nu=0.3, shear_viscosity=0.1)
    block = sw.Solid(mesh=rectangle((1.0, 1.0), (4, 4), cell="tri3"), material=law, density=1.0)
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    contact = sw.Contact(between=("block.bottom", "floor"), friction=sw.laws.Coulomb(mu=0.8))
    weight = sw.Gravity(acceleration=(2e-3, -1e-2))
    scene = sw.Scene(bodies={"block": block, "floor": floor}, contacts=(contact,), loads=(weight,))
    base = adapted_scene(build(scene))
    one, other = (base.on({"block": refined(block.mesh, np.full(32, level))}) for level in levels)
    *_, step = sw.march(one.model, until=4.0, step=0.1)
    old = step.march_state.state
    now, _ = carried_over(one, other, step.march_state)
    new = now.state
    assert (~new.closed).sum() <= 2  # the corner in front, and the other one
    assert not new.sliding[new.closed].any()
    assert new.traction.sum(axis=0) == pytest.approx(old.traction.sum(axis=0), rel=1e-12)
    assert new.pressure.sum() == pytest.approx(old.pressure.sum(), rel=0.15)
    *_, last = sw.march(other.model, until=8.0, step=0.1, state=now)
    bottom = other.model.parts[0].mesh.nodes("bottom")
    assert abs(last.after.displacement["block"][bottom, 0]).max() < 1e-2 * 0.5 * 2e-3 * 8.0**2
    assert abs(last.ledger.energy_error) < 1e-15


def test_totals_on_a_flat_surface() -> None:
    total = np.array([[3.0, 0.0]])
    one = SurfaceForces(
        groups=np.array([0]),
        traction=np.array([[[1.0, 0.0], [2.0, 0.0]]]),
        closed=np.ones((1, 2)),
        sliding=np.zeros((1, 2)),
        slip=np.zeros((1, 2, 2)),
        level=np.ones((1, 2)),
        total=total,
    )
    halves = sp.csr_array(np.array([[1.0, 0.0], [0.0, 1.0], [0.5, 0.5]]))
    found = one.on(halves)
    assert found.traction[0, 2].tolist() == [1.5, 0.0]
    assert replace(found, traction=one.traction).total.tolist() == total.tolist()


@pytest.mark.slow
def test_massless_nodes_beside_an_edge_are_in_equilibrium_with_their_friction(monkeypatch: pytest.MonkeyPatch) -> None:
    """Rows of a disc on the corner of a block hardly differ: its friction moves the pressure from one to another."""
    found: list[tuple[Unsettled, StaticState]] = []
    settle = Unsettled.settled

    def settled(self: Unsettled) -> tuple[StaticState, MaterialStates]:
        found.append((self, settle(self)[0]))
        return found[-1][1], ()

    monkeypatch.setattr(Unsettled, "settled", settled)
    velocity = sw.bodies.Uniform(value=(0.06, -0.24))
    soft, stiff = sw.NeoHookean(E=1.0, nu=0.35), sw.NeoHookean(E=3.0, nu=0.3)
    lens = sw.Solid(
        mesh=disc(1.0, 8, centre=(0.0, 1.04), cell="tri3"), material=soft, density=1.0, velocity=velocity, adapt="auto"
    )
    block = rectangle((2.5, 1.7), (9, 6), origin=(0.0, -1.7))
    bodies = {
        "lens": lens,
        "block": sw.Solid(mesh=block, material=stiff, density=1.0, supports=(sw.bodies.Fixed(on="bottom"),)),
    }
    contact = sw.Contact(between=("lens", "block"), friction=sw.laws.Coulomb(mu=0.2))
    scene = sw.Scene(bodies=bodies, contacts=(contact,))
    for _ in sw.march(scene, until=0.46):
        pass
    rubbed = [(change, rest) for change, rest in found if rest.traction.any()]
    assert len(rubbed) > 1
    for change, rest in rubbed:
        model, u = change.model, rest.displacement
        rows = model.rows(u, change.time)
        pushed = rows.spread(rest.pressure, u.shape) + rows.shear.spread(rest.traction)
        missing = model.dofs.only(~model.massive).forces(model.force(u) - pushed)
        assert missing == pytest.approx(0.0, abs=1e-6 * rest.pressure.max())
        assert (np.linalg.norm(rest.traction, axis=1) <= 0.2 * rest.pressure * (1.0 + 1e-9)).all()
