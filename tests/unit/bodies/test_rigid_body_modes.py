"""Rigid motions that supports leave free, known from statics."""

import numpy as np
import pytest

from softway.bodies.rigid_body_modes import free_motions

CUBE = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)]) + 7.0
SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def supported(points, where, components):
    fixed = np.zeros(points.shape, bool)
    for c in components:
        fixed[where, "xyz".index(c)] = True
    return fixed


def test_a_free_body_has_them_all():
    assert len(free_motions(CUBE, np.zeros((8, 3), bool))) == 6
    assert len(free_motions(SQUARE, np.zeros((4, 2), bool))) == 3
    assert free_motions(SQUARE[:, :1], np.zeros((4, 1), bool)) == ("translation along x",)


@pytest.mark.parametrize(
    ("where", "components", "free"),
    [
        (CUBE[:, 0] == 7.0, "xyz", ()),
        (CUBE[:, 2] == 7.0, "z", ("translation along x", "translation along y", "rotation about z")),
        (np.arange(8) == 0, "xyz", ("rotation about x", "rotation about y", "rotation about z")),
        ((CUBE[:, 0] == 7.0) & (CUBE[:, 1] == 7.0), "xyz", ("rotation about z",)),
        (np.ones(8, bool), "xy", ("translation along z",)),
    ],
)
def test_of_a_cube(where, components, free):
    assert free_motions(CUBE, supported(CUBE, where, components)) == free


def test_a_hinge_along_a_diagonal_is_a_combination():
    along = (CUBE[:, 2] == 7.0) & (CUBE[:, 0] == CUBE[:, 1])
    free = free_motions(CUBE, supported(CUBE, along, "xyz"))
    assert free == ("a motion made of rotation about x and rotation about y",)


def test_of_a_body_of_revolution():
    none = np.zeros((4, 2), bool)
    assert free_motions(SQUARE, none, axisymmetric=True) == ("translation along y",)
    assert free_motions(SQUARE, supported(SQUARE, [0], "y"), axisymmetric=True) == ()


def test_a_straight_bar_in_space_does_not_turn_about_itself():
    line = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    assert len(free_motions(line, np.zeros((2, 3), bool))) == 5
