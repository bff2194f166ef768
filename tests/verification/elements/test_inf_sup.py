"""Which displacements go with which pressure: constants of Babuska and Brezzi, and whether they fall with the mesh."""

import pytest

from inf_sup import constant
from softway.meshes.generators.shapes import box, rectangle

# cell, pressure, constant on a square of 8 x 8 (a cube of 3 x 3 x 3) cells to two digits;
# docs/theory/bodies/incompressible.md
STABLE = [
    ("quad8", "mean", 0.53),
    ("quad8", "corner", 0.26),
    ("quad9", "mean", 0.53),
    ("quad9", "corner", 0.46),
    ("tri6", "mean", 0.52),
    ("tri6", "corner", 0.44),
    ("tri3", "bubble", 0.38),
    ("hex27", "corner", 0.33),
]
UNSTABLE = [
    ("quad4", "mean"),
    ("quad4", "corner"),
    ("tri3", "mean"),
    ("tri3", "corner"),
    ("hex8", "mean"),
    ("hex8", "corner"),
    ("tet4", "mean"),
    ("tet4", "corner"),
]


def mesh(cell: str, n: int):
    flat = cell.startswith(("quad", "tri"))
    return rectangle((1.0, 1.0), (n, n), cell=cell) if flat else box((1.0, 1.0, 1.0), (n, n, n), cell=cell)


@pytest.mark.parametrize(("cell", "pressure", "value"), STABLE)
def test_stable_pairs(cell: str, pressure: str, value: float) -> None:
    few, many = (4, 8) if cell.startswith(("quad", "tri")) else (2, 3)
    coarse, fine = constant(mesh(cell, few), pressure), constant(mesh(cell, many), pressure)
    assert fine == pytest.approx(value, abs=0.006)
    assert fine > 0.88 * coarse


def test_hex20_with_corner_fails_only_in_cells_with_three_fixed_faces() -> None:
    """The eight cells at the corners of the cube have one free corner each: too few for the pressures there."""
    for n, value in ((3, 0.11), (4, 0.15)):
        assert constant(mesh("hex20", n), "corner", without=7) < 1e-6
        assert constant(mesh("hex20", n), "corner", without=8) == pytest.approx(value, abs=0.006)


@pytest.mark.parametrize(("cell", "pressure"), UNSTABLE)
def test_pairs_with_pressures_that_no_displacement_feels(cell: str, pressure: str) -> None:
    assert constant(mesh(cell, 4), pressure) < 1e-6
