"""Orthotropic elasticity: compliance along each axis, rotated axes, plates, waves, what is refused."""

import numpy as np
import pytest

from softway.bodies.elements.section import Bar, PlaneStress, Volume, wave_speed
from softway.errors import InputError
from softway.laws.bulk import LinearElastic, LinearOrthotropic, StVenantKirchhoff
from softway.laws.elasticity.elastic_constants import wave_modulus
from softway.laws.elasticity.free_faces import completed, condensed
from softway.laws.strain_measures import Green, Small
from softway.testing import check_law

E1, E2, E3 = 14.0, 1.0, 0.7
N12, N13, N23 = 0.3, 0.45, 0.4
WOOD = {"E": (E1, E2, E3), "nu": (N12, N13, N23), "G": (0.9, 1.1, 0.1)}
TILTED = {**WOOD, "axes": ((1.0, 1.0, 0.5), (1.0, -1.0, 0.0))}


@pytest.mark.parametrize("measure", [Small(), Green()])
@pytest.mark.parametrize("given", [WOOD, TILTED], ids=["straight", "tilted"])
def test_examination(given, measure):
    check_law(LinearOrthotropic(measure=measure, **given))


@pytest.mark.parametrize(
    ("axis", "strain"),
    [
        (0, (1 / E1, -N12 / E1, -N13 / E1)),
        (1, (-N12 / E1, 1 / E2, -N23 / E2)),
        (2, (-N13 / E1, -N23 / E2, 1 / E3)),
    ],
)
def test_pull_along_each_axis(axis, strain):
    S = LinearOrthotropic(**WOOD).stress(np.diag(strain))
    expected = np.zeros((3, 3))
    expected[axis, axis] = 1.0
    assert np.allclose(S, expected, rtol=0.0, atol=1e-14)


@pytest.mark.parametrize(("pair", "modulus"), [((0, 1), 0.9), ((0, 2), 1.1), ((1, 2), 0.1)])
def test_shear_in_each_plane(pair, modulus):
    e = np.zeros((3, 3))
    e[pair] = e[pair[::-1]] = 0.5
    assert np.allclose(LinearOrthotropic(**WOOD).stress(e), 2.0 * modulus * e, rtol=1e-14, atol=1e-16)


def test_tilted_axes_turn_the_law():
    e = np.array([[0.2, -0.07, 0.03], [-0.07, -0.1, 0.11], [0.03, 0.11, 0.05]])
    first, second = (np.array(a) / np.linalg.norm(a) for a in TILTED["axes"])
    Q = np.stack([first, second, np.cross(first, second)], axis=1)
    expected = Q @ LinearOrthotropic(**WOOD).stress(Q.T @ e @ Q) @ Q.T
    assert np.allclose(LinearOrthotropic(**TILTED).stress(e), expected, rtol=0.0, atol=1e-14)


def test_modulus_across_the_grain():
    """4/E(45 deg) = 1/E1 + 1/E2 + 1/G12 - 2 nu12/E1; Lekhnitskii (1963), section 9."""
    law = LinearOrthotropic(**WOOD, axes=((1.0, 1.0, 0.0), (-1.0, 1.0, 0.0)))
    assert law.youngs() == pytest.approx(4.0 / (1 / E1 + 1 / E2 + 1 / 0.9 - 2.0 * N12 / E1), rel=1e-13)
    assert LinearOrthotropic(**WOOD).youngs() == pytest.approx(E1, rel=1e-13)


def test_equal_axes_are_isotropic():
    shear = 2.0 / 2.6
    e = np.array([[0.2, -0.07, 0.03], [-0.07, -0.1, 0.11], [0.03, 0.11, 0.05]])
    for measure, same in ((Small(), LinearElastic(E=2.0, nu=0.3)), (Green(), StVenantKirchhoff(E=2.0, nu=0.3))):
        law = LinearOrthotropic(E=(2.0,) * 3, nu=(0.3,) * 3, G=(shear,) * 3, measure=measure)
        assert law.linear is same.linear
        assert np.allclose(law.stress(e), same.stress(e), rtol=1e-14, atol=1e-15)
        assert law.wave_speed(3.0) == pytest.approx(same.wave_speed(3.0), rel=1e-13)


@pytest.mark.parametrize("measure", [Small(), Green()])
def test_plate(measure):
    """Plane stress: Q11 = E1/(1 - nu12 nu21), and the thickness follows both strains with its own ratio."""
    law = LinearOrthotropic(measure=measure, **WOOD)
    along = np.array([[0.02, 0.005], [0.005, -0.01]])
    E = completed(law, along, (2,))
    assert abs(law.stress(E)[2, 2]) < 1e-15
    Q = condensed(law.moduli(), 2, (2,))
    assert Q[0, 0, 0, 0] == pytest.approx(E1 / (1.0 - N12**2 * E2 / E1), rel=1e-13)
    assert np.allclose(law.stress(E)[:2, :2], np.einsum("ijkl,kl", Q, along), rtol=1e-13, atol=1e-16)


@pytest.mark.parametrize("given", [WOOD, TILTED], ids=["straight", "tilted"])
def test_no_wave_is_faster_than_reported(given):
    C = LinearOrthotropic(**given).moduli()
    directions = np.random.default_rng(1).standard_normal((20000, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    acoustic = np.einsum("ijkl,nj,nl->nik", C, directions, directions)
    sampled = np.linalg.eigvalsh(acoustic).max()
    assert sampled <= wave_modulus(C) * (1.0 + 1e-12) and sampled > wave_modulus(C) * 0.999


def test_waves_along_the_cell():
    law = LinearOrthotropic(**WOOD)
    assert wave_speed(law, 4.0, Bar()) == pytest.approx(np.sqrt(E1 / 4.0), rel=1e-13)
    assert wave_speed(law, 4.0, PlaneStress()) == pytest.approx(np.sqrt(E1 / (1.0 - N12**2 * E2 / E1) / 4.0), rel=1e-13)
    assert wave_speed(law, 4.0, Volume()) == pytest.approx(law.wave_speed(4.0), rel=1e-13)


@pytest.mark.parametrize(
    ("change", "where", "problem"),
    [
        ({"E": (1.0, 0.0, 1.0)}, "E[1]", "not positive"),
        ({"G": (1.0, 1.0, -1.0)}, "G[2]", "not positive"),
        ({"nu": (4.0, 0.1, 0.1)}, "nu[0]", "sqrt"),
        ({"nu": (0.3, 0.3, 1.3)}, "nu[2]", "sqrt"),
        ({"E": (1.0, 1.0, 1.0), "nu": (0.6, 0.6, 0.6)}, "nu", "no positive energy"),
        ({"axes": ((1.0, 0.0, 0.0), (1.0, 1.0, 0.0))}, "axes", "perpendicular"),
        ({"axes": ((0.0, 0.0, 0.0), (1.0, 1.0, 0.0))}, "axes", "perpendicular"),
    ],
)
def test_impossible_constants_are_refused(change, where, problem):
    with pytest.raises(InputError, match=problem) as error:
        LinearOrthotropic(**{**WOOD, **change})
    assert error.value.where == where and error.value.remedy
