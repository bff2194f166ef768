"""Free lateral faces."""

from itertools import product

import numpy as np
import pytest
from scipy.optimize import brentq

from softway.laws.bulk import Hencky, LinearElastic, MooneyRivlin, NeoHookean, StVenantKirchhoff
from softway.laws.elasticity.elastic_constants import lame
from softway.laws.elasticity.free_faces import completed, condensed
from softway.laws.law import StoredEnergy

LAWS = [
    LinearElastic(E=2.0, nu=0.3),
    StVenantKirchhoff(E=2.0, nu=0.3),
    NeoHookean(E=2.0, nu=0.3),
    NeoHookean(E=2.0, nu=0.49),
    Hencky(E=2.0, nu=0.3),
    MooneyRivlin(c10=0.3, c01=0.05, bulk=8.0),
]


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("m", "free"), [(1, (1, 2)), (2, (2,))])
def test_lateral_stress_vanishes(law: StoredEnergy, m: int, free: tuple[int, ...]) -> None:
    along = np.array([[0.3, 0.1], [0.1, -0.2]])[:m, :m] * np.array([1e-9, 1e-6, 1e-3, 1.0])[:, None, None]
    E = completed(law, along, free)
    S = law.stress(E)
    assert np.all(np.abs(S[:, free, free]).max(axis=-1) <= 1e-14 * np.abs(along).max(axis=(-1, -2)) * 2.0)
    assert np.array_equal(E[:, :m, :m], along)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("m", "free"), [(1, (1, 2)), (2, (2,))])
def test_condensed_moduli_are_the_derivative_of_the_stress(law: StoredEnergy, m: int, free: tuple[int, ...]) -> None:
    along, change = np.array([[0.3, 0.1], [0.1, -0.2]])[:m, :m], np.array([[1.0, 0.4], [0.4, -0.7]])[:m, :m]
    step = 1e-5
    plus, minus = (law.stress(completed(law, along + s * change, free))[:m, :m] for s in (step, -step))
    C = condensed(law.tangent(completed(law, along, free)), m, free)
    slope = (plus - minus) / (2.0 * step)
    assert np.allclose(np.einsum("ijkl,kl->ij", C, change), slope, atol=1e-8 * np.abs(slope).max())


def test_bar_of_st_venant_kirchhoff_is_linear_in_strain() -> None:
    """Uniaxial stress: E_lateral = -nu E_axial and S = E_young E_axial for every strain."""
    axial = np.array([-0.4, -0.01, 0.5, 1.5])
    law = StVenantKirchhoff(E=2.0, nu=0.3)
    E = completed(law, axial[:, None, None], (1, 2))
    assert np.allclose(E[:, 1, 1], -0.3 * axial, rtol=1e-13)
    assert np.allclose(law.stress(E)[:, 0, 0], 2.0 * axial, rtol=1e-13)


@pytest.mark.parametrize(
    ("nu", "stretch"),
    [*product([0.0, 0.3, 0.499], [0.01, 0.05, 0.5, 1.0001, 3.0, 50.0]), (-0.3, 0.9), (-0.3, 1.1), (-0.3, 3.0)],
)
def test_bar_of_neo_hookean_takes_the_lateral_stretch_of_its_equation(nu: float, stretch: float) -> None:
    """``mu (b^2 - 1) + lambda ln(stretch b^2) = 0`` for the lateral stretch b."""
    bulk_part, shear = lame(1.0, nu)
    least = np.sqrt(max(-bulk_part / shear, 1e-6))  # at nu < 0 the greater of two roots is the one of small strain
    lateral = brentq(
        lambda b: shear * (b * b - 1.0) + bulk_part * np.log(stretch * b * b), least, 1e3, xtol=1e-15, rtol=1e-15
    )
    E = completed(NeoHookean(E=1.0, nu=nu), np.array([[[0.5 * (stretch**2 - 1.0)]]]), (1, 2))
    assert 1.0 + 2.0 * E[0, 1, 1] == pytest.approx(lateral**2, rel=1e-11)
    assert E[0, 1, 1] == pytest.approx(E[0, 2, 2], rel=1e-14)


def test_no_lateral_strain_is_quietly_nan() -> None:
    """St. Venant-Kirchhoff at nu = 0.3 has no width left beyond an axial strain of 1/(2 nu)."""
    E = completed(StVenantKirchhoff(E=1.0, nu=0.3), np.array([[[2.0]], [[0.1]]]), (1, 2))
    assert np.isnan(E[0, 1, 1])
    assert E[1, 1, 1] == pytest.approx(-0.03, rel=1e-13)
