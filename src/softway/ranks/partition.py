"""Partition of cells and nodes: cells by bisection, nodes by a hash of their numbers, copies of nodes of others."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.ranks.interface import Exchange, Ranks

STIR = 2654435761
"""Factor of Knuth's multiplicative hash."""


def bisected(centres: Array, size: int) -> IntArray:
    """Rank (e,) of each cell, from the ``centres`` (e, d): halves along the longest side, in proportion to the ranks.

    Examples
    --------
    >>> bisected(np.array([[0.0, 0.0], [3.0, 0.0], [1.0, 0.0], [2.0, 0.0]]), 2).tolist()
    [0, 1, 0, 1]
    """
    out = np.zeros(len(centres), np.int64)
    work = [(np.arange(len(centres)), 0, size)]
    while work:
        cells, first, count = work.pop()
        if count == 1 or not len(cells):
            out[cells] = first
            continue
        here, half = centres[cells], count // 2
        order = cells[np.argsort(here[:, np.argmax(np.ptp(here, axis=0))], kind="stable")]
        cut = len(cells) * half // count
        work += [(np.sort(order[:cut]), first, half), (np.sort(order[cut:]), first + half, count - half)]
    return out


def owners(cells: Sequence[IntArray], rank_of: Sequence[IntArray], n: int) -> IntArray:
    """Rank (n,) that owns each node: by a hash of its number, one of the ranks whose cells (e, a) touch it.

    Examples
    --------
    >>> owners([np.array([[0, 1], [1, 2]])], [np.array([0, 1])], 3).tolist()
    [0, 1, 1]
    """
    size = max(int(ranks.max()) for ranks in rank_of) + 1
    pairs = [
        (some.astype(np.int64) * size + ranks[:, None]).ravel() for some, ranks in zip(cells, rank_of, strict=True)
    ]
    node, rank = np.divmod(np.unique(np.concatenate(pairs)), size)
    start = np.searchsorted(node, np.arange(n))
    count = np.searchsorted(node, np.arange(n), side="right") - start
    stirred = (np.arange(n) * STIR) % 2**32 >> 16
    return np.asarray(rank[start + stirred % np.maximum(count, 1)])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Holding:
    """Nodes and cells of a rank.

    Parameters
    ----------
    nodes
        (n,) numbers in the model of the local nodes, ascending: own ones, those of its cells, and others it looks at.
    own
        (k,) local numbers of the nodes that it owns.
    cells
        (e,) numbers of the cells of each group, such as a solid, that touch its own nodes, ascending; the first one if
        none does.
    counted
        (e,) of each group, True for the cells whose energy it counts: those whose first node it owns.
    exchange
        Exchange of the nodes with the other ranks.
    """

    nodes: IntArray
    own: IntArray
    cells: tuple[IntArray, ...]
    counted: tuple[BoolArray, ...]
    exchange: Exchange

    def local(self, numbers: IntArray) -> IntArray:
        """Local numbers of nodes of the model that are all here."""
        return np.searchsorted(self.nodes, numbers)


def holding(ranks: Ranks, cells: Sequence[IntArray], owner: IntArray, seen: IntArray) -> Holding:
    """What a rank holds of a model with the ``cells`` (e, a) of each group, whose nodes the ranks ``owner`` (n,) own.

    ``seen`` are nodes that it looks at besides those of its cells.
    """
    mine = owner == ranks.rank
    here = tuple(_touching(some, mine) for some in cells)
    around = [some[own].ravel() for some, own in zip(cells, here, strict=True)]
    nodes = np.unique(np.concatenate([np.flatnonzero(mine), *around, seen]))
    return Holding(
        nodes=nodes,
        own=np.flatnonzero(mine[nodes]),
        cells=here,
        counted=tuple(mine[some[own, 0]] for some, own in zip(cells, here, strict=True)),
        exchange=_exchange(ranks, nodes, owner[nodes]),
    )


def _touching(cells: IntArray, mine: BoolArray) -> IntArray:
    """Cells (k,) that touch own nodes; of a group elsewhere the first cell, which adds nothing, so that it has one."""
    found = np.flatnonzero(mine[cells].any(axis=1))
    return found if len(found) else np.zeros(1, np.int64)


def _exchange(ranks: Ranks, nodes: IntArray, owner: IntArray) -> Exchange:
    """Exchange of the copies among local ``nodes`` (n,) with the ranks that own them."""
    needs = ranks.gathered(np.stack([nodes, owner])[:, owner != ranks.rank])
    send = {}
    for other, (wanted, whose) in enumerate(needs):
        asked = wanted[whose == ranks.rank]
        if other != ranks.rank and len(asked):
            send[other] = np.searchsorted(nodes, asked)
    receive = {int(other): np.flatnonzero(owner == other) for other in np.unique(owner) if other != ranks.rank}
    return Exchange(send=send, receive=receive)
