"""Instants at which a stiff block on a rough floor comes to rest or breaks away, against those of a point mass."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import softway as sw
from softway.laws.friction import NortonHoff, StaticKinetic

GRAVITY = 9.81
DOWN = sw.Gravity(acceleration=(0.0, -GRAVITY))


def block(law: object, speed: float, belt: float = 0.0, E: float = 1e9) -> sw.Scene:
    """A stiff block of side 0.1 on a floor that moves along, in equilibrium with the friction of its slip."""
    slip = np.sign(speed - belt) * law.resistance(np.ones(1), np.ones(1))[0][0]
    solid = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(0.1, 0.1), cells=(3, 3)), material=sw.LinearElastic(E=E),
        density=1000.0, velocity=sw.bodies.Uniform(value=(speed, 0.0)),
    )  # fmt: skip
    motion = sw.bodies.Translation(velocity=(belt, 0.0)) if belt else sw.bodies.Still()
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)), motion=motion)
    initial_load = sw.Gravity(acceleration=(slip * GRAVITY, -GRAVITY))
    contact = sw.Contact(between=("block.bottom", "floor"), name="floor", friction=law)
    start = sw.model.StaticStart(loads=(initial_load,))
    return sw.Scene(bodies={"block": solid, "floor": floor}, contacts=(contact,), loads=(DOWN,), start=start)


@pytest.mark.parametrize(("speed", "belt"), [(0.1, 0.0), (-0.1, 0.0), (0.0, 0.1), (0.3, 0.2)])
def test_a_block_comes_to_rest_on_its_floor_when_the_slip_is_used_up(speed: float, belt: float) -> None:
    """A slab ends at that instant, all four nodes on the floor tell it, and then the block moves with the floor."""
    steps = list(sw.march(block(sw.Coulomb(mu=0.3), speed, belt), until=0.06, step=0.01))
    stop = abs(speed - belt) / (0.3 * GRAVITY)
    assert min(abs(s.after.time - stop) for s in steps) < 1e-6 * stop
    told = [e.time for s in steps for e in s.events if e.kind == "stick"]
    assert told[:4] == pytest.approx(np.full(4, stop), rel=1e-6)
    assert steps[-1].ledger.momentum[0] / 10.0 == pytest.approx(belt, abs=1e-4)
    assert steps[-1].ledger.dissipation == pytest.approx(0.5 * 10.0 * (speed - belt) ** 2, rel=1e-4)


@pytest.mark.parametrize(("E", "stopped"), [(1e9, True), (1e7, True), (1e6, False), (1e5, False)])
def test_friction_stops_a_block_that_swings_within_a_slab_and_lets_a_slower_one_swing(E: float, stopped: bool) -> None:
    """A quarter of a swing in shear takes the time of a wave over its height of 0.1 m; slabs are 10 ms long.

    The whole swing of the second block takes 6 ms, that of the third one 18 ms: its upper side goes on for the slab.
    """
    steps = list(sw.march(block(sw.Coulomb(mu=0.3), 0.1, E=E), until=0.06, step=0.01))
    swing, stop = 4.0 * 0.1 / np.sqrt(0.5 * E / 1000.0), 0.1 / (0.3 * GRAVITY)
    assert (swing < 0.01) == stopped
    assert (min(abs(s.after.time - stop) for s in steps) < 1e-6 * stop) == stopped


def test_a_pulled_block_tends_to_the_speed_of_viscous_friction_with_an_error_of_second_order() -> None:
    """A traction ``c v`` on a bottom of 0.1 m and a mass of 10 kg (per metre): ``v' = 5 - c v / 100``, from rest."""
    c, until, errors = 500.0, 0.2, []
    pull = sw.Gravity(acceleration=(5.0, -GRAVITY))
    scene = replace(
        block(NortonHoff(alpha=1.0, p=1.0, K=c), 0.0), loads=(pull,), start=sw.model.StaticStart(loads=(DOWN,))
    )
    for step in (0.02, 0.01):
        *_, last = sw.march(scene, until=until, step=step)
        errors.append(abs(last.ledger.momentum[0] / 10.0 - (1.0 - np.exp(-0.01 * c * until))))
    assert errors[0] < 1e-3 and np.log2(errors[0] / errors[1]) > 1.8


def test_supports_that_drive_the_nodes_in_contact_work_against_friction() -> None:
    """They set the bottom of a resting block in motion along the floor: from then on it slips at their speed."""
    speed, begun = 0.1, 0.02
    scene = block(sw.Coulomb(mu=0.3), 0.0, E=1e7)
    driven = sw.Driven(on="bottom", components="x", velocity=(0.0, speed), times=(0.0, begun))
    scene = replace(scene, bodies={**scene.bodies, "block": replace(scene.bodies["block"], supports=(driven,))})
    steps = [s for s in sw.march(scene, until=0.06, step=0.01) if s.slab.start > begun - 1e-9]
    for before, step in pairwise(steps):
        rubbed = step.ledger.contacts["floor"]
        assert rubbed.force_t == pytest.approx(0.3 * rubbed.force_n, rel=1e-9) and rubbed.force_n > 50.0
        lost = step.ledger.dissipation - before.ledger.dissipation
        assert lost == pytest.approx(rubbed.force_t * speed * step.slab.span, rel=1e-9)


