"""Mooney-Rivlin: stretches that keep the volume, change of volume, what is refused."""

import numpy as np
import pytest

from softway.errors import InputError
from softway.laws.bulk import MooneyRivlin
from softway.laws.elasticity.free_faces import completed
from softway.testing import check_law

RUBBER = MooneyRivlin(c10=0.16, c01=0.04, bulk=7.0)


def cauchy(law, stretches):
    squares = np.asarray(stretches) ** 2
    S = law.stress(np.diag(0.5 * (squares - 1.0)))
    return S.diagonal() * squares / np.prod(stretches)


@pytest.mark.few(3)
@pytest.mark.parametrize("bulk", [1e-2, 2e9])
@pytest.mark.parametrize(("c10", "c01"), [(1.0, 0.0), (0.0, 1.0), (0.3, 0.1), (1.6e5, 6e3)])
def test_examination(c10, c01, bulk):
    check_law(MooneyRivlin(c10=c10, c01=c01, bulk=bulk * max(c10, c01, 1.0) / max(1.0, 1e-4 * bulk)))


@pytest.mark.parametrize("stretch", [0.3, 0.9, 1.2, 2.0, 5.0])
def test_uniaxial_and_biaxial(stretch):
    """sigma_1 - sigma_2 = 2 (s_1^2 - s_2^2)(c10 + c01 s_3^2) at constant volume; Treloar (1975), section 5.3."""
    one = cauchy(RUBBER, [stretch, stretch**-0.5, stretch**-0.5])
    assert one[0] - one[1] == pytest.approx(2.0 * (stretch**2 - 1.0 / stretch) * (0.16 + 0.04 / stretch), rel=1e-12)
    two = cauchy(RUBBER, [stretch, stretch, stretch**-2])
    assert two[0] - two[2] == pytest.approx(2.0 * (stretch**2 - stretch**-4) * (0.16 + 0.04 * stretch**2), rel=1e-12)


@pytest.mark.parametrize("stretch", [0.7, 1.5, 3.0])
def test_bar_of_almost_incompressible_rubber(stretch):
    """Nominal stress 2 (s - s^-2)(c10 + c01/s); a bulk modulus of 1e7 leaves some 1e-7 of it."""
    law = MooneyRivlin(c10=0.3, c01=0.1, bulk=1e7)
    E = completed(law, np.array([[0.5 * (stretch**2 - 1.0)]]), (1, 2))
    nominal = float(law.stress(E)[0, 0]) * stretch
    assert nominal == pytest.approx(2.0 * (stretch - stretch**-2) * (0.3 + 0.1 / stretch), rel=1e-6)


@pytest.mark.parametrize("J", [0.5, 0.99, 1.01, 3.0])
def test_change_of_volume(J):
    """Only the pressure K/2 (J - 1/J)."""
    assert np.allclose(cauchy(RUBBER, [J ** (1 / 3)] * 3), 3.5 * (J - 1.0 / J), rtol=1e-13, atol=0.0)


@pytest.mark.parametrize("size", [1e-9, 1e-6, 1e-3])
def test_energy_of_a_small_shear_keeps_its_digits(size):
    """Simple shear g: I1 = I2 = 3 + g^2 and J = 1, so W = (c10 + c01) g^2."""
    E = 0.5 * np.array([[0.0, size, 0.0], [size, size**2, 0.0], [0.0, 0.0, 0.0]])
    assert float(RUBBER.energy(E)) == pytest.approx(0.2 * size**2, rel=1e-14)


@pytest.mark.parametrize(
    ("parameters", "where"),
    [
        ({"c10": -1.0, "bulk": 1.0}, "c10"),
        ({"c10": 1.0, "c01": -0.1, "bulk": 1.0}, "c01"),
        ({"c10": 0.0, "bulk": 1.0}, "c10"),
        ({"c10": 1.0, "bulk": 0.0}, "bulk"),
        ({"c10": float("inf"), "bulk": 1.0}, "c10"),
    ],
)
def test_impossible_constants_are_refused(parameters, where):
    with pytest.raises(InputError) as error:
        MooneyRivlin(**parameters)
    assert error.value.where == where and error.value.remedy


def test_impossible_strain_has_infinite_energy_without_warning():
    for E in (np.diag([-0.6, 0.0, 0.0]), np.full((3, 3), np.nan)):
        assert RUBBER.energy(E) == np.inf
