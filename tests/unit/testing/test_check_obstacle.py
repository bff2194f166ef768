"""The examination of obstacles finds what is wrong."""

import numpy as np
import pytest

from softway.obstacles.half_space import HalfSpace
from softway.obstacles.primitives import Block, Cavity, Cylinder, Roller, Sphere, Torus
from softway.obstacles.signed_distance import SignedDistance
from softway.testing import check_obstacle

POINTS = np.array([[1.2, 0.3, 0.1], [0.9, -1.1, 0.4], [-1.3, 0.2, 1.0]])


@pytest.mark.parametrize(
    "shape",
    [
        HalfSpace(point=(0.0, 0.0, 0.0), normal=(1.0, 2.0, 3.0)),
        Sphere(centre=(0.0, 0.0, 0.0), radius=0.5),
        Roller(point=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 1.0), radius=0.2),
        Cylinder(start=(0.0, 0.0, 0.0), end=(0.0, 0.5, 0.5), radius=0.2),
        Block(low=(-0.5, -0.5, -0.5), high=(0.5, 0.5, 0.5)),
        Torus(centre=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0), radius=0.5, tube=0.1),
        Cavity(of=Sphere(centre=(0.0, 0.0, 0.0), radius=3.0)),
    ],
    ids=lambda s: type(s).__name__,
)
def test_every_shape_passes(shape):
    check_obstacle(shape, POINTS)


def distance(x):
    return np.linalg.norm(x, axis=1) - 0.5


def radial(x):
    return x / np.linalg.norm(x, axis=1, keepdims=True)


@pytest.mark.parametrize(
    ("function", "gradient", "complaint"),
    [
        (lambda x: 2.0 * distance(x), None, "length 1"),
        (distance, lambda x: -radial(x), "not the gradient"),
        (distance, lambda x: radial(x + 0.01), "not the gradient"),
        (lambda x: x[:, 0] + 1e-3 * np.sin(x[:, 0]), None, "length 1"),
        (lambda x: np.where(distance(x) > 0.2, distance(x) + 0.1, distance(x)), None, "not on the surface"),
        (lambda x: np.full(len(x), np.nan), None, "not finite"),
    ],
)
def test_mistakes_are_found(function, gradient, complaint):
    with pytest.raises(AssertionError, match=complaint):
        check_obstacle(SignedDistance(function=function, gradient=gradient, dim=3), POINTS)


def test_a_function_that_looks_at_all_points_together_is_found():
    with pytest.raises(AssertionError, match="one point differs"):
        check_obstacle(SignedDistance(function=lambda x: distance(x) + x.min(), dim=3), POINTS)
    with pytest.raises(AssertionError, match="2 dimensions"):
        check_obstacle(Sphere(centre=(0.0, 0.0), radius=1.0), POINTS)
