"""Liquid part of simplices that the temperature of melting cuts: exact volumes and derivatives."""

import numpy as np
import pytest

from softway.heat.phase import liquid_part, simplices_of
from softway.meshes.cells import CELLS


@pytest.mark.parametrize("corners", [2, 3, 4])
def test_the_liquid_part_and_the_solid_part_are_the_whole(corners: int) -> None:
    over = np.random.default_rng(corners).normal(size=(400, corners))
    (liquid, slopes), (solid, same) = liquid_part(over), liquid_part(-over)
    assert liquid + solid == pytest.approx(np.full(over.shape, 1.0 / corners), abs=1e-14)
    assert (liquid >= -1e-15).all() and (solid >= -1e-15).all()
    assert slopes == pytest.approx(same, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("corners", [2, 3, 4])
def test_the_derivatives_of_the_liquid_part(corners: int) -> None:
    over = np.random.default_rng(corners).normal(size=(400, corners))
    over = over[np.abs(over).min(axis=1) > 1e-2]
    slopes = liquid_part(over)[1]
    for j, shift in enumerate(1e-6 * np.eye(corners)):
        central = (liquid_part(over + shift)[0] - liquid_part(over - shift)[0]) / 2e-6
        assert slopes[:, :, j] == pytest.approx(central, rel=1e-6, abs=1e-6)


def test_the_liquid_part_of_a_corner_is_a_smaller_simplex() -> None:
    """Above ``1/4 - x`` in the unit tetrahedron: all but the corner at x = 1 scaled by 3/4."""
    x = np.array([[0.0, 1.0, 0.0, 0.0]])
    assert liquid_part(0.25 - x)[0].sum() == pytest.approx(1.0 - 0.75**3, rel=1e-14)
    both = np.array([[0.0, 1.0, 1.0, 0.0]])  # x + y < 1/2 in the unit tetrahedron
    assert liquid_part(0.5 - both)[0].sum() == pytest.approx(0.5, rel=1e-14)


@pytest.mark.parametrize("cell", ["bar3", "tri6", "quad4", "quad8", "quad9", "tet10", "hex8", "hex27"])
def test_the_simplices_fill_the_cell(cell: str) -> None:
    corners = CELLS[cell].nodes[np.array(simplices_of(cell))]
    volumes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1]))
    whole = {"tri6": 1.0, "tet10": 1.0}.get(cell, float(np.prod(range(1, CELLS[cell].dim + 1))))
    assert volumes.min() > 0.0 and volumes.sum() == pytest.approx(whole, rel=1e-14)