def test_a_block_that_rests_at_the_start_holds_up_to_its_static_friction() -> None:
    """It is pulled by more than the friction of its slip: the rows stick, and carry the pull."""
    rough, pull = sw.laws.StaticKinetic(mu_s=0.5, mu_k=0.1), 0.15 * GRAVITY
    held = sw.Gravity(acceleration=(pull, -GRAVITY))
    scene = replace(block(rough, 0.0), loads=(held,), start=sw.model.StaticStart(loads=(held,)))
    *_, last = sw.march(scene, until=0.02, step=0.01)
    assert last.ledger.momentum[0] == pytest.approx(0.0, abs=1e-9)
    assert last.ledger.contacts["floor"].force_t == pytest.approx(10.0 * pull, rel=1e-9)


@pytest.mark.parametrize(("pull", "rests"), [(0.05, True), (0.3, True), (0.55, False)])
def test_a_block_that_has_come_to_rest_holds_up_to_its_static_friction(pull: float, rests: bool) -> None:
    """It slides against a pull: at rest it is held up to ``mu_s g``, beyond it slides back against ``mu_k g``.

    The block is flat: its nodes bear nearly the same pressure.
    """
    rough, speed = sw.laws.StaticKinetic(mu_s=0.5, mu_k=0.1), 0.1
    scene = block(rough, speed)
    flat = replace(scene.bodies["block"], mesh=sw.meshes.Rectangle(size=(0.1, 0.02), cells=(6, 3)))
    held = sw.Gravity(acceleration=(-pull * GRAVITY, -GRAVITY))
    steps = list(sw.march(replace(scene, bodies={**scene.bodies, "block": flat}, loads=(held,)), until=0.1, step=0.01))
    stop, last = speed / ((pull + 0.1) * GRAVITY), steps[-1]
    assert min(abs(s.after.time - stop) for s in steps) < 1e-6 * stop
    back = 0.0 if rests else (pull - 0.1) * GRAVITY * (last.after.time - stop)
    assert last.ledger.momentum[0] / 2.0 == pytest.approx(-back, abs=1e-4)
    assert last.ledger.contacts["floor"].force_t == pytest.approx(2.0 * GRAVITY * (pull if rests else 0.1), rel=2e-3)


def test_a_block_breaks_away_when_the_pull_reaches_static_friction() -> None:
    """A pull that grows with time: rest up to ``mu_s g``, where a slab ends, and then slip against ``mu_k g``.

    The block is flat, heavy and on smooth ground, so that it does not tip, and its nodes break away together.
    """
    rate, until, heavy, mass = 10.0, 0.6, 10.0 * GRAVITY, 2.0
    ramp = sw.bodies.Ramp(times=(0.0, until), factors=(0.0, 1.0))
    weight = sw.Gravity(acceleration=(0.0, -heavy))
    solid = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(0.1, 0.02), cells=(6, 3)), material=sw.LinearElastic(E=1e9), density=1000.0
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    rough = sw.laws.StaticKinetic(mu_s=0.04, mu_k=0.02)
    scene = sw.Scene(
        bodies={"block": solid, "floor": floor},
        contacts=(sw.Contact(between=("block.bottom", "floor"), name="floor", friction=rough),),
        loads=(weight, sw.Gravity(acceleration=(rate * until, 0.0), ramp=ramp)),
        start=sw.model.StaticStart(loads=(weight,)),
    )
    steps = list(sw.march(scene, until=until, step=0.3))
    rigid = 0.04 * heavy / rate
    away = min(steps, key=lambda s: abs(s.after.time - rigid))
    assert away.after.time == pytest.approx(rigid, rel=1e-4)
    assert sum(e.kind == "slip" for s in steps for e in s.events) == 7
    for s in steps:
        t, begun = s.after.time, away.ledger.momentum[0] / mass
        gained = 0.5 * rate * (t**2 - rigid**2) - 0.02 * heavy * (t - rigid)
        speed = begun + gained if s.before.time >= away.after.time else begun if s is away else 0.0
        assert s.ledger.momentum[0] / mass == pytest.approx(speed, abs=1e-4)


def test_a_soft_block_that_no_forces_hold_settles_without_rejections() -> None:
    """A nearly incompressible block is laid on a floor: it spreads, so that some of its corners break away at once."""
    side, E, density = 0.0109, 7.8268e8, 813.627
    solid = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(side, side), cells=(4, 4), cell="quad9"),
        material=sw.Hypoelastic(E=E, nu=0.49), density=density,
    )  # fmt: skip
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    law, nodes = StaticKinetic(mu_s=0.9, mu_k=0.45), sw.contact.NodeToSurface(nodes="both")
    contact = sw.Contact(between=("block", "floor"), name="floor", friction=law, method=nodes)
    scene = sw.Scene(
        bodies={"block": solid, "floor": floor}, contacts=(contact,), loads=(sw.Gravity(acceleration=(0.0, -2750.842)),)
    )
    steps = list(sw.march(scene, until=8.1317e-5, step=1.6263e-5))
    assert sum(s.report.iterations for s in steps) < 8 * len(steps) and not any(s.report.rejections for s in steps)
    assert any(e.kind == "slip" for s in steps for e in s.events)
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-15
    assert steps[-1].ledger.dissipation > 0.0
