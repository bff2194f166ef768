"""Averages of the internal force over a slab."""

import pytest

from softway.bodies.force import AverageField, DiscreteGradient, Weighted
from softway.errors import InputError


def test_defaults() -> None:
    assert AverageField() == AverageField(points=3)
    assert Weighted() != DiscreteGradient()


def test_no_points_average_nothing() -> None:
    with pytest.raises(InputError) as error:
        AverageField(points=0)
    assert error.value.where == "points"
