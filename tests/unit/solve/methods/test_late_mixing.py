"""Mixing of Newton iterates by shifted operators."""

import numpy as np

from softway.bodies.assembled.vector_space import LocalSpace
from softway.solve.methods.anderson import Anderson
from softway.solve.methods.late_mixing import STEADY, LateMixing


def late(shifted: bool = True) -> LateMixing:
    return LateMixing(Anderson(8, LocalSpace(())), shifted=shifted)


def test_iterates_are_mixed_after_steady_decreases_on_the_same_rows() -> None:
    changes = np.geomspace(1.0, 0.1, STEADY + 3)
    mixing = late()
    assert [mixing.steady(c, kept=True) for c in changes] == [False] * (STEADY - 1) + [True] * 4
    assert not mixing.steady(1e-3, kept=False)
    assert [mixing.steady(c * 9e-4, kept=True) for c in changes].index(True) == STEADY - 1


def test_a_change_that_grows_forgets_the_iterates() -> None:
    mixing = late()
    for k, change in enumerate(np.geomspace(1.0, 0.1, 8)):
        if mixing.steady(change, kept=True):
            mixing.accelerator.mix(np.array([float(k)]), np.array([0.9 * k]))
    assert mixing.accelerator.last is not None
    assert not mixing.steady(2.0, kept=True) and mixing.accelerator.last is None


def test_iterates_of_operators_without_a_shift_are_not_mixed() -> None:
    mixing = late(shifted=False)
    assert not any(mixing.steady(c, kept=True) for c in np.geomspace(1.0, 1e-6, 20))
