"""Two balls and a roller in space under the rule Impulse: touches of neighbouring nodes in one slab (time step)."""

import numpy as np
import pytest

import softway as sw

pytestmark = pytest.mark.slow


def balls_on_roller(seed: int = 0) -> sw.Scene:
    """A ball falls on a roller, and a faster one on this ball, off centre."""
    rng = np.random.default_rng(seed)
    places = ((0.0, 0.0, 0.171), (0.04 * float(rng.uniform(-1, 1)), 0.03 * float(rng.uniform(-1, 1)), 0.268))
    bodies: dict[str, sw.Solid | sw.Tool] = {}
    for k, place in enumerate(places):
        aside = float(rng.normal()) * 0.3, float(rng.normal()) * 0.3
        turn = sw.bodies.Rotation(axis=(1.0, 0.3, 0.2), angle=float(rng.uniform(0, 1)))
        bodies["ab"[k]] = sw.Solid(
            mesh=sw.meshes.Ball(radius=0.05, cells=4),
            material=sw.NeoHookean(E=1e6, nu=0.3),
            density=1000.0,
            velocity=sw.bodies.Uniform(value=(*aside, -1.0 - 2.0 * k)),
            place=sw.bodies.Placement(translation=place, rotations=(turn,)),
        )
    bodies["roller"] = sw.Tool(shape=sw.obstacles.Roller(point=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0), radius=0.12))
    pairs = (("a", "roller"), ("b", "roller"), ("a", "b"))
    contacts = tuple(sw.Contact(between=pair, timing=sw.contact.Impulse()) for pair in pairs)
    return sw.Scene(bodies=bodies, contacts=contacts, loads=(sw.Gravity(acceleration=(0.0, 0.0, -9.81)),))


def test_a_node_that_another_touch_pushes_away_is_not_pulled_back():
    """It was below its opponent before the other touch was known; to stop it would give 1.2 percent of the energy."""
    steps = list(sw.march(balls_on_roller(), until=0.003, step=2.5e-4))
    energy = steps[0].ledger.energy_kinetic
    touches = [e for s in steps for e in s.events if e.kind == "touch"]
    assert {e.contact for e in touches} == {"a-roller", "a-b"}
    assert all(e.velocity_before <= 0.0 <= e.impulse for e in touches)
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-3 * energy
    assert not any(s.report.rejections for s in steps)


@pytest.mark.parametrize("seed", [7, *(pytest.param(s, marks=pytest.mark.minutes) for s in (5, 10, 12, 17))])
def test_no_slab_gives_much_energy(seed: int):
    """Nodes go over edges of the other ball, and edges around a corner that lies on a facet are nearly parallel rows.

    A facet round the corner has a plane behind which the node lies by 4 mm; parallel rows moved a node by .7 mm aside.
    """
    steps = list(sw.march(balls_on_roller(seed), until=0.012, step=2.5e-4))
    energy = steps[0].ledger.energy_kinetic
    assert len(steps) < 60
    assert max(abs(s.ledger.energy_error) for s in steps) < 2e-2 * energy
    assert max(s.certificate.energy_error for s in steps) < 1e-2 * energy
    for step in steps:
        for name, after in step.after.displacement.items():
            fastest = max(np.abs(v[name]).max() for v in (step.before.velocity, step.after.velocity))
            assert np.abs(after - step.before.displacement[name]).max() < 1.5 * fastest * step.slab.span
