"""Forces of contacts at the start of the first slab on a new mesh: sums between two bodies, and friction."""

from functools import cache

import numpy as np
import pytest
from forging import KEPT, changes, force, forged, places

import softway as sw
from softway.arrays import Array
from softway.meshes.remeshed.remesh import Remesh
from softway.model.scene import State


def joined(values: dict[str, Array]) -> Array:
    """Values of the rows of all contacts."""
    return np.concatenate([np.asarray(one) for one in values.values()])


def power(state: State) -> float:
    """Power of the friction [W]."""
    return float(np.sum(joined(dict(state.traction)) * joined(dict(state.slip))))


def test_the_force_of_a_folded_flank_passes_to_the_contact_of_the_end_face() -> None:
    """A side of the flank that lies on the platen belongs to the end face of the new mesh, and its force too."""
    steps = forged("auto", 0.74, 40, (4, 3))
    folded = [k for k in changes(steps) if steps[k - 1].after.closed["flank"].any()]
    assert folded
    for k in folded:
        old, new = (joined(dict(state.pressure)) for state in (steps[k - 1].after, steps[k].before))
        assert np.asarray(steps[k - 1].after.pressure["flank"]).sum() > 1e-3 * old.sum()
        assert new.sum() == pytest.approx(old.sum(), rel=1e-12)
        assert not steps[k].before.closed["flank"].any()


def test_slipping_rows_keep_the_power_of_their_friction() -> None:
    """Friction of rates has the areas of the middle of a slab: those of its end would give 2 per cent more here."""
    steps = forged(Remesh(ratio=1.3), 0.3, 8, (8, 6))
    assert changes(steps)
    for k in changes(steps):
        before, after = power(steps[k - 1].after), power(steps[k].before)
        assert before < 0.0
        assert after == pytest.approx(before, rel=2e-3)
