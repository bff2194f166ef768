"""The search by cells finds the pairs that a comparison of all balls finds."""

import numpy as np
import pytest

from softway.kernels.pile.islands import islands
from softway.kernels.pile.search import near_pairs
from softway.kernels.pile.tables import Walls


def no_walls() -> Walls:
    """No walls."""
    return Walls(np.zeros((0, 3)), np.zeros(0), np.zeros(0), np.zeros(0))


@pytest.mark.parametrize("extent", [(1.0, 1.0, 1.0), (1.0, 1.0, 0.0), (100.0, 0.1, 1e-3)])
def test_all_pairs_are_found_once(extent: tuple[float, ...]) -> None:
    random = np.random.default_rng(5)
    place, radius = random.uniform(-1.0, 1.0, (300, 3)) * extent, np.append(random.uniform(0.02, 0.1, 300), 0.0)
    reach = random.uniform(0.0, 0.02, 300)
    found = near_pairs(place, radius, reach, no_walls())
    first, second = np.triu_indices(300, 1)
    apart = np.linalg.norm(place[first] - place[second], axis=1)
    near = apart <= radius[first] + radius[second] + reach[first] + reach[second]
    expected = sorted(zip(first[near].tolist(), second[near].tolist(), strict=True))
    assert sorted(map(tuple, found.tolist())) == expected
    assert len(expected) > 0


def test_islands_are_the_connected_groups() -> None:
    pairs = np.array([[0, 1], [3, 4], [1, 2], [5, 9], [4, 8]])  # of 8 balls, so 8 and 9 are walls
    order, start, bodies, body_start = islands(pairs, 8)
    groups = [sorted(bodies[body_start[k] : body_start[k + 1]].tolist()) for k in range(len(start) - 1)]
    assert groups == [[0, 1, 2], [3, 4], [5]]
    assert [order[start[k] : start[k + 1]].tolist() for k in range(3)] == [
        [[0, 1], [1, 2]], [[3, 4], [4, 8]], [[5, 9]],
    ]  # fmt: skip
