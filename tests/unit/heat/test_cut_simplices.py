"""Liquid part of simplices that the temperature of melting cuts: exact volumes, means over a range, derivatives."""

import numpy as np
import pytest

from softway.bodies.elements.cut_cells import liquid_part, melted_part, simplices_of
from softway.meshes.cells import CELLS


@pytest.mark.parametrize("corners", [2, 3, 4])
def test_the_liquid_part_and_the_solid_part_are_the_whole(corners: int) -> None:
    over = np.random.default_rng(corners).normal(size=(400, corners))
    liquid, solid = liquid_part(over).sum(axis=2), liquid_part(-over).sum(axis=2)
    assert liquid + solid == pytest.approx(np.full(over.shape, 1.0 / corners), abs=1e-14)
    assert (liquid >= -1e-15).all() and (solid >= -1e-15).all()


def test_the_liquid_part_of_a_corner_is_a_smaller_simplex() -> None:
    """Above ``1/4 - x`` in the unit tetrahedron: all but the corner at x = 1 scaled by 3/4."""
    x = np.array([[0.0, 1.0, 0.0, 0.0]])
    assert liquid_part(0.25 - x).sum() == pytest.approx(1.0 - 0.75**3, rel=1e-14)
    both = np.array([[0.0, 1.0, 1.0, 0.0]])  # x + y < 1/2 in the unit tetrahedron
    assert liquid_part(0.5 - both).sum() == pytest.approx(0.5, rel=1e-14)


@pytest.mark.parametrize("corners", [2, 3, 4])
def test_a_narrow_range_is_a_cut(corners: int) -> None:
    over = np.random.default_rng(corners).normal(size=(400, corners))
    over = over[np.abs(over).min(axis=1) > 1e-2]
    cut = liquid_part(over - 0.5e-6).sum(axis=2)
    assert melted_part(over, 1e-6)[0] == pytest.approx(cut, abs=1e-9)


@pytest.mark.parametrize("corners", [2, 3, 4])
@pytest.mark.parametrize("width", [0.3, 3.0])
def test_the_share_is_integrated_exactly(corners: int, width: float) -> None:
    """Against its mean over many points of the simplex."""
    rng = np.random.default_rng(corners)
    over = rng.normal(size=(5, corners))
    points = rng.dirichlet(np.ones(corners), 200_000)
    x = np.clip(over @ points.T / width, 0.0, 1.0)
    found = (x * x * (3.0 - 2.0 * x)) @ points / len(points)
    assert melted_part(over, width)[0] == pytest.approx(found, abs=3e-3)


@pytest.mark.parametrize("corners", [2, 3, 4])
@pytest.mark.parametrize("width", [0.3, 3.0])
def test_the_derivatives_are_those_of_the_integrals(corners: int, width: float) -> None:
    over = np.random.default_rng(corners).normal(size=(400, corners))
    slopes = melted_part(over, width)[1]
    assert slopes == pytest.approx(np.swapaxes(slopes, 1, 2), abs=1e-12)
    assert np.linalg.eigvalsh(slopes).min() > -1e-12
    for j, shift in enumerate(1e-6 * np.eye(corners)):
        central = (melted_part(over + shift, width)[0] - melted_part(over - shift, width)[0]) / 2e-6
        assert slopes[:, :, j] == pytest.approx(central, abs=1e-6 / width**2)


@pytest.mark.parametrize("corners", [2, 3, 4])
@pytest.mark.parametrize("spread", [0.0, 1e-30, 1e-12, 1e-6])
def test_a_cell_at_melting_throughout_takes_heat_by_its_temperature(corners: int, spread: float) -> None:
    """Corners that differ by less than their digits show have the share and the derivative of their mean."""
    over = 0.3 + spread * np.arange(corners)
    part, slopes = melted_part(over[None], 1.0)
    assert part[0] == pytest.approx(np.full(corners, 0.09 * 2.4 / corners), abs=20.0 * spread + 1e-15)
    mass = (np.ones((corners, corners)) + np.eye(corners)) / (corners * (corners + 1))
    assert slopes[0] == pytest.approx(6.0 * 0.3 * 0.7 * mass, abs=20.0 * spread + 1e-12)


@pytest.mark.parametrize("cell", ["bar3", "tri6", "quad4", "quad8", "quad9", "tet10", "hex8", "hex27"])
def test_the_simplices_fill_the_cell(cell: str) -> None:
    corners = CELLS[cell].nodes[np.array(simplices_of(cell))]
    volumes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1]))
    whole = {"tri6": 1.0, "tet10": 1.0}.get(cell, float(np.prod(range(1, CELLS[cell].dim + 1))))
    assert volumes.min() > 0.0 and volumes.sum() == pytest.approx(whole, rel=1e-14)
