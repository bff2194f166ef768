"""Friction at the start of the first slab on a new mesh."""

import numpy as np
import pytest
from forging import changes, forged

from softway.arrays import Array
from softway.meshes.remeshed.remesh import Remesh
from softway.model.scene import State


def joined(values: dict[str, Array]) -> Array:
    """Values of the rows of all contacts."""
    return np.concatenate([np.asarray(one) for one in values.values()])


def power(state: State) -> float:
    """Power of the friction [W]."""
    return float(np.sum(joined(dict(state.traction)) * joined(dict(state.slip))))


def test_slipping_rows_keep_the_power_of_their_friction() -> None:
    """Friction of rates has the areas of the middle of a slab: those of its end would give 2 per cent more here."""
    steps = forged(Remesh(ratio=1.3), 0.3, 8, (8, 6))
    assert changes(steps)
    for k in changes(steps):
        before, after = power(steps[k - 1].after), power(steps[k].before)
        assert before < 0.0
        assert after == pytest.approx(before, rel=2e-3)
