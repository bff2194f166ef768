"""Compiled conditions on pairs of simplices against arrays, and which pairs they keep."""

import numpy as np
import pytest
from pair_arrays import facing_pairs

from softway.contact.mortar.facet_pairs import FEW, facet_pairs


def scattered(d: int, count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Corners (d, d, count) of simplices of size one half in a box, at the start and after a motion."""
    rng = np.random.default_rng(seed)
    start = rng.uniform(0.0, 2.0, (d, 1, count)) + rng.uniform(-0.25, 0.25, (d, d, count))
    return start, start + rng.uniform(-0.2, 0.2, (d, 1, count)) + rng.uniform(-0.02, 0.02, start.shape)


@pytest.mark.parametrize("walls", [(np.inf, np.inf), (0.1, 0.2), (np.linspace(0.01, 2.0, 70), np.inf)])
@pytest.mark.parametrize("d", [2, 3])
def test_pairs_are_those_of_arrays(d: int, walls: tuple[np.ndarray | float, np.ndarray | float]) -> None:
    kept = 0
    for seed in range(4):
        slave, master, reach = scattered(d, 70, seed), scattered(d, 60, seed + 10), 0.15
        found = facet_pairs(slave, master, reach, walls)
        every = (np.repeat(np.arange(70), 60), np.tile(np.arange(60), 70))
        i, j, limit = facing_pairs(slave, master, every, reach, walls)
        expected = dict(zip(zip(i.tolist(), j.tolist(), strict=True), limit, strict=True))
        for a, b, most in zip(found.slave.tolist(), found.master.tolist(), found.limit, strict=True):
            assert expected.pop((a, b)) == pytest.approx(most, rel=1e-14)
        apart = _apart(slave, master, reach)
        assert all(apart[pair] for pair in expected)
        kept += len(found.slave)
    assert kept > 100


def _apart(slave: tuple[np.ndarray, np.ndarray], master: tuple[np.ndarray, np.ndarray], reach: float) -> np.ndarray:
    """True (p, q) for pairs whose boxes around the paths, relative to the mean motion of the masters, are apart."""
    drift = (master[1].mean(axis=1) - master[0].mean(axis=1)).mean(axis=1)[:, None, None]
    boxes = []
    for start, end in (slave, master):
        both = np.concatenate([start, end - drift], axis=1)
        boxes.append((both.min(axis=1), both.max(axis=1)))
    (low, high), (least, most) = boxes
    gap = np.maximum(low[:, :, None] - most[:, None], least[:, None] - high[:, :, None]).max(axis=0)
    return gap > reach - 0.1  # boxes around paths are wider than those around the corners, by the change of their size


def test_a_limit_holds_the_sizes_the_reach_and_the_travel() -> None:
    below, above = (np.array([[a, b], [y, y]])[:, :, None] for a, b, y in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.3)))
    fallen = above - np.array([0.0, 0.2])[:, None, None]
    found = facet_pairs((below, below), (above, fallen), 0.5)
    assert found.limit.tolist() == pytest.approx([FEW * 1.0 + 0.5 + 0.2])
