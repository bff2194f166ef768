"""Convex polygons cut by half-spaces."""

import numpy as np

from softway.kernels.geometry.polygon_clipping import clip


def area(polygon: np.ndarray) -> float:
    """Area of a polygon (2, v)."""
    x, y = polygon
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def cut(values: np.ndarray, count: np.ndarray, lines: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Polygons cut by lines a x + b y + c >= 0, one line (3,) after the other."""
    for a, b, c in lines:
        values, count = clip(values, a * values[0] + b * values[1] + c, count)
    return values, count


def test_a_square_loses_its_corners() -> None:
    square = np.array([[-1.0, 1.0, 1.0, -1.0], [-1.0, -1.0, 1.0, 1.0]])[:, :, None]
    slanted = np.array([[a, b, 1.5] for a in (-1.0, 1.0) for b in (-1.0, 1.0)])
    values, count = cut(square, np.array([4]), slanted)
    assert count.tolist() == [8]
    assert np.isclose(area(values[:, :8, 0]), 4.0 - 4 * 0.125, atol=1e-14)


def test_what_lies_inside_stays_and_what_lies_outside_goes() -> None:
    triangle = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    both = np.stack([triangle, triangle - 5.0], axis=2)
    values, count = cut(both, np.array([3, 3]), np.array([[1.0, 0.0, 1.0]]))
    assert count.tolist() == [3, 0]
    assert np.array_equal(values[:, :3, 0], np.roll(triangle, -1, axis=1))


def test_linear_functions_are_carried_to_new_corners() -> None:
    rng = np.random.default_rng(3)
    angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, (6, 50)), axis=0)
    x, y = np.cos(angles), np.sin(angles)
    slopes = rng.standard_normal((2, 50))
    count = rng.integers(3, 7, 50)
    values, left = cut(np.stack([x, y, slopes[0] * x + slopes[1] * y]), count, rng.standard_normal((4, 3)))
    used = np.arange(values.shape[1])[:, None] < left
    expected = slopes[0] * values[0] + slopes[1] * values[1]
    assert used.any()
    assert np.allclose(values[2][used], expected[used], atol=1e-14)


def test_the_two_sides_of_a_line_make_up_the_polygon() -> None:
    rng = np.random.default_rng(4)
    angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, (7, 1)), axis=0)
    polygon, count = np.stack([np.cos(angles), np.sin(angles)]), np.array([7])
    line = np.array([[0.3, -0.7, 0.1]])
    parts = [cut(polygon, count, sign * line) for sign in (1.0, -1.0)]
    total = sum(area(values[:, : left[0], 0]) for values, left in parts)
    assert np.isclose(total, area(polygon[..., 0]), atol=1e-14)


def test_edges_on_the_line_may_be_bent_by_rounding() -> None:
    x = np.linspace(0.0, 1.0, 6)
    polygon = np.stack([np.append(x, 0.5), np.append(1e-17 * (-1.0) ** np.arange(6), 1.0)])[:, :, None]
    values, count = clip(polygon, polygon[1], np.array([7]))
    assert np.isclose(area(values[:, : count[0], 0]), 0.5, atol=1e-14)
    _, nothing = clip(polygon, polygon[1] - 2.0, np.array([7]))
    assert nothing.tolist() == [0]
