"""The rigid collision with friction."""

import numpy as np
import pytest

import softway as sw
from softway.apps.verify.exact.rigid_impact import collide


def tilted(angle: float) -> np.ndarray:
    """Inverse inertia of the end of a rod of length and mass 1."""
    x, y = -0.5 * np.cos(angle), -0.5 * np.sin(angle)
    end = np.array([[1.0, 0.0, -y], [0.0, 1.0, x]])
    return end @ np.diag([1.0, 1.0, 12.0]) @ end.T


def marched(W, velocity, mu, restitution, pieces=20_000):
    """The same by small normal impulses: slip, or stick where friction holds."""
    v, impulse, until = np.array(velocity, float), np.zeros(2), np.inf
    dp = 2.0 / pieces
    while impulse[1] < until:
        hold = -(v[0] / dp + W[0, 1]) / W[0, 0]
        rate = np.array([np.clip(hold, -mu, mu), 1.0])
        impulse, v = impulse + dp * rate, v + dp * (W @ rate)
        if until == np.inf and v[1] >= 0.0:
            until = (1.0 + restitution) * impulse[1]
    return impulse, v


@pytest.mark.parametrize("mu", [0.1, 0.3, 0.6, 1.3])
@pytest.mark.parametrize("slip", [-0.4, 0.0, 0.2, 0.5])
def test_it_is_the_limit_of_small_impulses(mu, slip):
    W, before = tilted(0.7), np.array([slip, -1.0])
    met = collide(W, before, mu=mu, restitution=0.5)
    impulse, after = marched(W, before, mu, 0.5)
    assert met.impulse == pytest.approx(impulse, abs=1e-3)
    assert met.velocity == pytest.approx(after, abs=1e-3)
    assert met.dissipated >= -1e-15
    assert abs(met.impulse[0]) <= mu * met.impulse[1] * (1.0 + 1e-12)


def test_energy_is_kept_without_friction_and_with_full_restitution():
    met = collide(tilted(0.7), np.array([0.3, -1.0]), restitution=1.0)
    assert met.velocity[1] == pytest.approx(1.0, rel=1e-14)
    assert met.dissipated == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize(
    ("given", "where"),
    [
        ({"inverse_inertia": -np.eye(2)}, "inverse_inertia"),
        ({"velocity": np.array([0.0, 1.0])}, "velocity"),
        ({"mu": -0.1}, "mu"),
        ({"restitution": 1.5}, "restitution"),
    ],
)
def test_wrong_numbers_are_named(given, where):
    right = {"inverse_inertia": np.eye(2), "velocity": np.array([0.0, -1.0])}
    with pytest.raises(sw.InputError) as error:
        collide(**{**right, **given})
    assert where in str(error.value)
