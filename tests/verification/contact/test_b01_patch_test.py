"""B01: a static patch of two blocks with irregular meshes that do not match, 4 and 7 elements along the interface.

The lower block rests on rollers, the upper one lies on it, held by contact alone, under a uniform pressure.
"""

import numpy as np
import pytest

import results
import softway as sw
from softway.apps.verify.cases.contact.b01_patch_test import HEIGHT, POISSON, YOUNGS, pressed, stiffer
from softway.apps.verify.exact.contact import Patch


def test_case():
    """What is missed says why in the file of the case."""
    assert results.missed("B01") == {"max |sigma_yy+1|, E2 = 10 E1" + tail for tail in ("", ", 3D")}


@pytest.mark.parametrize("dim", [2, 3])
def test_the_stress_is_uniform(dim):
    """With mortar the case allows 1e-9; what is left is rounding of positions over the displacement."""
    patch = pressed(dim)
    assert patch.missed <= 1e-9
    others = patch.stress.copy()
    others[:, 1, 1] = 0.0
    if dim == 2:
        others[:, 2, 2] += POISSON
    assert np.abs(others).max() <= 1e-9
    exact = Patch(
        pressure=1.0, layers=((HEIGHT, YOUNGS),) * 2, poisson=POISSON, plane="strain" if dim == 2 else "stress"
    )
    assert patch.settlement == pytest.approx(np.full(len(patch.settlement), exact.settlement), rel=1e-9)


@pytest.mark.parametrize(
    ("dim", "cell"), [(2, "quad8"), (2, "quad9"), pytest.param(3, "hex20", marks=pytest.mark.slow)]
)
def test_the_stress_is_uniform_in_quadratic_cells(dim, cell):
    """Uniform pressure pulls at the corners of eight-node facets; what is left is rounding here, too."""
    patch = pressed(dim, cell=cell)
    assert patch.missed <= 1e-9
    assert patch.unbalanced <= 1e-12
    assert patch.force == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize(
    ("method", "tilted"), [(sw.contact.DualMortar(), 1e-9), (sw.contact.NodeToSurface(), 1e-5)], ids=["mortar", "nodes"]
)
@pytest.mark.parametrize("dim", [2, 3])
def test_the_forces_on_both_sides_balance(dim, method, tilted):
    """The case allows 1e-12; and they carry the load, along y but for the ripple that single nodes leave."""
    patch = pressed(dim, method=method)
    assert patch.unbalanced <= 1e-12
    assert patch.sides[1] == pytest.approx(patch.force * np.eye(dim)[1], abs=tilted)
    assert patch.force == pytest.approx(1.0, abs=1e-8)


@pytest.mark.parametrize("dim", [2, 3])
def test_nodes_of_one_side_against_the_faces_of_the_other(dim):
    """The case allows 0.05 for a single pass."""
    assert pressed(dim, method=sw.contact.NodeToSurface()).missed <= 0.05


def test_nodes_of_both_sides_pass_in_the_plane():
    assert pressed(2, method=sw.contact.NodeToSurface(nodes="both")).missed <= 1e-9


@pytest.mark.parametrize("mu", [0.0, 0.3])
@pytest.mark.parametrize("dim", [2, 3])
def test_the_remaining_error_is_the_rounding_of_coordinates(dim, mu):
    """A few units in the last place of coordinates near 1, over the shortest edges, times E over the pressure.

    The upper block is held by contact alone: the digits that its free motions cost must not be lost.
    """
    shortest = 0.5 / 7
    assert pressed(dim, mu=mu).missed <= 16.0 * np.finfo(float).eps * YOUNGS / shortest


@pytest.mark.parametrize("dim", [2, 3])
def test_a_stiffer_block_on_a_softer_one(dim):
    """The border that the softer block gains beside the stiffer one bears nothing: the stress misses a share of p/E.

    In the limit of no load, extrapolated from two small ones, the patch is passed.
    """
    for load in (1e-5 * YOUNGS, 2e-5 * YOUNGS):
        assert 1.0 * load / YOUNGS <= pressed(dim, ratio=10.0, pressure=load).missed <= 2.0 * load / YOUNGS
    assert stiffer(dim) <= 5e-9
