"""Closest points of segments and triangles."""

import numpy as np
import pytest

from softway.kernels.geometry.closest_points import on_segments, on_triangles


def _optimal(x: np.ndarray, corners: np.ndarray, weights: np.ndarray) -> float:
    """Greatest (x - y) . (corner - y): not positive exactly for the closest point y of a convex set."""
    y = np.einsum("kp,kpd->pd", weights.T, corners)
    return float(np.einsum("pd,kpd->kp", x - y, corners - y).max())


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("corners", [2, 3])
def test_no_point_of_the_set_is_closer(dim: int, corners: int) -> None:
    rng = np.random.default_rng(1)
    x, *nodes = rng.normal(size=(corners + 1, 5000, dim))
    weights = on_segments(x, *nodes) if corners == 2 else on_triangles(x, *nodes)
    assert weights.shape == (5000, corners)
    assert weights.min() >= 0.0
    assert np.abs(weights.sum(axis=1) - 1.0).max() < 1e-12
    assert _optimal(x, np.stack(nodes), weights) < 1e-11


def test_points_of_the_triangle_are_their_own_closest_points() -> None:
    rng = np.random.default_rng(2)
    corners = rng.normal(size=(3, 400, 3))
    weights = rng.dirichlet((1.0, 1.0, 1.0), size=400)
    x = np.einsum("kp,kpd->pd", weights.T, corners)
    assert np.abs(on_triangles(x, *corners) - weights).max() < 1e-11


@pytest.mark.parametrize(
    ("x", "expected"),
    [
        ((0.2, 0.3, 5.0), (0.5, 0.2, 0.3)),
        ((-1.0, -2.0, 1.0), (1.0, 0.0, 0.0)),
        ((3.0, -0.5, 0.0), (0.0, 1.0, 0.0)),
        ((-0.1, 7.0, 0.0), (0.0, 0.0, 1.0)),
        ((0.25, -1.0, 2.0), (0.75, 0.25, 0.0)),
        ((-1.0, 0.25, 0.0), (0.75, 0.0, 0.25)),
        ((1.0, 1.0, -1.0), (0.0, 0.5, 0.5)),
    ],
)
def test_every_region_of_a_triangle(x: tuple[float, ...], expected: tuple[float, ...]) -> None:
    corners = np.array([[[0.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]]])
    assert on_triangles(np.array([x]), *corners)[0] == pytest.approx(np.array(expected), abs=1e-15)


def test_a_segment_without_length_is_its_first_end() -> None:
    assert on_segments(np.ones((1, 2)), np.zeros((1, 2)), np.zeros((1, 2))).tolist() == [[1.0, 0.0]]
