"""The broad phase finds every pair that comes within reach, and few others."""

import numpy as np
import pytest

from softway.contact.surfaces.broad_phase import near, sweep


def _met(x0: np.ndarray, x1: np.ndarray, points: np.ndarray, facets: np.ndarray, reach: float) -> set[tuple[int, int]]:
    """Pairs whose boxes come within reach at one of many instants."""
    found = set()
    for tau in np.linspace(0.0, 1.0, 101):
        x = (1.0 - tau) * x0 + tau * x1
        low, high = x[facets].min(axis=1) - reach, x[facets].max(axis=1) + reach
        inside = ((x[points][:, None] >= low) & (x[points][:, None] <= high)).all(axis=2)
        found |= set(zip(*np.nonzero(inside), strict=True))
    return found


@pytest.mark.parametrize("dim", [1, 2, 3])
@pytest.mark.parametrize("speed", [0.0, 0.1, 3.0])
def test_every_pair_within_reach_is_found(dim: int, speed: float) -> None:
    rng = np.random.default_rng(dim)
    x0 = rng.random((150, dim))
    points, facets = np.arange(60), rng.integers(60, 90, size=(40, 1)) + rng.integers(0, 60, size=(40, dim))
    x0[60:] = x0[60] + 0.6 * (x0[60:] - x0[60])
    x1 = x0 + speed * rng.normal(size=x0.shape)
    i, j = near(sweep(x0, x1, points[:, None]), sweep(x0, x1, facets), 0.02)
    assert _met(x0, x1, points, facets, 0.02) <= set(zip(i, j, strict=True))
    assert (np.diff(i * 40 + j) > 0).all()


def test_bodies_with_equal_velocities_have_no_pairs() -> None:
    x0 = np.array([[0.0, 0.0], [1.0, 1.0], [2.0, 1.0], [0.0, 3.0]])
    x1 = x0 + np.array([100.0, 50.0])
    i, j = near(sweep(x0, x1, np.array([[0], [3]])), sweep(x0, x1, np.array([[1, 2]])), 0.5)
    assert len(i) == len(j) == 0


def test_graded_facets_cost_no_more_than_even_ones() -> None:
    """Facets from 1 down to 1e-5 along a line, with a point on each: every point meets its neighbours only."""
    ends = np.concatenate([[0.0], np.cumsum(np.geomspace(1.0, 1e-5, 600))])
    x = np.zeros((601 + 600, 2))
    x[:601, 0], x[601:, 0] = ends, 0.5 * (ends[1:] + ends[:-1])
    facets = np.stack([np.arange(600), np.arange(1, 601)], axis=1)
    i, j = near(sweep(x, x, np.arange(601, 1201)[:, None]), sweep(x, x, facets), 1e-9)
    assert i.tolist() == j.tolist() == list(range(600))


def test_a_fast_path_costs_only_what_it_passes() -> None:
    """A point crosses a row of 400 facets along the diagonal: it meets the two boxes beside its path."""
    x0 = np.zeros((402, 2))
    x0[:401, 0] = np.arange(401)
    x1 = x0.copy()
    x0[401], x1[401] = (190.25, -10.0), (210.25, 10.0)
    facets = np.stack([np.arange(400), np.arange(1, 401)], axis=1)
    point = sweep(x0, x1, np.array([[401]]))
    i, j = near(point, sweep(x0, x1, facets), 0.1)
    assert 200 in j
    assert len(i) <= 21 + 2


def test_without_boxes_there_are_no_pairs() -> None:
    x = np.zeros((2, 2))
    none = np.zeros((0, 2), dtype=int)
    assert [len(part) for part in near(sweep(x, x, np.array([[0]])), sweep(x, x, np.array([[0, 1]])), 0.1)] == [1, 1]
    assert [len(part) for part in near(sweep(x, x, np.array([[0]])), sweep(x, x, none), 0.1)] == [0, 0]
