"""Partition: every cell and node has one owner, and what is received is what is sent."""

import numpy as np
import pytest

import softway as sw
from softway.ranks.partition import Holding, bisected, holding, owners
from softway.ranks.threads import Threads, in_threads

SIZE = 5


def partitioned() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Cells of a box, the rank of each cell, and the owner of each node."""
    mesh = sw.meshes.Box(size=(2.0, 1.0, 1.0), cells=(8, 4, 5)).build()
    cells = mesh.blocks["hex8"]
    rank = bisected(mesh.points[cells].mean(axis=1), SIZE)
    return cells, rank, owners([cells], [rank], mesh.n_nodes)


def held() -> list[Holding]:
    """What each rank holds."""
    cells, _, owner = partitioned()
    return in_threads(SIZE, lambda ranks: holding(ranks, [cells], owner, np.array([0, len(owner) - 1])))


def test_cells_and_nodes_are_shared_evenly() -> None:
    cells, rank, owner = partitioned()
    assert np.ptp(np.bincount(rank, minlength=SIZE)) <= SIZE
    share = np.bincount(owner, minlength=SIZE) * SIZE / len(owner)
    assert share.min() > 0.8 and share.max() < 1.2
    touched = {(int(n), int(r)) for nodes, r in zip(cells, rank, strict=True) for n in nodes}
    assert all((n, int(r)) in touched for n, r in enumerate(owner))


def test_every_node_and_every_energy_is_counted_once() -> None:
    cells, _, owner = partitioned()
    found = held()
    assert sorted(n for h in found for n in h.nodes[h.own].tolist()) == list(range(len(owner)))
    assert sorted(c for h in found for c in h.cells[0][h.counted[0]].tolist()) == list(range(len(cells)))


def test_a_rank_holds_all_cells_of_its_nodes_and_what_it_looks_at() -> None:
    cells, _, owner = partitioned()
    for rank, h in enumerate(held()):
        assert set(np.flatnonzero((owner == rank)[cells].any(axis=1))) == set(h.cells[0].tolist())
        assert set(np.unique(cells[h.cells[0]])) | {0, len(owner) - 1} == set(h.nodes.tolist())


def test_an_exchange_fills_all_copies() -> None:
    cells, _, owner = partitioned()
    values = np.arange(2.0 * len(owner)).reshape(-1, 2)

    def filled(ranks: Threads) -> bool:
        h = holding(ranks, [cells], owner, np.array([0]))
        field = np.full((len(h.nodes), 2), np.nan)
        field[h.own] = values[h.nodes[h.own]]
        return bool((ranks.exchanged(h.exchange, field) == values[h.nodes]).all())

    assert all(in_threads(SIZE, filled))


def test_an_error_on_one_rank_ends_all_and_names_it() -> None:
    def fails(ranks: Threads) -> None:
        if ranks.rank == 2:
            raise ValueError("no such cell")
        ranks.added(np.zeros(1, np.int64))

    with pytest.raises(ValueError, match="no such cell") as caught:
        in_threads(3, fails)
    assert caught.value.__notes__ == ["on rank 2 of 3"]
