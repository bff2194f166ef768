"""Rigid motions that supports leave free, known from statics."""

import numpy as np
import pytest

from softway.bodies.assembled.rigid_body_modes import free_motions

CUBE = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)]) + 7.0
SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def supported(points, where, components):
    fixed = np.zeros(points.shape, bool)
    for c in components:
        fixed[where, "xyz".index(c)] = True
    return lambda field: field * fixed


def free(field):
    return np.zeros_like(field)


def test_a_free_body_has_them_all():
    assert len(free_motions(CUBE, free)) == 6
    assert len(free_motions(SQUARE, free)) == 3
    assert free_motions(SQUARE[:, :1], free) == ("translation along x",)


@pytest.mark.parametrize(
    ("where", "components", "left"),
    [
        (CUBE[:, 0] == 7.0, "xyz", ()),
        (CUBE[:, 2] == 7.0, "z", ("translation along x", "translation along y", "rotation about z")),
        (np.arange(8) == 0, "xyz", ("rotation about x", "rotation about y", "rotation about z")),
        ((CUBE[:, 0] == 7.0) & (CUBE[:, 1] == 7.0), "xyz", ("rotation about z",)),
        (np.ones(8, bool), "xy", ("translation along z",)),
    ],
)
def test_of_a_cube(where, components, left):
    assert free_motions(CUBE, supported(CUBE, where, components)) == left


def test_a_hinge_along_a_diagonal_is_a_combination():
    along = (CUBE[:, 2] == 7.0) & (CUBE[:, 0] == CUBE[:, 1])
    left = free_motions(CUBE, supported(CUBE, along, "xyz"))
    assert left == ("a motion made of rotation about x and rotation about y",)


def test_rollers_on_an_inclined_plane():
    """They slide along the plane, in the plane; in space they also turn about its normal."""

    def held(field):
        normal = np.array([1.0, 1.0, 0.0][: field.shape[1]]) / np.sqrt(2.0)
        on = np.arange(len(field)) < (4 if field.shape[1] == 3 else 2)
        return np.outer((field @ normal) * on, normal)

    plane = np.array([[0.0, 0.0], [1.0, -1.0], [2.0, 0.0], [1.0, 1.0]])
    assert free_motions(plane, held) == ("a motion made of translation along x and translation along y",)
    tilted = np.array([[x, -x, z] for x in (0.0, 1.0) for z in (0.0, 1.0)] + [[2.0, 2.0, 0.0]])
    found = free_motions(tilted, held)
    assert "translation along z" in found and "rotation about z" not in found


def test_of_a_body_of_revolution():
    assert free_motions(SQUARE, free, axisymmetric=True) == ("translation along y",)
    assert free_motions(SQUARE, supported(SQUARE, [0], "y"), axisymmetric=True) == ()


def test_a_straight_bar_in_space_does_not_turn_about_itself():
    line = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    assert len(free_motions(line, free)) == 5
