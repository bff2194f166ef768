"""Averages of the internal force over a slab."""

import pytest

from softway.bodies.elements.section import Axisymmetric
from softway.bodies.internal_force.slab_average import AverageField, DiscreteGradient, EnergyMomentum, Weighted
from softway.bodies.solid import Solid
from softway.errors import InputError
from softway.laws.bulk import NeoHookean
from softway.meshes.generators.shapes import rectangle


def test_defaults() -> None:
    assert AverageField() == AverageField(points=3)
    assert Weighted() != DiscreteGradient()


def test_no_points_average_nothing() -> None:
    with pytest.raises(InputError) as error:
        AverageField(points=0)
    assert error.value.where == "points"


def test_a_body_of_revolution_has_no_angular_momentum_to_keep() -> None:
    with pytest.raises(InputError, match="force: EnergyMomentum for a body of revolution"):
        Solid(
            mesh=rectangle((1.0, 1.0), (2, 2)),
            material=NeoHookean(E=1.0),
            density=1.0,
            section=Axisymmetric(),
            force=EnergyMomentum(),
        )
