"""Sums over ranks: those of one process, with the same bits for any number of ranks."""

import numpy as np
import pytest

from softway.bodies.assembled.vector_space import LocalSpace
from softway.ranks.interface import Exchange
from softway.ranks.space import RankSpace, Shares
from softway.ranks.threads import Threads, in_threads

N, TAIL = 40, 3


def values(columns: int) -> np.ndarray:
    """Numbers of very different sizes."""
    random = np.random.default_rng(columns)
    return random.standard_normal((N, columns)) * 10.0 ** random.integers(-12, 12, (N, columns))


def space(ranks: Threads) -> tuple[RankSpace, np.ndarray]:
    """Space of every size-th node, with copies of all others before them."""
    local = np.roll(np.arange(N), -ranks.rank)
    own = np.flatnonzero(local % ranks.size == ranks.rank)
    shares = Shares(ranks=ranks, own=own, length=N)
    solids = (slice(0, N),)
    return RankSpace(ranks=ranks, shares=shares, solids=solids, exchange=Exchange(send={}, receive={})), local


def results(ranks: Threads) -> list[np.ndarray]:
    """All sums."""
    it, local = space(ranks)
    a, b, mask = values(3)[local], values(2)[local], (values(1)[local] > -1e12).ravel()
    tail = np.concatenate([a[:, 0], np.arange(float(TAIL))])
    found = [it.greatest(a, b), it.least(a), it.total(a), it.mean(a), it.sums(a), it.totals(a), it.dot(a, a)]
    found += [it.norm(b), it.products(a, b), it.products(a[:, 0], b), it.works(np.stack([a, -a]), a), it.every(mask)]
    some = it.among(mask)
    found += [some.sums(a[mask]), it.among(slice(0, N)).total(a)]
    return [np.asarray(x) for x in (*found, it.total(tail), it.products(tail, tail))]


def test_sums_have_the_same_bits_on_any_number_of_ranks_and_are_those_of_one_process() -> None:
    one = in_threads(1, results)[0]
    for size in (2, 3, 4):
        for found in in_threads(size, results):
            assert all((x == y).all() for x, y in zip(found, one, strict=True))
    it, a, b = LocalSpace((slice(0, N),)), values(3), values(2)
    plain = [it.greatest(a, b), it.least(a), it.total(a), it.mean(a), it.sums(a), it.totals(a), it.dot(a, a)]
    plain += [it.norm(b), it.products(a, b), it.products(a[:, 0], b), it.works(np.stack([a, -a]), a), True]
    mask = (values(1) > -1e12).ravel()
    plain += [it.among(mask).sums(a[mask]), it.among(slice(0, N)).total(a)]
    for x, y in zip(plain, one, strict=False):
        assert y == pytest.approx(x, rel=1e-12, abs=1e-12 * float(np.abs(a).max()))


def test_nan_on_one_rank_is_nan_on_all() -> None:
    def greatest(ranks: Threads) -> float:
        it, local = space(ranks)
        return it.greatest(np.where(local == 7, np.nan, 1.0)[: N - 5 * ranks.rank])

    assert all(np.isnan(found) for found in in_threads(2, greatest))


def test_other_arrays_than_those_of_the_rank_are_refused() -> None:
    with pytest.raises(ValueError, match="39 values, where this rank has 40"):
        in_threads(1, lambda ranks: space(ranks)[0].total(np.ones(N - 1)))


def test_sums_over_nodes_of_which_a_rank_has_none() -> None:
    def found(ranks: Threads) -> list[float]:
        it, _ = space(ranks)
        return it.among(np.zeros(it.shares.length, bool)).sums(np.zeros((0, 3))).tolist()

    assert in_threads(2, found) == [[0.0] * 3] * 2
