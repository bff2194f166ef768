"""Exact sums: correctly rounded, whatever the order and the grouping."""

from math import fsum, inf, isnan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from softway.kernels.linalg.exact_sum import digits, rounded_sum

FINITE = st.floats(allow_nan=False, allow_infinity=False, min_value=-1e300, max_value=1e300)


@given(st.lists(FINITE, max_size=30), st.integers(0, 30))
def test_exact_sums_are_those_of_fsum_in_any_grouping(values: list[float], cut: int) -> None:
    """Subnormal numbers included; two groups of any size give the same bits."""
    column = np.array(values, float).reshape(-1, 1)
    both = digits(column[:cut]) + digits(column[cut:][::-1])
    assert rounded_sum(both[0]) == fsum(values)


def test_the_least_and_the_greatest_doubles() -> None:
    tiny, huge = np.full((7, 1), 5e-324), np.full((2, 1), 1.7e308)
    assert rounded_sum(digits(tiny)[0]) == 35e-324  # as given
    assert rounded_sum(digits(huge)[0]) == inf
    assert rounded_sum(digits(-huge)[0]) == -inf
    assert rounded_sum(digits(np.concatenate([huge, huge, -huge]))[0]) == pytest.approx(3.4e308 - 1.7e308, rel=1e-15)


def test_what_is_not_finite_stays_so() -> None:
    assert rounded_sum(digits(np.array([[inf], [1.0]]))[0]) == inf
    assert rounded_sum(digits(np.array([[-inf], [1.0]]))[0]) == -inf
    assert isnan(rounded_sum(digits(np.array([[inf], [-inf]]))[0]))
    assert isnan(rounded_sum(digits(np.array([[np.nan], [1.0]]))[0]))
