"""Rows that depend on each other: those that press are independent, and are those of least energy."""

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.optimize import nnls

from softway.errors import NoConvergence
from softway.solve.elimination.redundant_rows import LocalContact


def rows_of(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Twenty rows on six unknowns, each third one twice, and distances from their targets."""
    random = np.random.default_rng(seed)
    G, bare = random.normal(size=(20, 6)), random.normal(size=20)
    G[::3] = G[1::3][: len(G[::3])] if len(G[1::3]) >= len(G[::3]) else np.vstack([G[1::3], G[:1]])
    return G, G @ random.normal(size=6) + np.abs(bare)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("start", [0.0, 1.0])
def test_pressing_rows_are_independent_and_satisfy_the_conditions(seed: int, start: float) -> None:
    """The force solves ``min p.S p/2 + b.p`` over p >= 0: its motion is that of nonnegative least squares."""
    G, bare = rows_of(seed)
    S = G @ G.T
    contact = LocalContact(sp.csr_array(S), np.ones(20, bool), 1e-12)
    active = contact.pressing(bare, np.full(20, start))
    index = np.flatnonzero(active)
    assert np.linalg.matrix_rank(G[index]) == len(index)
    force = np.zeros(20)
    force[index] = np.linalg.solve(S[np.ix_(index, index)], -bare[index])
    assert force[index].min() > 0.0
    assert (bare + S @ force).min() > -1e-10
    # feasible motion of least size: the projection of zero on the polyhedron G z >= -b
    lifted = np.vstack([G.T, -bare])
    u, _ = nnls(lifted, np.concatenate([np.zeros(6), [1.0]]))
    left = lifted @ u - np.concatenate([np.zeros(6), [1.0]])
    assert G.T @ force == pytest.approx(-left[:6] / left[6], abs=1e-9)


def test_rows_that_may_not_press_stay_open() -> None:
    contact = LocalContact(sp.csr_array(np.eye(2)), np.array([True, False]), 0.0)
    assert contact.pressing(np.array([-1.0, -1.0]), np.zeros(2)).tolist() == [True, False]


def test_targets_that_no_force_reaches_are_told() -> None:
    contact = LocalContact(sp.csr_array(np.array([[1.0, -1.0], [-1.0, 1.0]])), np.array([True, True]), 0.0)
    with pytest.raises(NoConvergence, match="2 contact rows have no solution"):
        contact.pressing(np.array([-1.0, -1.0]), np.zeros(2))
