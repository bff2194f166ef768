"""Laws: the public examination, exact solutions, digits at tiny strain, and what is refused."""

from decimal import Decimal, localcontext

import numpy as np
import pytest

from softway.errors import InputError
from softway.laws.bulk import Hencky, LinearElastic, NeoHookean, StVenantKirchhoff
from softway.laws.elasticity.elastic_constants import lame
from softway.laws.law import StoredEnergy
from softway.testing import check_law
from softway.units import Pascal

LAWS = (LinearElastic, StVenantKirchhoff, NeoHookean, Hencky)


@pytest.mark.few(6)
@pytest.mark.parametrize("kind", LAWS)
@pytest.mark.parametrize("nu", [-0.4, 0.0, 0.3, 0.499])
@pytest.mark.parametrize("E", [1.0, 2.1e11])
def test_examination(kind: type[StoredEnergy], E: Pascal, nu: float) -> None:
    check_law(kind(E=E, nu=nu))


def exact_neo_hookean(H: np.ndarray, E: float, nu: float) -> Decimal:
    """W of the displacement gradient with 60 digits."""
    with localcontext() as context:
        context.prec = 60
        modulus, ratio = Decimal(E), Decimal(nu)
        bulk_part = modulus * ratio / ((1 + ratio) * (1 - 2 * ratio))
        shear = modulus / (2 * (1 + ratio))
        F = [[Decimal(float(H[i, j])) + (1 if i == j else 0) for j in range(3)] for i in range(3)]
        I1 = sum(x * x for row in F for x in row)
        cyclic = ((0, 1, 2), (1, 2, 0), (2, 0, 1))
        J = sum(F[0][i] * (F[1][j] * F[2][k] - F[1][k] * F[2][j]) for i, j, k in cyclic)
        logarithm = J.ln()
        return shear / 2 * (I1 - 3 - 2 * logarithm) + bulk_part / 2 * logarithm**2


@pytest.mark.parametrize("size", [1e-9, 1e-6, 1e-3, 4e-3, 6e-3, 1e-1])
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.49])
def test_neo_hookean_energy_keeps_its_digits(size: float, nu: float) -> None:
    law = NeoHookean(E=2.0, nu=nu)
    for H in (np.diag([1.0, 0.0, 0.0]), np.array([[0.3, -0.8, 0.5], [0.9, -0.4, 0.2], [-0.1, 0.6, 0.7]])):
        strain = law.measure.strain((size * H).T, np.eye(3))
        exact = float(exact_neo_hookean(size * H, 2.0, nu))
        assert float(law.energy(strain)) == pytest.approx(exact, rel=1e-12)


def test_neo_hookean_without_poisson_effect_in_one_direction() -> None:
    law, stretch = NeoHookean(E=2.0), np.array([0.3, 0.9, 1.0, 1.7])
    E = np.zeros((4, 3, 3))
    E[:, 0, 0] = 0.5 * (stretch**2 - 1.0)
    nominal = stretch * law.stress(E)[:, 0, 0]
    assert np.allclose(nominal, stretch - 1.0 / stretch, rtol=1e-14, atol=1e-15)


def test_neo_hookean_under_pure_volume_change() -> None:
    law, stretch = NeoHookean(E=2.0, nu=0.3), 1.3
    bulk_part, shear = lame(2.0, 0.3)
    S = law.stress(0.5 * (stretch**2 - 1.0) * np.eye(3))
    J = stretch**3
    pressure = (shear * (stretch**2 - 1.0) + bulk_part * np.log(J)) / J  # Cauchy: (mu (b - I) + lambda ln J I)/J
    assert np.allclose(S * stretch**2 / J, pressure * np.eye(3), rtol=1e-14)


def test_laws_agree_at_small_strain() -> None:
    e = 1e-8 * np.array([[1.0, 0.4, 0.1], [0.4, -2.0, 0.3], [0.1, 0.3, 0.5]])
    expected = LinearElastic(E=3.0, nu=0.2).stress(e)
    for kind in (StVenantKirchhoff, NeoHookean):
        assert np.allclose(kind(E=3.0, nu=0.2).stress(e), expected, rtol=1e-6, atol=1e-7 * np.abs(expected).max())


@pytest.mark.parametrize("kind", LAWS)
@pytest.mark.parametrize(
    ("parameters", "where"),
    [
        ({"E": 0.0}, "E"),
        ({"E": -1.0}, "E"),
        ({"E": float("nan")}, "E"),
        ({"E": 1.0, "nu": 0.51}, "nu"),
        ({"E": 1.0, "nu": -1.0}, "nu"),
    ],
)
def test_impossible_moduli_are_refused(kind: type[StoredEnergy], parameters: dict[str, float], where: str) -> None:
    with pytest.raises(InputError) as error:
        kind(**parameters)
    assert error.value.where == where
    assert error.value.remedy


def test_impossible_strain_has_infinite_energy_without_warning() -> None:
    law = NeoHookean(E=1.0, nu=0.3)
    E = np.diag([-0.6, 0.0, 0.0])
    assert law.energy(E) == np.inf
    assert np.isnan(law.stress(E)).any()
    assert np.isnan(law.tangent(E)).any()
