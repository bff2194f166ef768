"""Driven supports: the table of velocities, and the components that they move."""

import numpy as np
import pytest

from softway.bodies.setup.initial_fields import Uniform
from softway.bodies.solid import Driven, Fixed, Solid, Support
from softway.errors import InputError
from softway.laws.bulk import LinearElastic
from softway.meshes.generators.shapes import rectangle
from softway.model.build import build
from softway.model.model import Model
from softway.model.scene import Scene


def model(*supports: Support) -> Model:
    solid = Solid(
        mesh=rectangle((2.0, 1.0), (4, 2)), material=LinearElastic(E=1.0), density=1.0, supports=supports,
        velocity=Uniform(value=(0.3, 0.4)),
    )  # fmt: skip
    other = Solid(mesh=rectangle((1.0, 1.0), (1, 1)), material=LinearElastic(E=1.0), density=1.0)
    return build(Scene(bodies={"other": other, "block": solid}))


def test_the_velocity_is_linear_between_the_times_and_constant_outside() -> None:
    table = Driven(on="top", velocity=(1.0, 3.0, -1.0), times=(0.5, 1.0, 2.0))
    found = [table.at(t) for t in (-1.0, 0.5, 0.75, 1.0, 1.5, 2.0, 9.0)]
    assert found == pytest.approx([1.0, 1.0, 2.0, 3.0, 1.0, -1.0, -1.0], rel=1e-15)
    assert [Driven(on="top", velocity=v).at(7.0) for v in (2.0, (2.0,))] == [2.0, 2.0]


@pytest.mark.parametrize(
    ("velocity", "times", "where"),
    [
        ((1.0, 2.0), (), "velocity"),
        ((1.0, 2.0), (0.0,), "velocity"),
        (1.0, (0.0, 1.0), "velocity"),
        (float("nan"), (), "velocity"),
        ((1.0, 2.0), (1.0, 1.0), "times"),
        ((1.0, 2.0), (1.0, 0.0), "times"),
    ],
)
def test_a_wrong_table_is_refused(velocity: object, times: tuple[float, ...], where: str) -> None:
    with pytest.raises(InputError) as error:
        Driven(on="top", velocity=velocity, times=times)
    assert error.value.where == where


def test_only_the_named_components_are_moved() -> None:
    built = model(Driven(on="right", components="y", velocity=(0.0, 2.0), times=(0.0, 1.0)), Fixed(on="left"))
    rows, mesh = built.parts[1].nodes, built.meshes["block"]
    right, left = mesh.nodes("right") + rows.start, mesh.nodes("left") + rows.start
    assert built.free[right].tolist() == [[True, False]] * 3
    assert not built.free[left].any()
    expected = np.zeros(built.shape)
    expected[right, 1] = 1.0
    np.testing.assert_array_equal(built.prescribed(0.5), expected)
    assert not built.prescribed(0.0).any()
    assert not built.velocity[~built.free].any(), "the initial field is for free components"
    assert built.velocity[right, 0].tolist() == [0.3] * 3


def test_of_two_supports_the_later_moves_a_component() -> None:
    slow, fast = (Driven(on=tag, velocity=v) for tag, v in (("right", 1.0), ("top", 2.0)))
    mesh = model().meshes["block"]
    corner = np.intersect1d(mesh.nodes("right"), mesh.nodes("top")) + model().parts[1].nodes.start
    for supports, v in (((slow, fast), 2.0), ((fast, slow), 1.0)):
        assert model(*supports).prescribed(0.0)[corner].tolist() == [[v, v]]


@pytest.mark.parametrize("components", ["z", "", "xz"])
def test_wrong_components_are_named(components: str) -> None:
    with pytest.raises(InputError) as error:
        model(Fixed(on="left"), Driven(on="right", components=components, velocity=1.0))
    assert error.value.where == "bodies.block.supports[1].components"


def test_a_tag_that_matches_nothing_is_named() -> None:
    with pytest.raises(InputError) as error:
        model(Driven(on="rigth", velocity=1.0))
    assert error.value.where == "bodies.block.supports[0].on"
