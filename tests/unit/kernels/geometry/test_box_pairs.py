"""Pairs of boxes on a grid against comparison of all with all."""

import numpy as np
import pytest

from softway.kernels.geometry.box_pairs import box_pairs


def compared(middle: np.ndarray, wide: np.ndarray, centre: np.ndarray, half: np.ndarray) -> np.ndarray:
    """Pairs (p, 2) of boxes that overlap or touch."""
    near = np.abs(middle[:, None] - centre) <= wide[:, None] + half
    return np.argwhere(near.all(axis=2))


@pytest.mark.parametrize("d", [1, 2, 3])
@pytest.mark.parametrize("size", [0.02, 0.3, 3.0])
def test_all_pairs_are_found_in_order(d: int, size: float) -> None:
    rng = np.random.default_rng(d)
    boxes = rng.uniform(-2.0, 2.0, (80, d)), rng.uniform(0.3, 1.0, (80, d)) * size
    others = rng.uniform(-1.0, 1.5, (90, d)), rng.uniform(0.3, 1.0, (90, d)) * size
    assert np.stack(box_pairs(*boxes, *others), axis=1).tolist() == compared(*boxes, *others).tolist()


@pytest.mark.parametrize("d", [1, 2, 3])
def test_boxes_that_only_touch_are_pairs(d: int) -> None:
    places = np.stack(np.meshgrid(*[np.arange(4.0)] * d), axis=-1).reshape(-1, d)
    half = np.full(places.shape, 0.5)
    found = np.stack(box_pairs(places, half, places, half), axis=1)
    assert found.tolist() == compared(places, half, places, half).tolist()
    assert len(found) == 10**d


def test_boxes_of_one_place_and_none() -> None:
    same = np.zeros((3, 2))
    assert len(box_pairs(same, same, same, same)[0]) == 9
    assert len(box_pairs(same, same, same[:0], same[:0])[0]) == 0
    assert len(box_pairs(same, same, same + 9.0, same)[0]) == 0


def test_one_far_box_does_not_make_the_grid_large() -> None:
    centre = np.concatenate([np.random.default_rng(2).uniform(0.0, 1.0, (50, 3)), [[1e12, 0.0, 0.0]]])
    half = np.full(centre.shape, 0.05)
    assert (
        np.stack(box_pairs(centre, half, centre, half), axis=1).tolist()
        == compared(centre, half, centre, half).tolist()
    )
