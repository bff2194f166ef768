"""Turning and moving a mesh."""

import numpy as np
import pytest

from softway.bodies.setup.placement import Placement, Rotation
from softway.errors import InputError
from softway.meshes.generators.shapes import box, interval, rectangle

BOX = box((3.0, 2.0, 1.0), (1, 1, 1))
QUARTER = np.pi / 2


def test_nothing_to_do_keeps_the_mesh():
    assert Placement().applied(BOX) is BOX


def test_a_quarter_turn_exchanges_the_sides_and_keeps_the_centre():
    turned = Placement(rotations=(Rotation(axis=(0.0, 0.0, 2.0), angle=QUARTER),)).applied(BOX)
    np.testing.assert_allclose(np.ptp(turned.points, axis=0), [2.0, 3.0, 1.0], atol=1e-14)
    np.testing.assert_allclose(turned.points.mean(axis=0), BOX.points.mean(axis=0), atol=1e-14)


def test_turns_are_about_fixed_axes_in_order():
    turns = (Rotation(axis=(1.0, 0.0, 0.0), angle=QUARTER), Rotation(axis=(0.0, 0.0, 1.0), angle=QUARTER))
    turned = Placement(rotations=turns).applied(BOX)
    np.testing.assert_allclose(np.ptp(turned.points, axis=0), [1.0, 3.0, 2.0], atol=1e-14)


def test_rotation_matrices_are_proper():
    matrix = Rotation(axis=(1.0, -2.0, 0.5), angle=1.234).matrix()
    np.testing.assert_allclose(matrix @ matrix.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(matrix) == pytest.approx(1.0, abs=1e-14)
    np.testing.assert_allclose(matrix @ [1.0, -2.0, 0.5], [1.0, -2.0, 0.5], atol=1e-14)


def test_the_bottom_is_set_after_the_turn_and_the_shift():
    place = Placement(rotations=(Rotation(axis=(1.0, 1.0, 0.0), angle=0.7),), translation=(5.0, 0.0, 9.0), bottom=0.25)
    placed = place.applied(BOX)
    assert placed.points[:, 2].min() == 0.25
    assert placed.points[:, 0].mean() == pytest.approx(6.5)
    assert sorted(placed.tags) == sorted(BOX.tags)


def test_one_and_two_dimensions():
    assert Placement(translation=2.0).applied(interval(1.0, cells=1)).points.ravel().tolist() == [2.0, 3.0]
    turned = Placement(rotations=(Rotation(angle=QUARTER),), bottom=0.0).applied(rectangle((2.0, 1.0), (1, 1)))
    np.testing.assert_allclose(np.ptp(turned.points, axis=0), [1.0, 2.0], atol=1e-15)


@pytest.mark.parametrize(
    ("place", "mesh", "where"),
    [
        (Placement(translation=(1.0, 2.0)), BOX, "translation"),
        (Placement(rotations=(Rotation(angle=1.0),)), interval(1.0, cells=1), "rotations[0].axis"),
        (
            Placement(rotations=(Rotation(angle=1.0, axis=(1.0, 0.0, 0.0)),)),
            rectangle((1.0, 1.0), (1, 1)),
            "rotations[0].axis",
        ),
    ],
)
def test_what_does_not_fit_the_space_is_refused(place, mesh, where):
    with pytest.raises(InputError) as found:
        place.applied(mesh)
    assert found.value.where == where
    assert found.value.remedy


@pytest.mark.parametrize("axis", [(0.0, 0.0, 0.0), (1.0, 0.0), (float("nan"), 0.0, 1.0)])
def test_an_axis_is_a_direction(axis):
    with pytest.raises(InputError, match="not a direction"):
        Rotation(angle=1.0, axis=axis)
