"""Marches with the operator Device: the motion, events and energy of conjugate gradients on the processor."""

from dataclasses import dataclass, field

import numpy as np
import pytest
import scipy.sparse as sp

import softway as sw
from softway.solve.device import gradients
from softway.solve.device.gradients import device_rows
from softway.solve.elimination.closed_rows import ClosedRows
from softway.solve.operators.matrix_free import Blocks

Friction = sw.laws.Frictionless | sw.Coulomb
SMOOTH = sw.laws.Frictionless()
ENERGY = 12.5
"""Energy of the cube at the start [J]."""


def cube(friction: Friction = SMOOTH, supported: bool = False) -> sw.Scene:
    solid = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(3, 3, 3)),
        material=sw.NeoHookean(E=1e4, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0, 0.0, 0.0) if supported else (1.0, 0.0, -5.0)),
        supports=(sw.bodies.Fixed(on="top"),) if supported else (),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, -0.05), normal=(0.1, 0.0, 1.0)))
    contact = sw.Contact(between=("cube.bottom", "floor"), friction=friction)
    loads = (sw.Gravity(acceleration=(0.0, 0.0, -2e3)),) if supported else ()
    return sw.Scene(bodies={"cube": solid, "floor": floor}, contacts=(contact,), loads=loads)


def blocks(friction: Friction = SMOOTH) -> sw.Scene:
    law = {"density": 1.0, "material": sw.NeoHookean(E=1e4, nu=0.3)}
    upper = sw.meshes.Box(size=(0.8, 0.8, 0.8), cells=(3, 3, 3), origin=(0.1, 0.13, 1.01))
    lower = sw.Solid(mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(4, 4, 4)), **law)
    thrown = sw.Solid(mesh=upper, velocity=sw.bodies.Uniform(value=(1.0, 0.4, -5.0)), **law)
    contact = sw.Contact(between=("b.bottom", "a.top"), friction=friction)
    return sw.Scene(bodies={"a": lower, "b": thrown}, contacts=(contact,))


def glued() -> sw.Scene:
    law = {"density": 1.0, "material": sw.laws.StVenantKirchhoff(E=1e4, nu=0.3)}
    lower = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(4, 4)), velocity=sw.bodies.Uniform(value=(0.0, -5.0)), **law
    )
    upper = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(3, 3), cell="tri3", origin=(0.0, 1.0)),
        velocity=sw.bodies.Uniform(value=(0.0, -5.0)),
        **law,
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.02), normal=(0.1, 1.0)))
    return sw.Scene(
        bodies={"a": lower, "b": upper, "floor": floor},
        contacts=(sw.Contact(between=("a.bottom", "floor")),),
        ties=(sw.Tie(between=("b.bottom", "a.top")),),
    )


@dataclass
class Course:
    """What a march tells: last displacements, velocities, events, and the greatest energy error."""

    u: np.ndarray
    v: np.ndarray
    events: list[tuple[str, int]]
    times: list[float]
    error: float = 0.0
    forces: list[float] = field(default_factory=list)


def course(scene: sw.Scene, operator: object, slabs: int, step: float = 0.9e-3) -> Course:
    method = sw.FixedPoint(operator=operator, tolerance=1e-13)  # type: ignore[arg-type]
    steps = list(sw.march(scene, until=slabs * step, step=step, method=method))
    after, events = steps[-1].after, [e for s in steps for e in s.events]
    return Course(
        np.concatenate(list(after.displacement.values())),
        np.concatenate(list(after.velocity.values())),
        [(e.kind, e.node) for e in events],
        [e.time for e in events],
        max(abs(s.ledger.energy_error) for s in steps),
        [c.force_n for s in steps for c in s.ledger.contacts.values()],
    )


CASES = {
    "plane": (cube(), 22),
    "friction": (cube(sw.Coulomb(mu=0.3)), 16),
    "supports": (cube(supported=True), 12),
    "two bodies": (blocks(), 4),  # a touch of the fifth slab has instants 5e-5 s apart by the processor's own operators
    "two bodies, friction": (blocks(sw.Coulomb(mu=0.3)), 7),
    "glued": (glued(), 15),
}


@pytest.mark.parametrize("case", CASES)
def test_the_motion_of_the_processor(case: str, device: str) -> None:
    scene, slabs = CASES[case]
    found = course(scene, sw.solve.Device(device=device), slabs)
    exact = course(scene, sw.solve.ConjugateGradients(), slabs)
    assert max(exact.forces) > 0.0
    assert exact.events
    assert found.events == exact.events
    assert found.times == pytest.approx(exact.times, rel=1e-12)
    assert np.abs(found.u - exact.u).max() < 1e-12 * np.abs(exact.u).max()
    assert np.abs(found.v - exact.v).max() < 1e-11 * np.abs(exact.v).max()
    assert found.forces == pytest.approx(exact.forces, rel=1e-8, abs=1e-9 * max(exact.forces))
    if "friction" not in case and case != "supports":
        assert found.error < 1e-12 * ENERGY


def test_the_same_bits_in_every_run(device: str) -> None:
    first, second = (course(cube(), sw.solve.Device(device=device), 12) for _ in range(2))
    assert first.u.tobytes() == second.u.tobytes()
    assert first.v.tobytes() == second.v.tobytes()


@pytest.mark.parametrize("together", [64, 0], ids=["inverted", "on the processor"])
@pytest.mark.parametrize("dependent", [False, True], ids=["independent", "dependent"])
def test_closed_rows(dependent: bool, together: int, device: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Balanced residuals and projected fields of rows that share unknowns, two of which may be the same."""
    from softway.kernels.device.arrays import fetched, numbers

    monkeypatch.setattr(gradients, "TOGETHER", together)
    G = np.array([[1.0, 0.5, 0.0, 0.0, 0.0], [0.0, 1.0, -0.5, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0, 0.0]])
    G = np.vstack([G, G[:1]]) if dependent else G
    inverse = Blocks(sp.csr_array(np.diag([1.0, 2.0, 3.0, 4.0, 5.0])))
    closed = ClosedRows.of(sp.csr_array(G), inverse)
    rows = device_rows(closed, device)
    r = np.array([1.0, -2.0, 3.0, 4.0, 5.0])
    on_device = numbers(r, device)
    rows.balance(on_device)
    assert fetched(on_device) == pytest.approx(closed.balanced(r), abs=1e-14)
    assert G @ np.diag([1.0, 2.0, 3.0, 4.0, 5.0]) @ fetched(on_device) == pytest.approx(0.0, abs=1e-13)
    on_device = numbers(r, device)
    rows.remove(on_device)
    assert fetched(on_device) == pytest.approx(closed.removed(r), abs=1e-13)
    assert G @ fetched(on_device) == pytest.approx(0.0, abs=1e-13)


def test_solutions_reach_their_tolerance(device: str) -> None:
    """The residual of a solution, with the matrix assembled on the processor."""
    from softway.solve.equations.slab_matrix import SlabMatrix

    model = sw.build(cube())
    slab = SlabMatrix(model=model, stiffness_factor=1e-6, viscous_factor=0.0)
    u = 0.01 * np.random.default_rng(3).standard_normal(model.shape)
    factor = sw.solve.Device(device=device, tolerance=1e-10).make(slab, u, None).factor
    b = np.random.default_rng(4).standard_normal((model.dofs.size, 2))
    missing = slab.operator(u) @ factor.solve(b) - b
    assert np.abs(missing).max() < 1e-9 * np.abs(b).max()
