"""Sums of rows that are zero but for a range of their places."""

import numpy as np
import pytest

from softway.kernels.linalg.weighted_rows import add_rows, find_extents


@pytest.mark.parametrize("count", [1, 4, 11])
def test_sums_are_those_of_whole_rows(count: int) -> None:
    rng = np.random.default_rng(count)
    stored = np.zeros((12, 30))
    for row in range(12):
        first = 10 * (row // 5)
        stored[row, first : first + 10] = rng.standard_normal(10)
    extent = np.empty((12, 2), np.int64)
    find_extents(stored, extent)
    assert extent[[0, 5, 11]].tolist() == [[0, 10], [10, 20], [20, 30]]
    which, amounts = rng.permutation(12)[:count], rng.standard_normal(count)
    which.sort()
    for length in (30, 17):
        out = np.zeros(length)
        add_rows(stored, which, amounts, extent[which], out)
        assert out.tolist() == pytest.approx((amounts @ stored[which])[:length].tolist(), rel=1e-14, abs=1e-14)


def test_a_row_of_zeros_has_no_extent() -> None:
    extent = np.empty((1, 2), np.int64)
    find_extents(np.zeros((1, 4)), extent)
    assert extent[0, 0] == extent[0, 1]
