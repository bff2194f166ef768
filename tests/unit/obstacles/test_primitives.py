"""Signed distances: unit gradient, normal along it, sign, and what they refuse."""

import numpy as np
import pytest

from softway.errors import InputError
from softway.obstacles.half_space import HalfSpace
from softway.obstacles.primitives import Block, Cavity, Cylinder, Roller, Sphere, Torus

SHAPES = [
    HalfSpace(point=(0.1, 0.0, 0.2), normal=(1.0, 2.0, -0.5)),
    Sphere(centre=(0.1, -0.2, 0.3), radius=0.7),
    Sphere(centre=(0.1, -0.2), radius=0.7),
    Roller(point=(0.0, 0.1, 0.0), axis=(1.0, 1.0, 0.3), radius=0.4),
    Cylinder(start=(-0.2, 0.1, -0.5), end=(0.3, 0.2, 0.6), radius=0.4),
    Block(low=(-0.5, -0.4, -0.3), high=(0.5, 0.6, 0.2)),
    Block(low=(-0.5, -0.4), high=(0.5, 0.6)),
    Torus(centre=(0.0, 0.1, 0.0), axis=(0.2, 0.0, 1.0), radius=0.8, tube=0.3),
    Cavity(of=Sphere(centre=(0.1, -0.2, 0.3), radius=2.7)),
]


def sampled(shape):
    """Points around the shape, away from the kinks of the distance."""
    x = np.random.default_rng(1).uniform(-1.5, 1.5, (400, shape.dim))
    e = 1e-4
    turning = [np.abs(shape.normal_at(x + e * d) - shape.normal_at(x - e * d)).max(axis=-1) for d in np.eye(shape.dim)]
    return x[np.max(turning, axis=0) < 0.05]


@pytest.mark.parametrize("shape", SHAPES, ids=lambda s: f"{type(s).__name__}{s.dim}")
def test_the_normal_is_the_gradient_and_has_length_one(shape):
    x, e = sampled(shape), 1e-6
    assert len(x) > 150
    slope = np.stack([(shape.gap(x + e * d) - shape.gap(x - e * d)) / (2 * e) for d in np.eye(shape.dim)], axis=-1)
    normal = shape.normal_at(x)
    assert np.abs(np.linalg.norm(normal, axis=-1) - 1.0).max() < 1e-12
    assert np.abs(slope - normal).max() < 1e-7


@pytest.mark.parametrize("shape", SHAPES, ids=lambda s: f"{type(s).__name__}{s.dim}")
def test_the_closest_point_lies_on_the_surface(shape):
    x = sampled(shape)
    x = x[shape.gap(x) > 0.0]
    foot = x - shape.gap(x)[:, None] * shape.normal_at(x)
    assert np.abs(shape.gap(foot)).max() < 1e-12


def test_signs():
    ball = Sphere(centre=(0.0, 0.0), radius=1.0)
    assert ball.gap(np.zeros(2)) == -1.0
    assert Cavity(of=ball).gap(np.zeros(2)) == 1.0
    ring = Torus(centre=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0), radius=2.0, tube=0.5)
    assert ring.gap(np.array([2.0, 0.0, 0.0])) == -0.5
    assert Block(low=(0.0, 0.0), high=(1.0, 1.0)).gap(np.array([1.0 + 3.0, 1.0 + 4.0])) == 5.0


@pytest.mark.parametrize(
    "make",
    [
        lambda: Sphere(centre=(0.0, 0.0), radius=0.0),
        lambda: Roller(point=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 0.0), radius=1.0),
        lambda: Block(low=(0.0, 0.0), high=(1.0, -1.0)),
        lambda: Torus(centre=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0), radius=1.0, tube=1.0),
        lambda: Sphere(centre=(0.0, 0.0), radius=1.0).gap(np.zeros((2, 3))),
    ],
)
def test_what_is_no_shape_is_refused(make):
    with pytest.raises(InputError):
        make()
