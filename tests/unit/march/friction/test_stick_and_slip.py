"""Instants at which a stiff block on a rough floor comes to rest or breaks away, against those of a point mass."""

import numpy as np
import pytest

import softway as sw

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
