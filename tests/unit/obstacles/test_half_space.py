"""Half-spaces."""

import numpy as np
import pytest

from softway.errors import InputError
from softway.obstacles.half_space import HalfSpace


def test_gap_and_normal_in_every_dimension() -> None:
    wall = HalfSpace(point=1.25, normal=-1.0)
    assert wall.gap(np.array([[0.0], [1.5]])).tolist() == [1.25, -0.25]
    assert wall.normal_at(np.zeros((2, 1))).tolist() == [[-1.0], [-1.0]]
    slope = HalfSpace(point=(1.0, 1.0), normal=(3.0, 4.0))
    assert slope.normal == (0.6, 0.8)
    assert slope.gap(np.array([1.6, 1.8])) == pytest.approx(1.0, abs=1e-15)
    floor = HalfSpace(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0))
    assert floor.gap(np.ones((4, 5, 3))).shape == (4, 5)
    assert floor == HalfSpace(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 7.0))


@pytest.mark.parametrize(
    ("point", "normal", "where"),
    [
        ((0.0, 0.0), (0.0, 0.0), "normal"),
        ((0.0, 0.0), (0.0, 0.0, 1.0), "normal"),
        (0.0, float("inf"), "normal"),
        ((), (), "point"),
        (float("nan"), 1.0, "point"),
    ],
)
def test_what_is_no_half_space_is_refused(point, normal, where: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(InputError) as caught:
        HalfSpace(point=point, normal=normal)
    assert caught.value.where == where


def test_points_of_another_dimension_are_refused() -> None:
    with pytest.raises(InputError, match="3 dimensions"):
        HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)).gap(np.zeros(3))


def test_a_unit_normal_is_kept_to_the_last_digit():
    """What was made a unit vector once stays the same when it is read again."""
    for direction in np.random.default_rng(0).standard_normal((500, 3)):
        once = HalfSpace(point=(0.0, 0.0, 0.0), normal=tuple(direction)).normal
        assert HalfSpace(point=(0.0, 0.0, 0.0), normal=once).normal == once
