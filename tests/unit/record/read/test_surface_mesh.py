"""Surfaces of the pictures."""

import numpy as np
import pytest

from softway.meshes.element import tabulate
from softway.record.read.surface_mesh import SHAPES


@pytest.mark.parametrize("cell", SHAPES)
def test_facets_are_drawn_with_the_functions_of_their_cells(cell: str) -> None:
    points = 0.5 * np.random.default_rng(0).random((9, 2))
    assert np.abs(SHAPES[cell](*points.T) - tabulate(cell, points)[0]).max() < 1e-14
