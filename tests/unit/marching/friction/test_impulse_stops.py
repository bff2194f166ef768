"""Stops, reversals and oblique impacts with friction and the rules Impulse and Paper; the balance of energy."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.apps.verify.scenes import sliding

G = 9.81
RULES = [sw.contact.Impulse(), sw.contact.Paper()]
ENERGY = sw.contact.Energy()


def with_rule(scene, rule):
    return replace(scene, contacts=tuple(replace(one, timing=rule) for one in scene.contacts))


def impact(rule, *, cells, step, until, mu=0.2, tilt=0.0, drop=0.0):
    """Last slab of the oblique impact of an elastic block of 10 kg on a plane turned by ``tilt``."""
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(0.1, 0.1), cells=(cells, cells)),
        material=sw.LinearElastic(E=1e6, nu=0.3),
        density=1000.0,
        velocity=sw.bodies.Uniform(value=(2.0, -1.0)),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -drop), normal=(np.sin(tilt), np.cos(tilt))))
    friction = sw.Coulomb(mu=mu) if mu else sw.laws.Frictionless()
    contact = sw.Contact(between=("block.bottom", "floor"), friction=friction, timing=rule)
    scene = sw.Scene(bodies={"block": block, "floor": floor}, contacts=(contact,))
    return list(sw.march(scene, until=until, step=step))[-1]


@pytest.mark.parametrize("rule", RULES, ids=str)
def test_a_reversal_is_located(rule):
    """A block thrown up an incline slides back: the slabs of the turn leave no error."""
    slope, mu, speed = np.deg2rad(20.0), 0.2, 1.0
    up, down = (G * (np.sin(slope) + sign * mu * np.cos(slope)) for sign in (1.0, -1.0))
    stop = speed / up
    for step in (0.021, 0.0105):
        scene = with_rule(sliding.incline(20.0, mu, speed, cells=(2, 1)), rule)
        steps = list(sw.march(scene, until=0.4, step=step))
        late = steps[-1].after.time - stop
        place = steps[-1].after.displacement["b"][:, 0].mean()
        assert any(s.after.time == pytest.approx(stop, abs=1e-9) for s in steps)
        assert place == pytest.approx(0.5 * speed * stop - 0.5 * down * late**2, abs=1e-7)
        assert steps[-1].ledger.momentum[0] / 20.0 == pytest.approx(-down * late, abs=1e-5)
        assert np.diff([s.ledger.dissipation for s in steps]).min() >= 0.0


@pytest.mark.parametrize("rule", RULES, ids=str)
def test_the_stop_tends_to_that_of_the_energy_rule(rule):
    """The energy rule locates the stop; here it is at the end of a slab, which shrinks: of second order."""
    slope = np.deg2rad(20.0)
    brake = G * (np.sin(slope) + 0.5 * np.cos(slope))
    scene = sliding.incline(20.0, 0.5, 1.0, cells=(2, 1))
    off = []
    for step in (0.04, 0.01):
        ends = [list(sw.march(with_rule(scene, one), until=0.2, step=step))[-1] for one in (rule, ENERGY)]
        ours, theirs = (s.after.displacement["b"][:, 0].mean() for s in ends)
        off.append(abs(ours - theirs))
        assert theirs == pytest.approx(0.5 / brake, rel=1e-5)
        assert off[-1] < brake * step**2 / 8.0 + 1e-6


@pytest.mark.parametrize("rule", RULES, ids=str)
def test_the_balance_of_energy_closes_through_a_stop(rule):
    """In slabs without touch and release friction leaves no error, also where the block comes to rest."""
    scene = with_rule(sliding.incline(20.0, 0.5, 1.0, cells=(2, 1)), rule)
    last, closed = 0.0, 0
    for s in sw.march(scene, until=0.3, step=0.01):
        if not any(event.kind in ("touch", "release") for event in s.events):
            closed += 1
            assert abs(s.ledger.energy_error - last) < 1e-13 * 10.0
        last = s.ledger.energy_error
    assert closed > 10


@pytest.mark.slow
def test_touches_and_releases_err_as_without_friction():
    """The error of the energy is that of the events of the normal motion, and shrinks with them."""
    found = {
        mu: [
            abs(impact(RULES[0], cells=3, step=step, until=4e-3, mu=mu, tilt=0.02, drop=1e-3).ledger.energy_error)
            for step in (1e-4, 2.5e-5)
        ]
        for mu in (0.0, 0.3, 5.0)
    }
    assert found[0.0][0] < 1e-2
    for errors in found.values():
        assert errors[0] < 1.1 * found[0.0][0]
        assert np.log(errors[0] / errors[1]) / np.log(4.0) > 1.2


@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES, ids=str)
def test_oblique_impacts_tend_to_those_of_the_energy_rule(rule):
    """Sliding impact and rebound: places on finer meshes, with slabs in proportion; the kicks vanish."""
    off = []
    for cells in (4, 8):
        pair = [impact(one, cells=cells, step=4e-4 / cells, until=4e-3) for one in (rule, ENERGY)]
        places = [s.after.displacement["block"] for s in pair]
        off.append(np.sqrt(((places[0] - places[1]) ** 2).mean()))
    assert off[0] < 3e-4
    assert np.log2(off[0] / off[1]) > 1.4


@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES, ids=str)
def test_an_oblique_impact_is_of_first_order_in_time(rule):
    """The jump of the velocity along the surface is not in the path inside the slab of the touch."""
    places = [impact(rule, cells=2, step=1e-4 / 2**k, until=2e-3).after.displacement["block"] for k in range(4)]
    first, second, third = (np.linalg.norm(a - b) for a, b in zip(places, places[1:], strict=False))
    assert 0.9 < np.log2(first / second) < 1.2
    assert 0.9 < np.log2(second / third) < 1.2
