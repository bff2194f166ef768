"""Laws of friction: shapes, limits, derivatives, and bad parameters."""

import numpy as np
import pytest

from softway.errors import InputError
from softway.laws import friction
from softway.testing.friction import check_friction

LAWS = [
    friction.Frictionless(),
    friction.Coulomb(mu=0.3),
    friction.StaticKinetic(mu_s=0.4, mu_k=0.2),
    friction.Tresca(shear=2.0),
    friction.NortonHoff(alpha=0.9, p=0.5, K=3.0),
    friction.NortonHoff(alpha=0.9, p=1.0, K=3.0),
    friction.NortonHoff(alpha=0.9, p=2.0, K=3.0, v0=0.5),
    friction.LimitedViscoplastic(alpha=0.5, p=0.7, K=4.0, mbar=0.6, sigma_eq=5.0, mu=0.2),
    friction.Stribeck(mu_s=0.5, mu_k=0.3, v_s=0.2, delta=2.0, viscous=0.05),
    friction.Lubricated(viscosity=0.1, film=0.01),
]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_a_law_is_sound(law):
    check_friction(law)


def test_every_law_is_examined():
    assert {type(law).__name__ for law in LAWS} == set(friction.__all__)


@pytest.mark.parametrize(
    ("law", "given", "where"),
    [
        (friction.Coulomb, {"mu": -0.1}, "mu"),
        (friction.Coulomb, {"mu": np.nan}, "mu"),
        (friction.Coulomb, {"mu": np.inf}, "mu"),
        (friction.StaticKinetic, {"mu_s": 0.1, "mu_k": 0.2}, "mu_s"),
        (friction.Tresca, {"shear": -1.0}, "shear"),
        (friction.NortonHoff, {"alpha": 1.0, "p": 0.0}, "p"),
        (friction.NortonHoff, {"alpha": -1.0, "p": 1.0}, "alpha"),
        (friction.Stribeck, {"mu_s": 0.2, "mu_k": 0.1, "v_s": 0.0}, "v_s"),
        (friction.Stribeck, {"mu_s": 0.1, "mu_k": 0.2, "v_s": 1.0}, "mu_s"),
        (friction.Lubricated, {"viscosity": 0.1, "film": 0.0}, "film"),
    ],
)
def test_bad_parameters_are_refused(law, given, where):
    with pytest.raises(InputError) as refused:
        law(**given)
    assert refused.value.where == where


def test_the_limited_law_is_the_least_of_three():
    law = friction.LimitedViscoplastic(alpha=1.0, p=1.0, K=1.0, mbar=1.0, sigma_eq=np.sqrt(3.0) * 5.0, mu=0.5)
    speed, pressure = np.array([1.0, 100.0, 100.0]), np.array([100.0, 100.0, 4.0])
    assert law.resistance(speed, pressure)[0] == pytest.approx([1.0, 5.0, 2.0])


@pytest.mark.parametrize(
    ("law", "pressure"),
    [
        (friction.NortonHoff(alpha=0.5, p=0.2, K=0.0), 1.0),
        (friction.LimitedViscoplastic(alpha=0.0, p=0.2, K=1.0, mbar=1.0, sigma_eq=1.0, mu=0.5), 1.0),
        (friction.Stribeck(mu_s=0.5, mu_k=0.3, v_s=0.2, delta=0.5), 0.0),
    ],
)
def test_a_law_without_force_has_no_slope_at_rest(law, pressure):
    """Zero times an infinite slope was no number."""
    for found in law.resistance(np.zeros(2), np.full(2, pressure)):
        assert np.isfinite(found).all()
