"""D07: Cook's membrane: quadratic cells bend, and cells with a mean dilatation do not lock where the
material is nearly incompressible.
"""

import numpy as np
import pytest

import results
from softway.apps.verify.cases.large_deformation.d07_cooks_membrane import raised

REFERENCE = results.case("D07")["reference"]


def test_the_case() -> None:
    """16 by 16 linear cells miss the corner by 2.03 percent, 18 by 18 by less than the 2 of the case."""
    assert results.missed("D07") == {"b corner"}
    assert results.outside("D07", {"b corner": raised("b", 18, dilatation="mean")[1]}) == {"a mid"}


def test_bending() -> None:
    """Quadratic cells are within 0.1 percent; cells of first order are stiffer, 2.2 percent at 16 and 0.6 at 32."""
    middle, corner = raised("a", 16, "quad9")
    assert middle == pytest.approx(REFERENCE["a"]["uy_mid"], rel=1e-3)
    assert corner == pytest.approx(REFERENCE["a"]["uy_corner"], rel=5e-3)
    for n, missed in ((16, 0.0225), (32, 0.007)):
        assert raised("a", n)[0] == pytest.approx(REFERENCE["a"]["uy_mid"], rel=missed)


def test_nearly_incompressible_material_with_mean_dilatation() -> None:
    middle, corner = raised("b", 16, dilatation="mean")
    assert corner == pytest.approx(REFERENCE["b"]["uy_corner"], rel=0.0205)
    assert middle == pytest.approx(REFERENCE["b"]["uy_mid"], rel=0.015)
    assert raised("b", 32, dilatation="mean")[1] == pytest.approx(REFERENCE["b"]["uy_corner"], rel=0.01)


def test_plain_cells_lock() -> None:
    """Without the mean dilatation the corner rises by a third of what it should: 70 percent are missing."""
    assert raised("b", 16)[1] < 0.35 * REFERENCE["b"]["uy_corner"]


@pytest.mark.parametrize("cell", ["quad9", "tri6"])
def test_incompressible_material(cell: str) -> None:
    """Cells of second order with a pressure of first order."""
    middle, corner = raised("c", 10, cell, "corner")
    assert middle == pytest.approx(REFERENCE["c"]["uy_mid"], rel=5e-3)
    assert corner == pytest.approx(REFERENCE["c"]["uy_corner"], rel=0.012)


def test_incompressible_material_in_serendipity_cells() -> None:
    """They miss the middle by more on the same mesh, and converge with it."""
    exact = np.array([REFERENCE["c"]["uy_mid"], REFERENCE["c"]["uy_corner"]])
    coarse, fine = (np.abs(raised("c", n, "quad8", "corner") / exact - 1.0) for n in (8, 16))
    assert fine.max() < 8e-3
    assert (fine < coarse / 1.8).all()


def test_quadratic_cells_hardly_lock() -> None:
    assert raised("b", 16, "quad9")[1] == pytest.approx(REFERENCE["b"]["uy_corner"], rel=0.03)
