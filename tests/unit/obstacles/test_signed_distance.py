"""Obstacles by a function of the user."""

import numpy as np
import pytest

from softway.errors import InputError
from softway.obstacles.primitives import Cavity, Cylinder, Sphere
from softway.obstacles.signed_distance import SignedDistance
from softway.testing import check_obstacle

CENTRE = np.array([0.1, -0.2, 0.3])
BALL = Sphere(centre=tuple(CENTRE), radius=0.7)
POINTS = np.random.default_rng(2).uniform(-2.0, 2.0, (200, 3))


def ball(x):
    return np.linalg.norm(x - CENTRE, axis=1) - 0.7


def outward(x):
    return (x - CENTRE) / np.linalg.norm(x - CENTRE, axis=1, keepdims=True)


@pytest.mark.parametrize("gradient", [None, outward])
def test_a_ball_by_its_function(gradient):
    shape = SignedDistance(function=ball, dim=3, gradient=gradient)
    assert np.abs(shape.gap(POINTS) - BALL.gap(POINTS)).max() < 1e-15
    assert np.abs(shape.normal_at(POINTS) - BALL.normal_at(POINTS)).max() < (1e-8 if gradient is None else 1e-15)
    check_obstacle(shape, POINTS)
    check_obstacle(Cavity(of=shape), POINTS)


def test_a_wall_in_one_dimension():
    wall = SignedDistance(function=lambda x: 1.5 - x[:, 0], dim=1)
    assert wall.gap(np.array([1.0])) == 0.5 and wall.normal_at(np.zeros((2, 1))).tolist() == [[-1.0], [-1.0]]


def test_functions_by_name(tmp_path, monkeypatch):
    (tmp_path / "own_tool.py").write_text("def gap(x):\n    return x[:, 1] - 1.0\n\nlevel = 3\n")
    monkeypatch.syspath_prepend(tmp_path)
    floor = SignedDistance(function="own_tool:gap", dim=2)
    assert floor.gap(np.array([7.0, 3.0])) == 2.0 and floor == SignedDistance(function="own_tool:gap", dim=2)
    for name in ("own_tool:level", "own_tool:none", "own_tool", "nowhere:gap", ":gap"):
        with pytest.raises(InputError) as found:
            SignedDistance(function="own_tool:gap", gradient=name, dim=2)
        assert found.value.where == "gradient"


@pytest.mark.parametrize(
    ("options", "where"),
    [
        ({"dim": 4}, "dim"),
        ({"dim": 3, "step": 0.0}, "step"),
        ({"dim": 3, "function": 3.0}, "function"),
    ],
)
def test_what_is_no_function_is_refused(options, where):
    with pytest.raises(InputError) as found:
        SignedDistance(**{"function": ball, **options})
    assert found.value.where == where


def test_answers_of_a_wrong_shape_are_refused():
    with pytest.raises(InputError, match="shape"):
        SignedDistance(function=lambda x: x, dim=3).gap(POINTS)
    with pytest.raises(InputError, match="shape"):
        SignedDistance(function=ball, gradient=ball, dim=3).normal_at(POINTS)
    with pytest.raises(InputError, match="2 dimensions"):
        SignedDistance(function=ball, dim=3).gap(np.zeros((4, 2)))


def test_ends_of_a_cylinder():
    punch = Cylinder(start=(1.0, 0.0, -1.0), end=(1.0, 0.0, 2.0), radius=0.5)
    x = np.array(
        [[1.2, 0.1, 2.25], [1.0, 0.75, 0.0], [1.4, 0.6 - 0.2, 2.0], [4.5, 0.0, -5.0], [1.0, 0.45, 0.0], [1.1, 0, 1.9]]
    )
    np.testing.assert_allclose(punch.gap(x)[[0, 1, 3, 4, 5]], [0.25, 0.25, 5.0, -0.05, -0.1], atol=1e-14)
    assert punch.gap(x)[2] == pytest.approx(np.hypot(0.4, 0.4) - 0.5, abs=1e-15)
    normals = [[0, 0, 1], [0, 1, 0], [0.6, 0, -0.8], [0, 1, 0], [0, 0, 1]]
    np.testing.assert_allclose(punch.normal_at(x)[[0, 1, 3, 4, 5]], normals, atol=1e-14)
    turned = Cylinder(start=(1.0, 0.0, 2.0), end=(1.0, 0.0, -1.0), radius=0.5)
    np.testing.assert_allclose(turned.gap(x), punch.gap(x), atol=1e-15)
    for wrong in ({"radius": 0.0}, {"end": (1.0, 0.0, -1.0)}):
        with pytest.raises(InputError):
            Cylinder(**{"start": (1.0, 0.0, -1.0), "end": (1.0, 0.0, 2.0), "radius": 0.5, **wrong})
