"""Hencky's law: simple shear, stretches, repeated principal values."""

import numpy as np
import pytest

from softway.laws.bulk import Hencky, LinearElastic
from softway.laws.elasticity.elastic_constants import lame
from softway.laws.elasticity.free_faces import completed


def cauchy(law, F):
    S = law.stress(0.5 * (F.T @ F - np.eye(3)))
    return F @ S @ F.T / np.linalg.det(F)


@pytest.mark.parametrize(
    ("shear", "tangential", "normal"),
    [(1.0, 0.860818, 0.430409), (2.0, 1.246450, 1.246450), (4.0, 1.291227, 2.582454), (8.0, 1.016085, 4.064339)],
)
def test_simple_shear(shear, tangential, normal):
    """The values of the closed form, and the form itself: 4 mu arsinh(g/2)/sqrt(4 + g^2) and g/2 of it."""
    F = np.eye(3)
    F[0, 1] = shear
    sigma = cauchy(Hencky(E=2.0, nu=0.0), F)
    exact = 4.0 * np.arcsinh(0.5 * shear) / np.sqrt(4.0 + shear**2)
    assert exact == pytest.approx(tangential, abs=1e-6) and 0.5 * shear * exact == pytest.approx(normal, abs=1e-6)
    expected = exact * np.array([[0.5 * shear, 1.0, 0.0], [1.0, -0.5 * shear, 0.0], [0.0, 0.0, 0.0]])
    assert np.allclose(sigma, expected, rtol=0.0, atol=1e-13 * shear**2)


@pytest.mark.parametrize("stretch", [0.2, 0.9, 1.0 + 1e-9, 1.5, 4.0])
def test_bar(stretch):
    """Free lateral faces: J sigma = E ln(stretch), lateral stretch = stretch^-nu."""
    law = Hencky(E=3.0, nu=0.3)
    E = completed(law, np.array([[0.5 * (stretch**2 - 1.0)]]), (1, 2))
    assert 1.0 + 2.0 * E[1, 1] == pytest.approx(stretch**-0.6, rel=1e-13)
    axial = np.log1p(2.0 * E[0, 0]) / 2.0  # of the strain as it is rounded
    assert float(law.stress(E)[0, 0]) * (1.0 + 2.0 * E[0, 0]) == pytest.approx(3.0 * axial, rel=1e-12)


@pytest.mark.parametrize("size", [1e-12, 1e-9, 1e-6, 1e-3, 0.3])
def test_energy_keeps_its_digits(size):
    bulk_part, shear = lame(2.0, 0.3)
    law = Hencky(E=2.0, nu=0.3)
    h = 0.5 * np.log1p(2.0 * size * np.array([1.0, -1.0]))
    exact = shear * (h @ h) + 0.5 * bulk_part * h.sum() ** 2
    E = np.zeros((3, 3))
    E[0, 1] = E[1, 0] = size
    assert float(law.energy(E)) == pytest.approx(exact, rel=1e-14)


@pytest.mark.parametrize("apart", [0.0, 1e-17, 1e-12, 1e-9, 1e-6])
def test_moduli_of_principal_values_that_meet(apart):
    """At E = e I: 2 (mu - tau)/c^2 between axes, lambda/c^2 more along them; nothing is lost near it."""
    law, e = Hencky(E=2.0, nu=0.3), 0.2
    bulk_part, shear = lame(2.0, 0.3)
    c, tau = 1.4, (2.0 * shear + 3.0 * bulk_part) * 0.5 * np.log(1.4)
    between = 2.0 * (shear - tau) / c**2
    C = law.tangent(np.diag([e, e + apart, e - apart]))
    expected = np.einsum("ij,kl->ijkl", np.eye(3), np.eye(3)) * bulk_part / c**2
    expected += (
        0.5 * between * (np.einsum("ik,jl->ijkl", *[np.eye(3)] * 2) + np.einsum("il,jk->ijkl", *[np.eye(3)] * 2))
    )
    assert np.allclose(C, expected, rtol=0.0, atol=1e-14 + 10.0 * apart)


def test_it_is_hookes_law_at_small_strain():
    e = 1e-8 * np.array([[1.0, 0.4, 0.1], [0.4, -2.0, 0.3], [0.1, 0.3, 0.5]])
    expected = LinearElastic(E=3.0, nu=0.2).stress(e)
    assert np.allclose(Hencky(E=3.0, nu=0.2).stress(e), expected, rtol=0.0, atol=1e-7 * np.abs(expected).max())


def test_impossible_strain_has_infinite_energy_without_warning():
    law = Hencky(E=1.0, nu=0.3)
    for E in (np.diag([-0.6, 0.0, 0.0]), np.full((3, 3), np.nan)):
        assert law.energy(E) == np.inf
        assert np.isnan(law.stress(E)).all() and np.isnan(law.tangent(E)).any()
