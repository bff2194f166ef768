"""Slabs with dashpots, where every attempt without them fails between two instants."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import softway as sw
from softway.bodies.assembled.dashpots import Dashpots
from softway.errors import NoConvergence
from softway.marching.attempts import accept
from softway.marching.results.finding import NO_EQUILIBRIUM
from softway.marching.rules.slab_rule import Attempt
from softway.model.build import build
from softway.model.slab import Slab

STEP = 0.02
Window = tuple[float, float]


@pytest.fixture
def failing(monkeypatch) -> Callable[[Window], list[Attempt]]:
    """Make attempts without dashpots fail that start within a window; lists all attempts."""

    def make(window: Window) -> list[Attempt]:
        solved, seen = accept.audited_slab, list[Attempt]()

        def stumbling(stepper: Any, march_state: Any, slab: Slab, memory: Any, attempt: Attempt) -> Any:
            seen.append(attempt)
            if attempt.dashpots is None and window[0] - 1e-9 <= slab.start < window[1] - 1e-9:
                raise NoConvergence("no equilibrium")
            return solved(stepper, march_state, slab, memory, attempt)

        monkeypatch.setattr(accept, "audited_slab", stumbling)
        return seen

    return make


def block(material: Any, **options: Any) -> sw.Solid:
    return sw.Solid(mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(3, 3)), material=material, density=1.0, **options)


def falling(height: float = 0.0, friction: Any = None) -> sw.Scene:
    """A block that hits the floor at an angle."""
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -height), normal=(0.0, 1.0)))
    solid = block(sw.NeoHookean(E=10.0, nu=0.3), velocity=sw.bodies.Uniform(value=(0.3, -0.5)))
    contact = sw.Contact(between=("block.bottom", "floor"))
    if friction is not None:
        contact = replace(contact, friction=friction)
    return sw.Scene(bodies={"block": solid, "floor": floor}, contacts=(contact,))


@pytest.mark.parametrize("friction", [None, sw.laws.Coulomb(mu=0.3)], ids=["smooth", "rough"])
def test_balances_close_and_the_loss_is_told(failing, friction: Any) -> None:
    """In an impact: energy to rounding, with dissipation that grows; momentum changes by the contact force alone."""
    failing((0.1, 0.2))
    steps = list(sw.march(falling(friction=friction), until=0.4, step=STEP))
    first = steps[0].ledger.energy_kinetic + steps[0].ledger.energy_strain
    before = 0.0
    for step in steps:
        assert abs(step.ledger.energy_error) < 1e-12 * first
        assert step.certificate.momentum_error < 1e-13
        assert step.ledger.dissipation >= before - 1e-13
        before = step.ledger.dissipation
    acting = [s for s in steps if 0.1 - 1e-9 <= s.slab.start < 0.2 - 1e-9]
    assert len(acting) == 5 and all(s.slab.weight.theta == 1.0 for s in acting)
    lost = acting[-1].ledger.dissipation - next(s for s in steps if s.slab.end > 0.1 - 1e-9).ledger.dissipation
    assert lost > 1e-6 * first
    told = [(s.slab.start, e) for s in steps for e in s.events if e.kind == NO_EQUILIBRIUM]
    assert len(told) == 1 and told[0][0] == pytest.approx(0.1)
    assert told[0][1].contact == "block" and "massless contact nodes of 'block' lose" in told[0][1].finding


def test_the_slab_after_is_tried_without_them_and_damped(failing) -> None:
    """With the usual length; the one after it has the virtual time function of the march again."""
    seen = failing((0.1, 0.14))
    steps = list(sw.march(falling(), until=0.3, step=STEP))
    thetas = [s.slab.weight.theta for s in steps]
    assert thetas[:10] == [0.5] * 5 + [1.0] * 3 + [0.5] * 2
    assert [s.slab.span for s in steps] == pytest.approx([STEP] * 15)
    many, few = (len(steps[k].report.rejections) for k in (5, 6))
    assert many > 13 and few <= 3 and not steps[7].report.rejections
    assert sum(a.dashpots is not None for a in seen) == 2


def test_an_interrupted_march_goes_on_with_the_same_bits(failing) -> None:
    failing((0.1, 0.2))
    scene = falling(friction=sw.laws.Coulomb(mu=0.3))
    steps = list(sw.march(scene, until=0.3, step=STEP))
    for k in (4, 6, 9, 10):
        again = list(sw.march(scene, until=0.3, step=STEP, state=steps[k].march_state))
        assert len(again) == len(steps) - k - 1
        np.testing.assert_array_equal(again[-1].after.displacement["block"], steps[-1].after.displacement["block"])
        np.testing.assert_array_equal(again[-1].after.velocity["block"], steps[-1].after.velocity["block"])


def test_momentum_is_kept_in_flight(failing) -> None:
    """A stretched block that nothing touches."""
    failing((0.0, 0.2))
    scene = falling(height=5.0)
    stretched = replace(scene.bodies["block"], displacement=sw.bodies.Affine(gradient=((0.2, 0.1), (0.0, -0.1))))
    steps = list(sw.march(replace(scene, bodies={**scene.bodies, "block": stretched}), until=0.2, step=STEP))
    for step in steps:
        np.testing.assert_allclose(step.ledger.momentum[:2], [0.3, -0.5], rtol=0, atol=1e-14)


def test_a_slab_of_a_linear_law_against_its_matrices(failing) -> None:
    """``M (q - v0) + h (K u1 + C (u1 - u0) / h) = 0``, without inertia ``K u1 + C (u1 - u0) / h = 0``."""
    failing((0.0, 0.02))
    scene = falling(height=5.0)
    start = sw.bodies.Affine(gradient=((0.02, 0.01), (0.0, -0.01)))
    solid = replace(scene.bodies["block"], material=sw.laws.LinearElastic(E=10.0, nu=0.3), displacement=start)
    scene = replace(scene, bodies={**scene.bodies, "block": solid})
    model = build(scene)
    step = next(iter(sw.march(scene, until=0.02, step=STEP)))
    u0, h = step.before.displacement["block"], STEP
    n, d = u0.shape
    v0, heavy = step.before.velocity["block"].ravel(), np.repeat(model.massive, d)
    K = model.tangent(u0).toarray()
    M = np.kron(model.mass.toarray(), np.eye(d))
    dashpots = Dashpots.of(model.parts, model.massive, model.points + u0, model.tangent_blocks(u0), STEP)
    C = dashpots.stiffness(model.dofs.jacobian, 1.0).toarray()
    moved = 0.5 * h * np.where(heavy, v0, 0.0)  # at q = 0
    left = 0.5 * h * (K + C / h)
    left[heavy] = M[heavy] + h * left[heavy]
    right = -(K @ (u0.ravel() + moved) + C @ moved / h)
    right[heavy] = (M @ v0)[heavy] + h * right[heavy]
    q = np.linalg.solve(left, right)
    u1 = u0.ravel() + moved + 0.5 * h * q
    np.testing.assert_allclose(step.after.displacement["block"].ravel(), u1, rtol=0, atol=1e-13)


def test_a_march_without_massless_nodes_has_none(failing) -> None:
    seen = failing((0.1, 0.2))
    rule = sw.contact.Impulse()
    scene = falling()
    with pytest.raises(sw.NumericsError, match="no equilibrium"):
        list(sw.march(replace(scene, contacts=(replace(scene.contacts[0], timing=rule),)), until=0.4, step=STEP))
    assert all(a.dashpots is None for a in seen)
