"""Parts of compiled slabs: solutions in a band, and Anderson mixing as in :mod:`softway.solve.methods.anderson`."""

import numpy as np
import pytest

from softway.kernels.jit.by_address import packed
from softway.kernels.jit.compilation import uncounted_kernel
from softway.kernels.multibody.band import factor_band
from softway.kernels.slab.band import solve_spread, spread_factor
from softway.kernels.slab.stored.mixing import mix
from softway.kernels.slab.stored.tables import BALANCE, LIMITS, TAKEN, Search, search_at
from softway.solve.methods.anderson import Anderson


@uncounted_kernel
def solve_many(down, up, pivot, answers):
    """Solve in place for several right-hand sides (k, f)."""
    for k in range(len(answers)):
        solve_spread(down, up, pivot, answers[k])


@uncounted_kernel
def mix_at(place, residual, q, impulse):
    """Mix with the ``Search`` at an address."""
    mix(search_at(place), residual, q, impulse)


@pytest.mark.parametrize(("n", "w"), [(1, 0), (2, 1), (5, 2), (9, 8), (40, 1), (41, 3), (42, 4), (43, 9), (64, 63)])
def test_solutions_in_a_band(n: int, w: int) -> None:
    """For every number of rows that is left after four columns at a time."""
    rng = np.random.default_rng(n)
    dense = np.tril(np.triu(rng.normal(size=(n, n)), -w))
    dense = dense + dense.T + 4.0 * (w + 1) * np.eye(n)
    band, lower, pivot = np.zeros((n, w + 1)), np.zeros((n, w + 1)), np.zeros(n)
    for i in range(n):
        for k in range(min(i, w) + 1):
            band[i, k] = dense[i, i - k]
    factor_band(band, lower, pivot)
    down, up = np.zeros((n, w + 4)), np.zeros((n, w + 4))
    spread_factor(lower, down, up)
    given = rng.normal(size=(3, n))
    found = given.copy()
    solve_many(down, up, pivot, found)
    np.testing.assert_allclose(found @ dense, given, rtol=0, atol=1e-12)


def search(depth: int, size: int, rows: int) -> Search:
    """Work space of a mixing."""
    return Search(
        solids=np.zeros(0, np.int64),
        balance=np.zeros((1, BALANCE)),
        residuals=np.zeros((depth, size)),
        values=np.zeros((depth, size + rows)),
        gram=np.zeros((depth, depth)),
        last=np.zeros(2 * size + rows),
        small=np.zeros((3, max(depth, 3), max(depth, 3))),
        kept=np.zeros(2, np.int64),
        changes=np.zeros(1),
        limits=np.zeros(LIMITS),
        taken=np.zeros(TAKEN, np.int64),
    )


@pytest.mark.parametrize("depth", [0, 1, 4, 8])
def test_mixing_is_that_of_the_solver(depth: int) -> None:
    """A contraction with rows that depend on the argument; the mixing forgets the oldest differences."""
    rng = np.random.default_rng(3)
    size, rows = 30, 4
    matrix = rng.normal(size=(size + rows, size)) / 8.0
    given, ours, theirs = rng.normal(size=size + rows), search(depth, size, rows), Anderson(depth)
    place, x = packed(ours), np.zeros(size)
    for _ in range(14):
        value = matrix @ np.tanh(x) + given
        wanted = theirs.mix(x, value)
        q, impulse = value[:size].copy(), value[size:].copy()
        mix_at(place.ctypes.data, value[:size] - x, q, impulse)
        np.testing.assert_allclose(np.concatenate([q, impulse]), wanted, rtol=0, atol=1e-9)
        x = wanted[:size]
    assert np.abs(matrix[:size] @ np.tanh(x) + given[:size] - x).max() < (1e-2 if depth == 0 else 1e-4)


def test_equal_differences_have_no_weight_of_their_own() -> None:
    """The Gram matrix of parallel differences is singular; the weights are those of least length."""
    ours, theirs = search(4, 3, 0), Anderson(4)
    place = packed(ours)
    for part in (0.0, 1.0, 2.0, 3.0):
        x, value = np.array([part, 0.0, 0.0]), np.array([0.5 * part + 1.0, 0.1, 0.0])
        q = value.copy()
        mix_at(place.ctypes.data, value - x, q, np.zeros(0))
        np.testing.assert_allclose(q, theirs.mix(x, value), rtol=0, atol=1e-12)
