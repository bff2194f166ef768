"""Works of a slab in one loop are those of the fields, for solids of many components."""

import numpy as np
import pytest

from softway.kernels.slab.works import (
    ENDS,
    ENDS_SLOPE,
    LOADED,
    MOVING,
    SIZE,
    SLOPE,
    STILL,
    STILL_SLOPE,
    WORKS,
    works,
)


@pytest.mark.parametrize("dimension", [1, 2, 3])
def test_works_are_those_of_the_fields(dimension: int) -> None:
    rng, first = np.random.default_rng(dimension), np.array([0, 7, 900])
    size = int(first[-1]) * dimension
    l0, l1, u0, u1, f0, f1, mean = rng.standard_normal((7, size))
    heavy = np.repeat(rng.random(first[-1]) < 0.5, dimension)
    found = np.full((2, WORKS), np.nan)
    works(first, dimension, heavy, (l0, l1), u0, u1, (f0, f1), mean, found)
    moved, light = u1 - u0, ~heavy
    fields = {
        MOVING: mean * moved * heavy,
        SIZE: np.abs(mean * moved) * heavy,
        SLOPE: (f1 - f0) * moved * heavy,
        STILL: 0.5 * (l0 + l1) * moved * light,
        STILL_SLOPE: (l1 - l0) * moved * light,
        LOADED: np.abs(l1 * moved),
        ENDS: 0.5 * (f0 + f1) * moved * light,
        ENDS_SLOPE: (f1 - f0) * moved,
    }
    assert sorted(fields) == list(range(WORKS))
    for part in range(2):
        mine = slice(first[part] * dimension, first[part + 1] * dimension)
        for column, field in fields.items():
            expected = field[mine].sum()
            assert found[part, column] == pytest.approx(expected, abs=1e-13 * np.abs(field[mine]).sum())
